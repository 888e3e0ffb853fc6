"""Where the vertebra of the plan is on the patient, and how sure that is.

One record and one covariance serve all methods. It is fixed to an anchor, the camera or the patient's
reference, and carried into each image; where the vertebra is now (`PlacedVertebra`) belongs to the image,
so video, numbers and 3-D lose it in the same image.

`tip_slope` is kept because one tip both touches the landmarks and drills: its error cancels where the drill
is turned as it was at the touches, and doubles where it is turned round. Taken as independent, the stated
95 % covers 88 to 100 % of the truths; with it, 95 to 97.
"""

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from tracker.errors import RegistrationError
from tracker.geometry import Anchor, Array, Camera, Reference, Rigid, Vertebra, point_covariance_mm2


class Method(StrEnum):
    """How a registration was made."""

    NEEDLES = "needles"  # the paper's: three needles on three lines of the reference slice
    POINTS = "points"  # the tool's tip on landmarks of the plan
    SURFACE = "surface"  # points swept over the bone, laid on its surface
    REHEARSAL = "rehearsal"  # known by the theatre, which exists only in software


class AnchoredTo(StrEnum):
    """What a registration is fixed to; it holds only as long as the patient keeps still before it."""

    CAMERA = "camera"  # a move of patient or camera is not seen
    REFERENCE = "reference"  # the marker fixed to the patient, which both may move with


@dataclass(frozen=True, slots=True, kw_only=True)
class Registration:
    """The vertebra of the plan, found on the patient.

    Attributes:
        method: how it was made.
        anchored_to: what it is fixed to.
        anchor_from_vertebra: from the plan's frame (LPS, mm) to that of camera or reference.
        covariance: (6, 6) [mm, rad] of `anchor_from_vertebra`: its translation first, then its rotation as a
            small vector multiplied from the left, as a marker's pose has it. Symmetric.
        tip_slope: (6, 3), how `anchor_from_vertebra` follows an error of the tip behind its marker; where one
            tool both touched and drills, much of that error takes itself back. 0 where no tip was used.
        tool: the tool with whose tip it was made; empty where none was.

    Raises:
        RegistrationError: REGISTRATION_COVARIANCE_INVALID, it is not finite, or no covariance.
    """

    method: Method
    anchored_to: AnchoredTo
    anchor_from_vertebra: Rigid[Anchor, Vertebra]
    covariance: Array
    tip_slope: Array = field(default_factory=lambda: np.zeros((6, 3)))
    tool: str = ""

    @classmethod
    def known_to_camera(cls, camera_from_vertebra: Rigid[Camera, Vertebra]) -> "Registration":
        """What a theatre in software knows of itself: exact, and fixed to the camera."""
        return cls(
            method=Method.REHEARSAL,
            anchored_to=AnchoredTo.CAMERA,
            anchor_from_vertebra=Rigid(
                rotation=camera_from_vertebra.rotation, translation_mm=camera_from_vertebra.translation_mm
            ),
            covariance=np.zeros((6, 6)),
        )

    @classmethod
    def known_to_reference(cls, reference_from_vertebra: Rigid[Reference, Vertebra]) -> "Registration":
        """The same, fixed to the marker on the patient."""
        return cls(
            method=Method.REHEARSAL,
            anchored_to=AnchoredTo.REFERENCE,
            anchor_from_vertebra=Rigid(
                rotation=reference_from_vertebra.rotation,
                translation_mm=reference_from_vertebra.translation_mm,
            ),
            covariance=np.zeros((6, 6)),
        )

    def __post_init__(self) -> None:
        covariance = np.array(self.covariance, dtype=np.float64).reshape(6, 6)
        if not np.isfinite(covariance).all() or np.linalg.eigvalsh(covariance).min() < -1e-9:
            raise RegistrationError(
                "REGISTRATION_COVARIANCE_INVALID",
                "the uncertainty of the registration is not a finite covariance",
                "Register again.",
            )
        covariance = 0.5 * (covariance + covariance.T)
        slope = np.array(self.tip_slope, dtype=np.float64).reshape(6, 3)
        for name, array in (("covariance", covariance), ("tip_slope", slope)):
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    def point_covariance_mm2(self, point_in_vertebra_mm: Array) -> Array:
        """Covariance (3, 3) of a point of the plan, as it is seen from the anchor."""
        return point_covariance_mm2(self.anchor_from_vertebra, self.covariance, point_in_vertebra_mm)
