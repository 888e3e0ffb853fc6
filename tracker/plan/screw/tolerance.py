"""What a pedicle leaves for navigation: how far off entry and angle may be before it breaks out."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array
from tracker.plan.channel import Channel
from tracker.plan.pedicle import PedicleMeasure
from tracker.plan.screw.clearance import HALF_LENGTH_MM, wall_gaps_mm

STEPS = 16


@dataclass(frozen=True, slots=True, kw_only=True)
class Tolerance:
    """The errors of navigation that keep a screw within the pedicle's walls.

    Entry offset and angle use up the same room: whoever is off by `offset_mm` at the entry in the worst
    direction has the angle of the same place in `deg_at_offset` left.

    Attributes:
        offset_mm: (n,), entry offsets from 0 to the largest.
        deg_at_offset: (n,), the angle that may come on top of it in the worst direction; falls to 0.
        most_offset_mm: the largest offset with a true angle.
        most_angle_deg: the largest angle with a true entry.
        both_mm: and both_deg: half of each, which may come together.
    """

    offset_mm: Array
    deg_at_offset: Array
    most_offset_mm: float
    most_angle_deg: float
    both_mm: float
    both_deg: float


def tolerance_of(channel: Channel, measure: PedicleMeasure, *, diameter_mm: float) -> Tolerance:
    """The tolerance of one pedicle for one screw; all zero where the plan itself has no room.

    The screw turns about its entry; the far end of the isthmus moves by the offset and by the lever times the
    tangent of the angle, in the worst case both towards the nearest wall.
    """
    room = max(float(wall_gaps_mm(channel, measure).min()) - 0.5 * diameter_mm, 0.0)
    to_isthmus = float((measure.isthmus_lps_mm - channel.entry_in_vertebra_mm) @ channel.axis_in_vertebra)
    lever = max(to_isthmus + HALF_LENGTH_MM, HALF_LENGTH_MM)
    offset = np.linspace(0.0, room, STEPS)
    angle = np.degrees(np.arctan((room - offset) / lever))
    for array in (offset, angle):
        array.setflags(write=False)
    return Tolerance(
        offset_mm=offset,
        deg_at_offset=angle,
        most_offset_mm=room,
        most_angle_deg=float(angle[0]),
        both_mm=0.5 * room,
        both_deg=float(np.degrees(np.arctan(0.5 * room / lever))),
    )
