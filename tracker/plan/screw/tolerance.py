"""Navigation tolerance of a pedicle: entry and angle errors without a breach."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array
from tracker.plan.channel import Channel
from tracker.plan.pedicle import PedicleMeasure
from tracker.plan.screw.clearance import HALF_LENGTH_MM, gaps_along_mm

STEPS = 16


@dataclass(frozen=True, slots=True, kw_only=True)
class Tolerance:
    """Navigation errors that keep a screw within the pedicle's walls.

    Entry offset and angle share the same clearance: at an entry offset of `offset_mm[i]` in the worst
    direction, the allowed angle is `deg_at_offset[i]`.

    Attributes:
        offset_mm: (n,), entry offsets from 0 to the largest.
        deg_at_offset: (n,), the allowed angle at that offset in the worst direction, down to 0.
        max_offset_mm: the largest offset with zero angle error.
        max_angle_deg: the largest angle with zero entry offset.
        both_mm: half of the largest offset; `both_deg` is the allowed angle at it.
    """

    offset_mm: Array
    deg_at_offset: Array
    max_offset_mm: float
    max_angle_deg: float
    both_mm: float
    both_deg: float


def tolerance_of(channel: Channel, measure: PedicleMeasure, *, diameter_mm: float) -> Tolerance:
    """Return the tolerance of one pedicle for one screw; all zero if the plan itself breaches.

    The walls count from 3 mm behind the isthmus to where the pedicle opens into the body.
    The screw rotates about its entry: each of its points moves by the offset and by the lever times the
    tangent of the angle, in the worst case both towards the nearest wall there.
    """
    places, gaps = gaps_along_mm(channel, measure)
    room = np.maximum(gaps.min(axis=1) - 0.5 * diameter_mm, 0.0)
    to_isthmus = float((measure.isthmus_lps_mm - channel.entry_in_vertebra_mm) @ channel.axis_in_vertebra)
    lever = np.maximum(to_isthmus + places, HALF_LENGTH_MM)
    max_offset_mm = float(room.min())
    offset = np.linspace(0.0, max_offset_mm, STEPS)
    # The critical section depends on the offset, because the lever of the angle differs.
    angle = np.degrees(np.arctan(((room - offset[:, None]) / lever).min(axis=1)))
    both = float(np.degrees(np.arctan(((room - 0.5 * max_offset_mm) / lever).min())))
    for array in (offset, angle):
        array.setflags(write=False)
    return Tolerance(
        offset_mm=offset,
        deg_at_offset=angle,
        max_offset_mm=max_offset_mm,
        max_angle_deg=float(angle[0]),
        both_mm=0.5 * max_offset_mm,
        both_deg=both,
    )
