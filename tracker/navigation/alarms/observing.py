"""From a snapshot to what the alarms look at; what lasts longer than an image is remembered here."""

from dataclasses import dataclass, replace

from tracker.navigation.alarms.observed import NOT_CHECKED, Observed, Reading
from tracker.navigation.certainty import Judged
from tracker.navigation.clearance import Nearest
from tracker.navigation.deviation import Deviation
from tracker.navigation.snapshot import Absent, AbsentReason, NavigationSnapshot
from tracker.plan import Channel
from tracker.pose import Seen

# A tip farther than this from the channel's axis is not in this pedicle, however deep it is.
BESIDE_MM = 30.0
NOT_ENTERED_MM = 100.0
ENDS_NAVIGATION = frozenset({AbsentReason.NO_PLAN, AbsentReason.NOT_REGISTERED})


@dataclass(frozen=True, slots=True, kw_only=True)
class Memory:
    """What the images before have left.

    Attributes:
        navigating: there were numbers, and plan and registration still stand.
        drill_seen_at_s: the capture time of the last image in which a tool was seen.
        reference_seen_at_s: of the last image that did not miss the patient's marker.
    """

    navigating: bool = False
    drill_seen_at_s: float = 0.0
    reference_seen_at_s: float = 0.0


def remembered(memory: Memory, snapshot: NavigationSnapshot) -> Memory:
    """What is known after one more image.

    Navigation begins with the first numbers. It ends when there is no channel or no registration any more,
    but not when a marker, or what was moved, takes the numbers away: that is what alarms are for.
    """
    at_s = snapshot.captured_at_s
    deviations = snapshot.deviations.values()
    if any(isinstance(deviation, Deviation) for deviation in deviations):
        memory = replace(memory, navigating=True)
    elif any(isinstance(one, Absent) and one.reason in ENDS_NAVIGATION for one in deviations):
        memory = replace(memory, navigating=False)
    markers = {tool.marker for tool in snapshot.setup.tools.values()}
    if any(isinstance(snapshot.sightings.get(marker), Seen) for marker in markers):
        memory = replace(memory, drill_seen_at_s=at_s)
    # Where there is no patient reference, nothing is missed.
    if not _waits_for_reference(snapshot):
        memory = replace(memory, reference_seen_at_s=at_s)
    return memory


def _waits_for_reference(snapshot: NavigationSnapshot) -> bool:
    return AbsentReason.REFERENCE_UNSEEN in _reasons(snapshot)


def observed_of(
    snapshot: NavigationSnapshot | None,
    memory: Memory,
    *,
    now_s: float,
    fresh_s: float,
    put_away_after_s: float,
    navigating: bool | None = None,
) -> Observed:
    """What the alarms look at, as far as the newest image says it; the server adds what it knows itself.

    Args:
        snapshot: of the newest image; None before the first. It is kept while no other comes: its numbers
            are not used then, its age is.
        memory: with this snapshot in it.
        now_s: the same clock as the capture time.
        fresh_s: the numbers of an image older than this are not known any more.
        put_away_after_s: a drill unseen for longer lies somewhere on purpose.
        navigating: what the procedure says; None leaves it to `memory`.
    """
    navigates = memory.navigating if navigating is None else navigating
    if snapshot is None:
        return Observed(navigating=navigates)
    unseen_s = max(0.0, snapshot.captured_at_s - memory.drill_seen_at_s) if memory.navigating else 0.0
    reference_s = max(0.0, snapshot.captured_at_s - memory.reference_seen_at_s)
    reasons = _reasons(snapshot)
    silent_s = max(0.0, now_s - snapshot.captured_at_s)
    observed = Observed(
        navigating=navigates,
        image_number=snapshot.image_number,
        captured_at_s=snapshot.captured_at_s,
        past_depth_mm=_past_depth_mm(snapshot) if silent_s <= fresh_s else NOT_CHECKED,
        drill_unseen_s=unseen_s,
        drill_put_away=unseen_s > put_away_after_s,
        camera_silent_s=silent_s,
        reference_unseen_s=reference_s if memory.navigating else 0.0,
        pose_certain=AbsentReason.POSE_UNCERTAIN not in reasons,
        pose_steady=AbsentReason.POSE_JUMPED not in reasons,
        camera_in_place=AbsentReason.CAMERA_MOVED not in reasons,
        reference_in_place=AbsentReason.REFERENCE_MOVED not in reasons,
    )
    return _with_judgements(observed, snapshot) if silent_s <= fresh_s else observed


def _with_judgements(observed: Observed, snapshot: NavigationSnapshot) -> Observed:
    """With the worst of what was concluded of each tool: clearance, chance of a breach, how unsure it is."""
    judged = [one for one in snapshot.judgements.values() if isinstance(one, Judged)]
    if not judged:
        return observed
    # A drill that has not entered the bone is as far from its walls as can be.
    clearances = [
        one.clearance.now.clearance_mm if isinstance(one.clearance.now, Nearest) else NOT_ENTERED_MM
        for one in judged
    ]
    unsure = max(judged, key=lambda one: _unsure_mm(one) - one.certain.room_mm)
    return replace(
        observed,
        clearance_mm=min(clearances),
        breach_ratio=max(max(one.now.through_ratio, one.soon.through_ratio) for one in judged),
        tip_sd_mm=_unsure_mm(unsure),
        most_tip_sd_mm=unsure.certain.room_mm,
    )


def _unsure_mm(judged: Judged) -> float:
    return max(judged.certain.entry_95_mm, judged.certain.isthmus_95_mm)


def _reasons(snapshot: NavigationSnapshot) -> frozenset[AbsentReason]:
    """Why the tools have no numbers, if none of them has."""
    absent = [one for one in snapshot.deviations.values() if isinstance(one, Absent)]
    if len(absent) < len(snapshot.deviations):
        return frozenset()
    return frozenset(one.reason for one in absent)


def _past_depth_mm(snapshot: NavigationSnapshot) -> Reading:
    """How far the deepest tip is past the planned end, of those that are near the channel."""
    channel = snapshot.setup.channel
    if not isinstance(channel, Channel):
        return NOT_CHECKED
    past = [
        -deviation.remaining_mm
        for deviation in snapshot.deviations.values()
        if isinstance(deviation, Deviation) and deviation.tip_offset_mm <= channel.radius_mm + BESIDE_MM
    ]
    known = any(isinstance(deviation, Deviation) for deviation in snapshot.deviations.values())
    if past:
        return max(past)
    # Seen, and beside the patient: that is far from the end.
    return -channel.length_mm if known else NOT_CHECKED
