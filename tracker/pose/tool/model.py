"""The geometry of a tool relative to its marker."""

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from tracker.errors import InvalidInput
from tracker.geometry import Array, Marker, Rigid, Tool, rotation_between


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolModel:
    """A drill or awl: its marker, and the pose of its tip and axis relative to the marker.

    Attributes:
        name: name shown on the screen.
        marker: name of its marker model.
        marker_from_tool: the tip (origin) and the drilling direction (+z) in the marker's frame.
        radius_mm: radius of the drill's cylinder.
        length_mm: length of the cylinder from the tip backwards.
        tip_covariance_mm2: (3, 3) of the tip in the marker's frame; 0 where the tip is known by construction.
        axis_sd_deg: standard deviation of the drilling direction, about each of two perpendicular axes.
    """

    name: str
    marker: str
    marker_from_tool: Rigid[Marker, Tool]
    radius_mm: float
    length_mm: float
    tip_covariance_mm2: Array = field(default_factory=lambda: np.zeros((3, 3)))
    axis_sd_deg: float = 0.0

    def __post_init__(self) -> None:
        covariance = np.array(self.tip_covariance_mm2, dtype=np.float64).reshape(3, 3)
        covariance.setflags(write=False)
        object.__setattr__(self, "tip_covariance_mm2", covariance)

    @classmethod
    def from_tip_and_axis(
        cls,
        *,
        name: str,
        marker: str,
        tip_in_marker_mm: npt.ArrayLike,
        axis_in_marker: npt.ArrayLike,
        radius_mm: float,
        length_mm: float,
        tip_covariance_mm2: npt.ArrayLike | None = None,
        axis_sd_deg: float = 0.0,
    ) -> "ToolModel":
        """Return a tool with a tip (3,) in mm and a drilling direction (3,), both in the marker's frame.

        Raises:
            InvalidInput: TOOL_AXIS_INVALID, the direction has no length.
        """
        axis = np.asarray(axis_in_marker, dtype=np.float64)
        if not np.isfinite(axis).all() or float(np.linalg.norm(axis)) < 1e-9:
            raise InvalidInput(
                "TOOL_AXIS_INVALID",
                f"the drilling direction of '{name}' is {axis.tolist()}, which has no length",
                "Give the direction from the marker towards the tip, as three numbers.",
                {"tool": name, "axis": axis.tolist()},
            )
        rotation = rotation_between([0.0, 0.0, 1.0], axis)
        return cls(
            name=name,
            marker=marker,
            marker_from_tool=Rigid(
                rotation=rotation, translation_mm=np.asarray(tip_in_marker_mm, dtype=np.float64)
            ),
            radius_mm=radius_mm,
            length_mm=length_mm,
            tip_covariance_mm2=np.zeros((3, 3))
            if tip_covariance_mm2 is None
            else np.array(tip_covariance_mm2),
            axis_sd_deg=axis_sd_deg,
        )
