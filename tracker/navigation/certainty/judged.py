"""Everything that is concluded of one drill in one image."""

from dataclasses import dataclass

from tracker.geometry import Tool, Vertebra
from tracker.navigation.certainty.certain import Certain, Room, certain_for
from tracker.navigation.certainty.placed import Placed
from tracker.navigation.certainty.probability import Probability, past_planned_ratio, probability_of_breach
from tracker.navigation.certainty.spread import Spread, spread_of
from tracker.navigation.clearance import (
    SOON_MM,
    DrillClearance,
    WallField,
    clearance_of_drill,
    drill_rings,
)
from tracker.plan.channel import Channel
from tracker.plan.pedicle import Side


@dataclass(frozen=True, slots=True, kw_only=True)
class Drill:
    """The cylinder that is looked at.

    Attributes:
        radius_mm: of the drill.
        length_mm: from its tip backwards.
        screw_radius_mm: of the screw that is planned; None takes the drill's own.
    """

    radius_mm: float
    length_mm: float
    screw_radius_mm: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Judged:
    """Clearance, uncertainty, and what both mean together.

    Attributes:
        clearance: of the whole drill, as it is shown.
        spread: how far the true drill may be from that.
        certain: whether that is little enough for this pedicle.
        now: how probable it is that the drill is through the wall.
        soon: likewise when it is 2 mm further in its present direction.
        at_end: likewise for the screw, when the direction is kept to the planned depth.
        past_planned_ratio: how probable it is that the tip is past the planned depth.
    """

    clearance: DrillClearance
    spread: Spread
    certain: Certain
    now: Probability
    soon: Probability
    at_end: Probability
    past_planned_ratio: float


def judge(
    tool: Placed[Vertebra, Tool],
    channel: Channel,
    wall: WallField,
    room: Room,
    drill: Drill,
    *,
    side: Side | None = None,
    soon_mm: float = SOON_MM,
    wall_sd_mm: float = 0.0,
) -> Judged:
    """Judge a drill that is placed in the plan's frame.

    Args:
        tool: the drill with its covariance.
        channel: the plan.
        wall: distances to the bone; where it is not known, to the pedicle's outline or to the channel.
        room: what this pedicle leaves to navigation.
        drill: its cylinder, and that of the screw.
        side: the plan's side of the patient.
        soon_mm: what "soon" is.
        wall_sd_mm: how far the wall itself may be from where the plan has it.
    """
    rings = drill_rings(
        tool.pose,
        channel,
        wall,
        radius_mm=drill.radius_mm,
        length_mm=drill.length_mm,
        screw_radius_mm=drill.screw_radius_mm,
        soon_mm=soon_mm,
    )
    clearance = clearance_of_drill(rings, tool.pose, channel, side)
    spread = spread_of(tool, channel)
    now, soon, at_end = (
        probability_of_breach(each, wall, tool, wall_sd_mm=wall_sd_mm)
        for each in (rings.now, rings.soon, rings.at_end)
    )
    return Judged(
        clearance=clearance,
        spread=spread,
        certain=certain_for(tool, channel, room),
        now=now,
        soon=soon,
        at_end=at_end,
        past_planned_ratio=past_planned_ratio(clearance.past_planned_mm, spread.sd_depth_mm),
    )
