"""The words and numbers of the panel: numbers when they are known, the reason when they are not."""

from dataclasses import dataclass

from server.shown import NOT_KNOWN, shown_number
from tracker.navigation import (
    Absent,
    AbsentReason,
    Deviation,
    NavigationSnapshot,
    ToolInView,
    Verdict,
    verdict_of,
)
from tracker.navigation.certainty import Judged
from tracker.navigation.clearance import Closest, DrillClearance, Nearest
from tracker.plan.screw import GertzbeinRobbins
from tracker.pose import Seen, Unseen, UnseenReason

RESEARCH_SOFTWARE = "research software, not a medical device"

STATE_WORDS = {
    AbsentReason.MARKER_UNSEEN: "NO TRACKING",
    AbsentReason.CAMERA_NOT_CALIBRATED: "CAMERA NOT CALIBRATED",
    AbsentReason.POSE_UNCERTAIN: "POSE UNCERTAIN",
    AbsentReason.TOOL_NOT_DEFINED: "TOOL NOT DEFINED",
    AbsentReason.NOT_REGISTERED: "NOT REGISTERED",
    AbsentReason.NO_PLAN: "NO PLAN",
    AbsentReason.REFERENCE_UNSEEN: "PATIENT NOT SEEN",
    AbsentReason.CAMERA_MOVED: "CAMERA MOVED",
    AbsentReason.REFERENCE_MOVED: "PATIENT MOVED",
    AbsentReason.POSE_JUMPED: "POSE JUMPED",
    AbsentReason.NOT_CHECKED: "NOT CHECKED",
    AbsentReason.NOT_CONFIRMED: "NAVIGATION STOPPED",
    AbsentReason.NOT_COSIGNED: "NOT CO-SIGNED",
}
STATE_DETAILS = {
    AbsentReason.MARKER_UNSEEN: "marker not seen",
    AbsentReason.CAMERA_NOT_CALIBRATED: "no millimetres without a camera file",
    AbsentReason.POSE_UNCERTAIN: "the tip is not sure enough",
    AbsentReason.TOOL_NOT_DEFINED: "where is the tip behind this marker?",
    AbsentReason.NOT_REGISTERED: "plan and patient do not know each other",
    AbsentReason.NO_PLAN: "there is no channel",
    AbsentReason.REFERENCE_UNSEEN: "the marker on the patient is not seen",
    AbsentReason.CAMERA_MOVED: "since the registration: register again",
    AbsentReason.REFERENCE_MOVED: "or the marker on the patient: check on a landmark",
    AbsentReason.POSE_JUMPED: "farther than a hand moves between two images",
    AbsentReason.NOT_CHECKED: "touch a landmark to check the registration",
    AbsentReason.NOT_CONFIRMED: "started again: look, then confirm",
    AbsentReason.NOT_COSIGNED: "a second person signs plan and registration",
}
VERDICT_WORDS = {
    Verdict.ON: "ON PATH",
    Verdict.OFF: "OFF PATH",
    Verdict.UNSURE: "UNSURE",
    Verdict.THROUGH: "THROUGH",
}
UNSEEN_WORDS = {
    UnseenReason.NO_CANDIDATE: "nothing looks like it",
    UnseenReason.SCORE_TOO_LOW: "too few of its edges",
    UnseenReason.TARGET_SCORE_TOO_LOW: "edges that it has not",
    UnseenReason.SHAPE_DIFFERS: "a look-alike: another shape inside",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Reading:
    """One number of the panel, as shown."""

    label: str
    value: str
    unit: str
    hint: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class VerdictSaid:
    """What one image says of the drill, and what is to be known of it; empty where the word says all."""

    verdict: Verdict
    word: str
    detail: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Panel:
    """What the panel says: readings of a tool and a quiet note, or in their place a state and its details."""

    tool: str = ""
    readings: tuple[Reading, ...] = ()
    note: str = ""
    verdict: VerdictSaid | None = None
    state: str = ""
    details: tuple[str, ...] = ()


def panel_of(snapshot: NavigationSnapshot) -> Panel:
    """The panel of one instant.

    With several tools: the first in the order of the setup whose numbers are known, named in the panel.
    """
    for name, deviation in snapshot.deviations.items():
        if isinstance(deviation, Deviation):
            judged = snapshot.judgements[name]
            readings = _readings(deviation, tool=name if len(snapshot.tools) > 1 else "")
            return Panel(
                tool=name,
                readings=(*readings, _wall_reading(judged)),
                note=_note(snapshot.tools[name]),
                verdict=None if isinstance(judged, Absent) else _verdict(judged),
            )
    reason, marker = _reason(snapshot)
    return Panel(state=STATE_WORDS[reason], details=_details(snapshot, reason, marker))


def _readings(deviation: Deviation, *, tool: str) -> tuple[Reading, ...]:
    return (
        Reading(label="ENTRY", value=shown_number(deviation.entry_offset_mm), unit="mm", hint=tool),
        Reading(label="ANGLE", value=shown_number(deviation.angle_deg), unit="°"),
        Reading(label="DEPTH", value=shown_number(deviation.depth_mm), unit="mm"),
        Reading(label="TO GO", value=shown_number(deviation.remaining_mm), unit="mm"),
    )


def _wall_reading(judged: Judged | Absent) -> Reading:
    """The least clearance of the whole drill, and which wall that is."""
    now = None if isinstance(judged, Absent) else judged.clearance.now
    if not isinstance(now, Nearest):
        return Reading(label="WALL", value=NOT_KNOWN, unit="mm")
    return Reading(label="WALL", value=shown_number(now.clearance_mm), unit="mm", hint=now.wall)


def _verdict(judged: Judged) -> VerdictSaid:
    verdict = verdict_of(judged)
    return VerdictSaid(verdict=verdict, word=VERDICT_WORDS[verdict], detail=_verdict_detail(verdict, judged))


def _verdict_detail(verdict: Verdict, judged: Judged) -> str:
    clearance, certain = judged.clearance, judged.certain
    if verdict is Verdict.UNSURE:
        widest_mm = max(certain.entry_95_mm, certain.isthmus_95_mm)
        return f"±{shown_number(widest_mm)} of {shown_number(certain.room_mm)} mm"
    if verdict is Verdict.THROUGH:
        return _through_detail(clearance)
    if verdict is Verdict.OFF:
        return _ahead_detail(clearance.at_end)
    return ""


def _through_detail(clearance: DrillClearance) -> str:
    now = clearance.now
    if isinstance(now, Nearest) and now.clearance_mm < 0.0:
        return f"{now.wall} wall, {shown_number(now.breach_mm)} mm"
    return f"{shown_number(clearance.past_planned_mm)} mm past the end"


def _ahead_detail(at_end: Closest) -> str:
    """What the present direction would give; where that is harmless, it is the channel that is left."""
    if not isinstance(at_end, Nearest):
        return "misses the pedicle"
    if at_end.grade is GertzbeinRobbins.A:
        return "leaves the channel"
    return f"ahead: {at_end.wall}, class {at_end.grade}"


def _note(tool: ToolInView | Absent) -> str:
    """That the numbers were steadied, and by how much they are late for it."""
    if isinstance(tool, Absent) or tool.lag_ms <= 0.0:
        return ""
    return f"steadied · {max(round(tool.lag_ms), 1)} ms behind"


def _reason(snapshot: NavigationSnapshot) -> tuple[AbsentReason, str]:
    """Why there are no numbers, and the marker whose matter it is, if it is one's."""
    for name, deviation in snapshot.deviations.items():
        if isinstance(deviation, Absent):
            return deviation.reason, snapshot.setup.tools[name].marker
    # No tool stands behind any marker; say first what stands first in the way.
    if not any(isinstance(sighting, Seen) for sighting in snapshot.sightings.values()):
        return AbsentReason.MARKER_UNSEEN, next(iter(snapshot.sightings), "")
    if not snapshot.setup.camera_calibrated:
        return AbsentReason.CAMERA_NOT_CALIBRATED, ""
    return AbsentReason.TOOL_NOT_DEFINED, ""


def _details(snapshot: NavigationSnapshot, reason: AbsentReason, marker: str) -> tuple[str, ...]:
    general = (STATE_DETAILS[reason],) if reason in STATE_DETAILS else ()
    sighting = snapshot.sightings.get(marker)
    if reason is AbsentReason.MARKER_UNSEEN and isinstance(sighting, Unseen):
        return (*general, f"{marker}: {UNSEEN_WORDS[sighting.reason]}")
    return general
