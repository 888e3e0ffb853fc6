"""The registration in use: where the vertebra of the plan is, and how sure that is."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from tracker.geometry import Anchor, Array, Rigid, Vertebra


class Method(StrEnum):
    """How a registration was made."""

    NEEDLES = "needles"
    POINTS = "points"
    SURFACE = "surface"
    REHEARSAL = "rehearsal"


class AnchoredTo(StrEnum):
    """What a registration is fixed to."""

    CAMERA = "camera"
    REFERENCE = "reference"


@dataclass(frozen=True, slots=True, kw_only=True)
class Registration:
    """Where the vertebra of the plan is in the theatre.

    Attributes:
        method: how it was made.
        anchored_to: whose frame the anchor is.
        anchor_from_vertebra: takes points of the CT to the anchor's frame.
        covariance: (6, 6) of it [mm, rad], translation first, then rotation as a small left-multiplied
            rotation vector in the anchor's frame.
    """

    method: Method
    anchored_to: AnchoredTo
    anchor_from_vertebra: Rigid[Anchor, Vertebra]
    covariance: Array

    def __post_init__(self) -> None:
        covariance = np.array(self.covariance, dtype=np.float64).reshape(6, 6)
        covariance.setflags(write=False)
        object.__setattr__(self, "covariance", covariance)
