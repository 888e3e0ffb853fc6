"""A frame placed in another with its uncertainty, carried along the chain from the patient to the drill."""

from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

from tracker.geometry import (
    Array,
    Marker,
    Rigid,
    Tool,
    chained_covariance,
    inverse_covariance,
)
from tracker.pose import ToolModel

To = TypeVar("To")
From = TypeVar("From")
Other = TypeVar("Other")


@dataclass(frozen=True, slots=True, kw_only=True)
class Placed(Generic[To, From]):
    """Where one frame stands in another, and how surely.

    First order: good while the angles' standard deviations stay under about 5 degrees.

    Attributes:
        pose: `to_from_from`.
        covariance: (6, 6) [mm, rad]; translation first, then the rotation as a small rotation vector,
            multiplied from the left in `To`.
    """

    pose: Rigid[To, From]
    covariance: Array

    def __post_init__(self) -> None:
        covariance = np.array(self.covariance, dtype=np.float64).reshape(6, 6)
        covariance.setflags(write=False)
        object.__setattr__(self, "covariance", covariance)

    @property
    def inverse(self) -> "Placed[From, To]":
        """The same two frames, the other way round."""
        return Placed(pose=self.pose.inverse, covariance=inverse_covariance(self.pose, self.covariance))

    def __matmul__(self, other: "Placed[From, Other]") -> "Placed[To, Other]":
        """`a_from_b @ b_from_c` is `a_from_c`; the errors of both are taken as independent."""
        return Placed(
            pose=self.pose @ other.pose,
            covariance=chained_covariance(self.pose, self.covariance, other.pose, other.covariance),
        )


def marker_from_tool(tool: ToolModel) -> Placed[Marker, Tool]:
    """The tool behind its marker, as surely as its calibration says.

    A turn about its own axis counts as known: nothing depends on it.
    """
    axis = tool.marker_from_tool.rotation[:, 2]
    covariance = np.zeros((6, 6))
    covariance[:3, :3] = tool.tip_covariance_mm2
    covariance[3:, 3:] = np.radians(tool.axis_sd_deg) ** 2 * (np.eye(3) - np.outer(axis, axis))
    return Placed(pose=tool.marker_from_tool, covariance=covariance)
