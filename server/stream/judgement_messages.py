"""What is concluded of a drill, as it goes over the wire: its deviation, and its judgement."""

from typing import Annotated, Literal

from pydantic import Field

from server.stream.message import Message, finite
from server.stream.place_messages import AbsentMessage, absent_message
from tracker.navigation import Absent, Deviation
from tracker.navigation.certainty import Certain, Judged, Probability, Spread
from tracker.navigation.clearance import Closest, DrillClearance, MeasuredAgainst, NotEntered
from tracker.navigation.directions import Wall
from tracker.plan.screw import GertzbeinRobbins


class DeviationMessage(Message):
    """The surgeon's numbers; see `tracker.navigation.Deviation`."""

    kind: Literal["deviation"] = "deviation"
    entry_offset_mm: float | None
    """Null when the drill lies across the channel and its line never meets the entry plane."""
    angle_deg: float
    depth_mm: float
    remaining_mm: float
    tip_offset_mm: float
    entry_lateral_mm: float | None
    """Along the slice, positive away from the patient's middle; null as the whole."""
    entry_cranial_mm: float | None
    """Along the body, positive to the head; null as the whole."""
    transverse_deg: float
    """By how much the drill runs more to the middle than the channel, in an axial slice."""
    sagittal_deg: float
    """By how much it runs more to the head, in a sagittal slice."""
    angle_medial_deg: float
    """The part of the angle to the patient's middle, across the channel itself."""
    angle_cranial_deg: float
    """The part to the head, likewise."""


class NearestMessage(Message):
    """The place of the drill with the least clearance."""

    kind: Literal["nearest"] = "nearest"
    clearance_mm: float
    """From the drill's surface to the wall; below 0 where it is through."""
    wall: Wall
    point_in_vertebra_mm: list[float]
    """x, y, z of that place."""
    grade: GertzbeinRobbins


class NotEnteredMessage(Message):
    """No part of the drill is past the bone's back, or within reach of the channel."""

    kind: Literal["not-entered"] = "not-entered"


ClosestMessage = Annotated[NearestMessage | NotEnteredMessage, Field(discriminator="kind")]


class ClearanceMessage(Message):
    """What is between the drill and the walls around it."""

    against: MeasuredAgainst
    """Which wall `now`, `soon` and `at_end` were measured against."""
    now: ClosestMessage
    soon: ClosestMessage
    """When it is 2 mm further in its present direction."""
    at_end: ClosestMessage
    """The planned screw, when the present direction is kept to the planned depth."""
    channel: ClosestMessage
    """The drill as it is, against the planned cylinder's wall."""
    past_planned_mm: float
    """How far the tip is past the planned depth; below 0 before it."""


class ProbabilityMessage(Message):
    """Probabilities, 0 to 1, that any part of the drill is through the wall."""

    now_ratio: float
    soon_ratio: float
    at_end_ratio: float
    at_end_grade_ratio: dict[GertzbeinRobbins, float]
    """Of each class at the end; they sum to 1."""
    past_planned_ratio: float
    """That the tip is past the planned depth."""


class SpreadMessage(Message):
    """How far the true drill may be from the one that is shown; in the plan's frame."""

    tip_ellipsoid_mm: list[list[float]]
    """3 half axes of the ellipsoid that holds the tip in 95 %, the longest first."""
    cone_95_deg: float
    tip_sd_mm: float
    sd_angle_deg: float
    sd_depth_mm: float
    sd_at_entry_mm: float | None
    """Null when the drill lies across the channel."""


class CertainMessage(Message):
    """Whether that is little enough for this pedicle."""

    enough: bool
    entry_95_mm: float | None
    """The drill's line is within this of where it is shown, in 95 %; null when it is across the channel."""
    isthmus_95_mm: float | None
    room_mm: float
    """What the pedicle leaves to an offset at the entry, for a drill that runs along the channel."""
    room_deg: float
    """What it leaves to an angle, for a drill that comes in on the axis."""


class JudgementMessage(Message):
    """Clearance, uncertainty, and what both mean together."""

    kind: Literal["judgement"] = "judgement"
    clearance: ClearanceMessage
    probability: ProbabilityMessage
    spread: SpreadMessage
    certain: CertainMessage


def deviation_message(deviation: Deviation | Absent) -> DeviationMessage | AbsentMessage:
    """The message of a drill's deviation."""
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


def judgement_message(judged: Judged | Absent) -> JudgementMessage | AbsentMessage:
    """The message of all that is concluded of a drill."""
    if isinstance(judged, Absent):
        return absent_message(judged)
    return JudgementMessage(
        clearance=_clearance(judged.clearance),
        probability=_probability(judged.now, judged.soon, judged.at_end, judged.past_planned_ratio),
        spread=_spread(judged.spread),
        certain=_certain(judged.certain),
    )


def _clearance(clearance: DrillClearance) -> ClearanceMessage:
    return ClearanceMessage(
        against=clearance.against,
        now=_closest(clearance.now),
        soon=_closest(clearance.soon),
        at_end=_closest(clearance.at_end),
        channel=_closest(clearance.channel),
        past_planned_mm=clearance.past_planned_mm,
    )


def _closest(closest: Closest) -> NearestMessage | NotEnteredMessage:
    if isinstance(closest, NotEntered):
        return NotEnteredMessage()
    return NearestMessage(
        clearance_mm=closest.clearance_mm,
        wall=closest.wall,
        point_in_vertebra_mm=closest.point_in_vertebra_mm.tolist(),
        grade=closest.grade,
    )


def _probability(
    now: Probability, soon: Probability, at_end: Probability, past_planned_ratio: float
) -> ProbabilityMessage:
    return ProbabilityMessage(
        now_ratio=now.through_ratio,
        soon_ratio=soon.through_ratio,
        at_end_ratio=at_end.through_ratio,
        at_end_grade_ratio=dict(at_end.grade_ratio),
        past_planned_ratio=past_planned_ratio,
    )


def _spread(spread: Spread) -> SpreadMessage:
    return SpreadMessage(
        tip_ellipsoid_mm=spread.tip_ellipsoid_mm.tolist(),
        cone_95_deg=spread.cone_95_deg,
        tip_sd_mm=spread.tip_sd_mm,
        sd_angle_deg=spread.sd_angle_deg,
        sd_depth_mm=spread.sd_depth_mm,
        sd_at_entry_mm=finite(spread.sd_at_entry_mm),
    )


def _certain(certain: Certain) -> CertainMessage:
    return CertainMessage(
        enough=certain.enough,
        entry_95_mm=finite(certain.entry_95_mm),
        isthmus_95_mm=finite(certain.isthmus_95_mm),
        room_mm=certain.room_mm,
        room_deg=certain.room_deg,
    )
