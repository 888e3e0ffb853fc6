"""A frame placed in another with its uncertainty, carried along the chain from the patient to the drill."""

from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np
import numpy.typing as npt

from tracker.geometry import (
    Array,
    Camera,
    Marker,
    Rigid,
    Tool,
    Vertebra,
    chained_covariance,
    inverse_covariance,
)
from tracker.pose import ToolModel

To = TypeVar("To")
From = TypeVar("From")
Other = TypeVar("Other")
Fixed = TypeVar("Fixed")


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

    @classmethod
    def surely(cls, pose: Rigid[To, From]) -> "Placed[To, From]":
        """A pose that is known without any error."""
        return cls(pose=pose, covariance=np.zeros((6, 6)))

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


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolCertainty:
    """How surely the tip and the axis behind a marker are known, from the tool's calibration.

    Attributes:
        tip_covariance_mm2: (3, 3) in the marker's frame.
        axis_sd_deg: standard deviation of the axis in each of the two directions across it.
    """

    tip_covariance_mm2: Array
    axis_sd_deg: float

    @classmethod
    def isotropic(cls, *, tip_sd_mm: float, axis_sd_deg: float) -> "ToolCertainty":
        """The tip as surely in each direction."""
        return cls(tip_covariance_mm2=tip_sd_mm**2 * np.eye(3), axis_sd_deg=axis_sd_deg)


def marker_from_tool(tool: ToolModel, certainty: ToolCertainty) -> Placed[Marker, Tool]:
    """The tool behind its marker; a turn about its own axis counts as known: nothing depends on it."""
    axis = tool.marker_from_tool.rotation[:, 2]
    covariance = np.zeros((6, 6))
    covariance[:3, :3] = certainty.tip_covariance_mm2
    covariance[3:, 3:] = np.radians(certainty.axis_sd_deg) ** 2 * (np.eye(3) - np.outer(axis, axis))
    return Placed(pose=tool.marker_from_tool, covariance=covariance)


def tool_in_vertebra(
    *,
    camera_from_marker: Placed[Camera, Marker],
    tool: Placed[Marker, Tool],
    camera_from_anchor: Placed[Camera, Fixed],
    anchor_from_vertebra: Placed[Fixed, Vertebra],
) -> Placed[Vertebra, Tool]:
    """The drill in the plan's frame, with all that is unsure on the way from the patient to its tip.

    Args:
        camera_from_marker: the drill's marker in this image.
        tool: `marker_from_tool`.
        camera_from_anchor: the patient's reference marker in this image; where there is none, the camera is
            its own anchor: `Placed.surely(Rigid.identity())`.
        anchor_from_vertebra: the registration.
    """
    vertebra_from_camera = (camera_from_anchor @ anchor_from_vertebra).inverse
    return vertebra_from_camera @ (camera_from_marker @ tool)


def placed(pose: Rigid[To, From], covariance: npt.ArrayLike) -> Placed[To, From]:
    """A pose with its covariance (6, 6), as a marker's sighting and a registration state them."""
    return Placed(pose=pose, covariance=np.asarray(covariance, dtype=np.float64))
