"""Clearance of a screw to the wall at each depth."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array
from tracker.plan.channel import Channel
from tracker.plan.pedicle import PedicleMeasure
from tracker.plan.screw.clearance import HALF_LENGTH_MM, outward_normals

STEP_MM = 0.5
# Cosine of the angle to the pedicle's axis below which a screw runs across the pedicle and not through it.
MIN_ALONG = 0.1


@dataclass(frozen=True, slots=True, kw_only=True)
class ClearanceAlong:
    """Distance from the screw's surface to the wall by depth, where the wall is known.

    Attributes:
        depth_mm: (n,), along the screw from its entry, ascending.
        clearance_mm: (n,), the minimum around the screw at that depth; negative through the wall.
    """

    depth_mm: Array
    clearance_mm: Array

    def __post_init__(self) -> None:
        for array in (self.depth_mm, self.clearance_mm):
            array.setflags(write=False)

    @property
    def min_mm(self) -> float:
        """Return the minimum clearance."""
        return float(self.clearance_mm.min())

    @property
    def min_depth_mm(self) -> float:
        """Return the depth of the minimum clearance; the first if there are several."""
        return float(self.depth_mm[int(np.argmin(self.clearance_mm))])


def clearance_along(
    channel: Channel, measure: PedicleMeasure, *, diameter_mm: float, length_mm: float
) -> ClearanceAlong | None:
    """Return the clearance of a screw on the channel's axis to the pedicle's wall.

    As in `clearance_of`, the wall is the outline of the isthmus, from 3 mm behind it to where the pedicle
    opens into the body. None if no part of the screw lies there.
    """
    axis = channel.axis_in_vertebra
    slope = float(axis @ measure.axis_lps)
    if slope < MIN_ALONG:
        return None
    behind = float((channel.entry_in_vertebra_mm - measure.isthmus_lps_mm) @ measure.axis_lps)
    first = max((-HALF_LENGTH_MM - behind) / slope, 0.0)
    last = min((max(measure.opens_ahead_mm, HALF_LENGTH_MM) - behind) / slope, length_mm)
    if first >= last:
        return None
    depth = np.linspace(first, last, int(np.ceil((last - first) / STEP_MM)) + 1)
    points = channel.entry_in_vertebra_mm + depth[:, None] * axis
    normal = outward_normals(measure.outline_lps_mm, measure)
    gaps = (measure.outline_lps_mm * normal).sum(axis=1) - points @ normal.T
    return ClearanceAlong(depth_mm=depth, clearance_mm=gaps.min(axis=1) - 0.5 * diameter_mm)
