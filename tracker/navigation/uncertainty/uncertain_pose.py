"""A rigid pose with its covariance, propagated along the chain from patient to drill."""

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
class UncertainPose(Generic[To, From]):
    """A rigid pose between two frames with its covariance.

    First-order propagation: valid while the standard deviations of the angles are below about 5 degrees.

    Attributes:
        pose: `to_from_from`.
        covariance: (6, 6) [mm, rad]; translation first, then a small rotation vector, multiplied from the
            left in `To`.
    """

    pose: Rigid[To, From]
    covariance: Array

    def __post_init__(self) -> None:
        covariance = np.array(self.covariance, dtype=np.float64).reshape(6, 6)
        covariance.setflags(write=False)
        object.__setattr__(self, "covariance", covariance)

    @property
    def inverse(self) -> "UncertainPose[From, To]":
        """Return the inverse pose."""
        return UncertainPose(
            pose=self.pose.inverse, covariance=inverse_covariance(self.pose, self.covariance)
        )

    def __matmul__(self, other: "UncertainPose[From, Other]") -> "UncertainPose[To, Other]":
        """Return `a_from_c` for `a_from_b @ b_from_c`; the errors of both are assumed independent."""
        return UncertainPose(
            pose=self.pose @ other.pose,
            covariance=chained_covariance(self.pose, self.covariance, other.pose, other.covariance),
        )


def marker_from_tool(tool: ToolModel) -> UncertainPose[Marker, Tool]:
    """Return the pose of the tool relative to its marker, with the covariance of the calibration.

    The rotation about the tool's own axis counts as known: nothing depends on it.
    """
    axis = tool.marker_from_tool.rotation[:, 2]
    covariance = np.zeros((6, 6))
    covariance[:3, :3] = tool.tip_covariance_mm2
    covariance[3:, 3:] = np.radians(tool.axis_sd_deg) ** 2 * (np.eye(3) - np.outer(axis, axis))
    return UncertainPose(pose=tool.marker_from_tool, covariance=covariance)
