"""Messages of a drill's deviation, clearance and uncertainty."""

from typing import Annotated, Literal

from pydantic import Field

from server.number_format import finite
from server.stream.message import Message
from server.stream.pose_messages import AbsentMessage, absent_message
from tracker.navigation import Absent, Deviation
from tracker.navigation.clearance import DrillClearance, NotEntered, WallProximity, WallSource
from tracker.navigation.directions import Wall
from tracker.navigation.uncertainty import DrillAnalysis, DrillUncertainty, Probability, ToleranceCheck
from tracker.plan.screw import GertzbeinRobbins


class DeviationMessage(Message):
    """Deviation of the drill from the channel; see `tracker.navigation.Deviation`."""

    kind: Literal["deviation"] = "deviation"
    entry_offset_mm: float | None
    """Null when the drill lies across the channel and its axis never meets the entry plane."""
    angle_deg: float
    depth_mm: float
    remaining_mm: float
    tip_offset_mm: float
    entry_lateral_mm: float | None
    """In the axial plane, positive lateral; null like the offset."""
    entry_cranial_mm: float | None
    """Along the spine, positive cranial; null like the offset."""
    transverse_deg: float
    """Angle to the channel in an axial slice, positive medial."""
    sagittal_deg: float
    """Angle to the channel in a sagittal slice, positive cranial."""
    angle_medial_deg: float
    """Medial component of the angle, about the channel itself."""
    angle_cranial_deg: float
    """Cranial component, likewise."""


class NearestWallMessage(Message):
    """Point of the drill with the minimum clearance."""

    kind: Literal["nearest"] = "nearest"
    clearance_mm: float
    """From the drill's surface to the wall; negative for a breach."""
    wall: Wall
    point_in_vertebra_mm: list[float]
    """x, y, z of that point."""
    grade: GertzbeinRobbins


class NotEnteredMessage(Message):
    """No part of the drill has entered the bone, or is within reach of the channel."""

    kind: Literal["not-entered"] = "not-entered"


WallProximityMessage = Annotated[NearestWallMessage | NotEnteredMessage, Field(discriminator="kind")]


class ClearanceMessage(Message):
    """Clearance between the drill and the walls around it."""

    against: WallSource
    """Which wall `now`, `soon` and `at_end` were measured against."""
    now: WallProximityMessage
    lookahead: WallProximityMessage
    """With the drill advanced by 2 mm in its present direction."""
    at_end: WallProximityMessage
    """Of the planned screw, in the present direction to the planned depth."""
    channel: WallProximityMessage
    """Of the present drill, against the wall of the planned cylinder."""
    past_planned_mm: float
    """Depth of the tip past the planned depth; negative before it."""


class ProbabilityMessage(Message):
    """Probabilities, 0 to 1, that any part of the drill breaches the wall."""

    now_ratio: float
    lookahead_ratio: float
    at_end_ratio: float
    at_end_grade_ratio: dict[GertzbeinRobbins, float]
    """Of each class at the end; they sum to 1."""
    past_planned_ratio: float
    """That the tip is past the planned depth."""


class SpreadMessage(Message):
    """Uncertainty of the drill's pose, in the plan's frame."""

    tip_ellipsoid_mm: list[list[float]]
    """3 half axes of the 95 % ellipsoid of the tip, the longest first."""
    cone_95_deg: float
    tip_sd_mm: float
    sd_angle_deg: float
    sd_depth_mm: float
    sd_at_entry_mm: float | None
    """Null when the drill lies across the channel."""


class CertainMessage(Message):
    """Whether the uncertainty is small enough for this pedicle."""

    enough: bool
    entry_95_mm: float | None
    """95 % bound of the drill axis's offset at the entry; null when it is across the channel."""
    isthmus_95_mm: float | None
    tolerance_mm: float
    """Allowed offset at the entry, for a drill parallel to the channel."""
    tolerance_deg: float
    """Allowed angle, for a drill that enters on the axis."""


class JudgementMessage(Message):
    """Clearance, uncertainty, and their conclusion."""

    kind: Literal["judgement"] = "judgement"
    clearance: ClearanceMessage
    probability: ProbabilityMessage
    spread: SpreadMessage
    certain: CertainMessage


def deviation_message(deviation: Deviation | Absent) -> DeviationMessage | AbsentMessage:
    """Return the message of a drill's deviation."""
    if isinstance(deviation, Absent):
        return absent_message(deviation)
    return DeviationMessage(
        entry_offset_mm=finite(deviation.entry_offset_mm),
        angle_deg=deviation.angle_deg,
        depth_mm=deviation.depth_mm,
        remaining_mm=deviation.remaining_mm,
        tip_offset_mm=deviation.tip_offset_mm,
        entry_lateral_mm=finite(deviation.entry_lateral_mm),
        entry_cranial_mm=finite(deviation.entry_cranial_mm),
        transverse_deg=deviation.transverse_deg,
        sagittal_deg=deviation.sagittal_deg,
        angle_medial_deg=deviation.angle_medial_deg,
        angle_cranial_deg=deviation.angle_cranial_deg,
    )


def judgement_message(judged: DrillAnalysis | Absent) -> JudgementMessage | AbsentMessage:
    """Return the message of a drill's clearance and uncertainty."""
    if isinstance(judged, Absent):
        return absent_message(judged)
    return JudgementMessage(
        clearance=_clearance(judged.clearance),
        probability=_probability(judged.now, judged.lookahead, judged.at_end, judged.past_planned_ratio),
        spread=_spread(judged.spread),
        certain=_certain(judged.certain),
    )


def _clearance(clearance: DrillClearance) -> ClearanceMessage:
    return ClearanceMessage(
        against=clearance.against,
        now=_closest(clearance.now),
        lookahead=_closest(clearance.lookahead),
        at_end=_closest(clearance.at_end),
        channel=_closest(clearance.channel),
        past_planned_mm=clearance.past_planned_mm,
    )


def _closest(closest: WallProximity) -> NearestWallMessage | NotEnteredMessage:
    if isinstance(closest, NotEntered):
        return NotEnteredMessage()
    return NearestWallMessage(
        clearance_mm=closest.clearance_mm,
        wall=closest.wall,
        point_in_vertebra_mm=closest.point_in_vertebra_mm.tolist(),
        grade=closest.grade,
    )


def _probability(
    now: Probability, lookahead: Probability, at_end: Probability, past_planned_ratio: float
) -> ProbabilityMessage:
    return ProbabilityMessage(
        now_ratio=now.through_ratio,
        lookahead_ratio=lookahead.through_ratio,
        at_end_ratio=at_end.through_ratio,
        at_end_grade_ratio=dict(at_end.grade_ratio),
        past_planned_ratio=past_planned_ratio,
    )


def _spread(spread: DrillUncertainty) -> SpreadMessage:
    return SpreadMessage(
        tip_ellipsoid_mm=spread.tip_ellipsoid_mm.tolist(),
        cone_95_deg=spread.cone_95_deg,
        tip_sd_mm=spread.tip_sd_mm,
        sd_angle_deg=spread.sd_angle_deg,
        sd_depth_mm=spread.sd_depth_mm,
        sd_at_entry_mm=finite(spread.sd_at_entry_mm),
    )


def _certain(certain: ToleranceCheck) -> CertainMessage:
    return CertainMessage(
        enough=certain.enough,
        entry_95_mm=finite(certain.entry_95_mm),
        isthmus_95_mm=finite(certain.isthmus_95_mm),
        tolerance_mm=certain.tolerance_mm,
        tolerance_deg=certain.tolerance_deg,
    )
