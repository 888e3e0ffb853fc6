"""Check whether the pose uncertainty is within the tolerance of the pedicle."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Tool, Vertebra
from tracker.navigation.uncertainty.propagation import crossing_sds_mm, radius_95
from tracker.navigation.uncertainty.uncertain_pose import UncertainPose
from tracker.plan.channel import Channel
from tracker.plan.screw import Tolerance

# Usual depth of the isthmus past the entry, if it is not known.
USUAL_LEVER_MM = 18.0


@dataclass(frozen=True, slots=True, kw_only=True)
class PedicleTolerance:
    """Allowed position and angle error in a pedicle.

    Attributes:
        tolerance_mm: distance from the drill or screw on the planned axis to the nearest wall.
        lever_mm: depth of the isthmus past the entry, where an angle error reaches that distance.
    """

    tolerance_mm: float
    lever_mm: float

    @property
    def tolerance_deg(self) -> float:
        """Return the angle error that reaches the wall at the isthmus, for an entry on the axis."""
        return float(np.degrees(np.arctan2(self.tolerance_mm, self.lever_mm)))

    @classmethod
    def of_tolerance(cls, tolerance: Tolerance) -> "PedicleTolerance":
        """Return the tolerance as stated in the plan."""
        return cls.of_limits(tolerance.max_offset_mm, tolerance.max_angle_deg)

    @classmethod
    def of_limits(cls, max_offset_mm: float, max_angle_deg: float) -> "PedicleTolerance":
        """Return the tolerance from the offset and the angle that reach the wall, each alone."""
        slope = float(np.tan(np.radians(max_angle_deg)))
        lever = max_offset_mm / slope if slope > 0.0 else USUAL_LEVER_MM
        return cls(tolerance_mm=max_offset_mm, lever_mm=lever)

    @classmethod
    def of_channel(cls, channel: Channel, *, radius_mm: float) -> "PedicleTolerance":
        """Return the difference of the radii of channel and drill, if only the channel is known."""
        return cls(
            tolerance_mm=max(channel.radius_mm - radius_mm, 0.0),
            lever_mm=min(channel.length_mm, USUAL_LEVER_MM),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class ToleranceCheck:
    """Result of comparing the pose uncertainty with the tolerance of the pedicle.

    Attributes:
        enough: the 95 % uncertainty is within the tolerance.
        entry_95_mm: 95 % radius of the position of the drill's axis at the entry.
        isthmus_95_mm: the same at the isthmus.
        tolerance_mm: allowed offset.
        tolerance_deg: allowed angle.
    """

    enough: bool
    entry_95_mm: float
    isthmus_95_mm: float
    tolerance_mm: float
    tolerance_deg: float


def check_tolerance(
    tool: UncertainPose[Vertebra, Tool], channel: Channel, tolerance: PedicleTolerance
) -> ToleranceCheck:
    """Compare the uncertainty of the drill's axis with the tolerance of the pedicle."""
    entry, isthmus = (
        radius_95(*crossing_sds_mm(tool, channel, depth_mm=depth)) for depth in (0.0, tolerance.lever_mm)
    )
    return ToleranceCheck(
        enough=max(entry, isthmus) < tolerance.tolerance_mm,
        entry_95_mm=entry,
        isthmus_95_mm=isthmus,
        tolerance_mm=tolerance.tolerance_mm,
        tolerance_deg=tolerance.tolerance_deg,
    )
