"""Clearance, uncertainty and breach probability of one drill in one image."""

from dataclasses import dataclass

from tracker.geometry import Tool, Vertebra
from tracker.navigation.clearance import (
    LOOKAHEAD_MM,
    DrillClearance,
    WallDistanceField,
    clearance_of_drill,
    drill_rings,
)
from tracker.navigation.uncertainty.probability import Probability, past_planned_ratio, probability_of_breach
from tracker.navigation.uncertainty.propagation import DrillUncertainty, propagate_uncertainty
from tracker.navigation.uncertainty.tolerance import PedicleTolerance, ToleranceCheck, check_tolerance
from tracker.navigation.uncertainty.uncertain_pose import UncertainPose
from tracker.plan.channel import Channel
from tracker.plan.pedicle import Side


@dataclass(frozen=True, slots=True, kw_only=True)
class Drill:
    """Dimensions of drill and screw.

    Attributes:
        radius_mm: of the drill.
        length_mm: from its tip backwards.
        screw_radius_mm: of the planned screw; None uses that of the drill.
    """

    radius_mm: float
    length_mm: float
    screw_radius_mm: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class DrillAnalysis:
    """Clearance and uncertainty of a drill, and the breach probabilities that follow.

    Attributes:
        clearance: of the whole drill at its nominal pose.
        spread: uncertainty of that pose.
        certain: whether it is within the tolerance of this pedicle.
        now: breach probability at the present pose.
        lookahead: breach probability 2 mm deeper in the present direction.
        at_end: breach probability of the screw at the planned depth in the present direction.
        past_planned_ratio: probability that the tip is past the planned depth.
    """

    clearance: DrillClearance
    spread: DrillUncertainty
    certain: ToleranceCheck
    now: Probability
    lookahead: Probability
    at_end: Probability
    past_planned_ratio: float


def analyse_drill(
    tool: UncertainPose[Vertebra, Tool],
    channel: Channel,
    wall: WallDistanceField,
    tolerance: PedicleTolerance,
    drill: Drill,
    *,
    side: Side | None = None,
    lookahead_mm: float = LOOKAHEAD_MM,
    wall_sd_mm: float = 0.0,
) -> DrillAnalysis:
    """Compute clearance, uncertainty and breach probability of a drill in the vertebra frame.

    Args:
        tool: pose of the drill with its covariance.
        channel: the planned channel.
        wall: distance field of the bone; if unknown, of the pedicle's outline or of the channel.
        tolerance: of this pedicle.
        drill: dimensions of drill and screw.
        side: of the patient, as planned.
        lookahead_mm: distance of the look-ahead.
        wall_sd_mm: standard deviation of the wall's position.
    """
    rings = drill_rings(
        tool.pose,
        channel,
        wall,
        radius_mm=drill.radius_mm,
        length_mm=drill.length_mm,
        screw_radius_mm=drill.screw_radius_mm,
        lookahead_mm=lookahead_mm,
    )
    clearance = clearance_of_drill(rings, tool.pose, channel, side)
    spread = propagate_uncertainty(tool, channel)
    now, lookahead, at_end = (
        probability_of_breach(each, wall, tool, wall_sd_mm=wall_sd_mm)
        for each in (rings.now, rings.lookahead, rings.at_end)
    )
    return DrillAnalysis(
        clearance=clearance,
        spread=spread,
        certain=check_tolerance(tool, channel, tolerance),
        now=now,
        lookahead=lookahead,
        at_end=at_end,
        past_planned_ratio=past_planned_ratio(clearance.past_planned_mm, spread.sd_depth_mm),
    )
