"""From a snapshot to what the alarms look at; what lasts longer than an image is remembered here."""

from dataclasses import dataclass, replace

from tracker.navigation.alarms.observed import NOT_KNOWN, Observed, Reading
from tracker.navigation.certainty import Judged
from tracker.navigation.clearance import Nearest
from tracker.navigation.deviation import Deviation
from tracker.navigation.snapshot import Absent, AbsentReason, NavigationSnapshot
from tracker.plan import Channel
from tracker.pose import Seen

# A tip farther than this from the channel's axis is not in this pedicle, however deep it is.
BESIDE_MM = 30.0
NOT_ENTERED_MM = 100.0
NOT_REGISTERED = Absent(reason=AbsentReason.NOT_REGISTERED)
REFERENCE_UNSEEN = Absent(reason=AbsentReason.REFERENCE_UNSEEN)


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


def remembered(memory: Memory, snapshot: NavigationSnapshot, *, now_s: float, fresh_s: float) -> Memory:
    """What is known after one more image, looked at `now_s`.

    Navigation begins with the first numbers that are not older than `fresh_s`: while everything is being
    started, images come late. It ends when there is no channel or no registration any more,
    but not when a marker, or what was moved, takes the numbers away: that is what alarms are for.
    """
    setup, at_s = snapshot.setup, snapshot.captured_at_s
    if isinstance(setup.channel, Absent) or setup.registration == NOT_REGISTERED:
        memory = replace(memory, navigating=False)
    elif any(isinstance(deviation, Deviation) for deviation in snapshot.deviations.values()):
        memory = replace(memory, navigating=memory.navigating or now_s - at_s <= fresh_s)
    markers = {tool.marker for tool in setup.tools.values()}
    if any(isinstance(snapshot.sightings.get(marker), Seen) for marker in markers):
        memory = replace(memory, drill_seen_at_s=at_s)
    # Where there is no patient reference, nothing is missed.
    if snapshot.vertebra != REFERENCE_UNSEEN:
        memory = replace(memory, reference_seen_at_s=at_s)
    return memory


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
        past_depth_mm=_past_depth_mm(snapshot) if silent_s <= fresh_s else NOT_KNOWN,
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
    """Why there are no numbers, if there are none: of the tools, of the patient, of the whole."""
    deviations = snapshot.deviations.values()
    if any(isinstance(deviation, Deviation) for deviation in deviations):
        return frozenset()
    withheld = snapshot.setup.withheld
    absent = [one.reason for one in (*deviations, snapshot.vertebra) if isinstance(one, Absent)]
    return frozenset(absent if withheld is None else [*absent, withheld])


def _past_depth_mm(snapshot: NavigationSnapshot) -> Reading:
    """How far the deepest tip is past the planned end, of those that are near the channel."""
    channel = snapshot.setup.channel
    if not isinstance(channel, Channel):
        return NOT_KNOWN
    past = [
        -deviation.remaining_mm
        for deviation in snapshot.deviations.values()
        if isinstance(deviation, Deviation) and deviation.tip_offset_mm <= channel.radius_mm + BESIDE_MM
    ]
    known = any(isinstance(deviation, Deviation) for deviation in snapshot.deviations.values())
    if past:
        return max(past)
    # Seen, and beside the patient: that is far from the end.
    return -channel.length_mm if known else NOT_KNOWN
