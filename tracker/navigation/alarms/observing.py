"""From a snapshot to what the alarms look at; what lasts longer than an image is remembered here."""

from dataclasses import dataclass, replace
from math import isfinite

from tracker.navigation.alarms.observed import Observed, Site
from tracker.navigation.assessment import Assessment
from tracker.navigation.deviation import Deviation
from tracker.navigation.figures import FigureName, Status
from tracker.navigation.snapshot import Absent, AbsentReason, NavigationSnapshot
from tracker.plan import Channel
from tracker.pose import Seen

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
        drill_unseen_s=unseen_s,
        drill_put_away=unseen_s > put_away_after_s,
        camera_silent_s=silent_s,
        image_current=silent_s <= fresh_s,
        reference_unseen_s=reference_s if memory.navigating else 0.0,
        pose_certain=AbsentReason.POSE_UNCERTAIN not in reasons,
        pose_steady=AbsentReason.POSE_JUMPED not in reasons,
        camera_in_place=AbsentReason.CAMERA_MOVED not in reasons,
        reference_in_place=AbsentReason.REFERENCE_MOVED not in reasons,
        camera_change=next(iter(snapshot.watched.camera_changes), None),
    )
    return _with_figures(observed, snapshot) if observed.image_current else observed


def _with_figures(observed: Observed, snapshot: NavigationSnapshot) -> Observed:
    """With the worst figures of all tools: bone to the wall, depth, risk of a breach, uncertainty."""
    assessed = {name: one for name, one in snapshot.assessments.items() if isinstance(one, Assessment)}
    unseen = frozenset(snapshot.assessments) - frozenset(assessed)
    observed = replace(observed, unseen_tools=unseen if len(snapshot.tools) > 1 else frozenset())
    if not assessed:
        return observed
    limited = {name: one for name, one in assessed.items() if one.against is not None}
    deepest = max(assessed, key=lambda name: _past_mm(assessed[name], snapshot))
    observed = replace(
        observed,
        past_depth_mm=_past_mm(assessed[deepest], snapshot),
        depth_site=_site(snapshot, deepest, of_wall=False),
    )
    if not limited:
        return observed
    riskiest = max(limited, key=lambda name: limited[name].figures[FigureName.RISK].value)
    nearest = min(assessed, key=lambda name: _wall_mm(assessed[name]))
    errors = [one.figures[FigureName.ERROR] for one in limited.values()]
    # Of a drill across the channel it is infinite, and says nothing of how sure its pose is.
    finite = [error for error in errors if isfinite(error.value)]
    if finite:
        unsure = max(finite, key=lambda error: error.value - error.limit)
        observed = replace(observed, tip_sd_mm=unsure.value, max_tip_sd_mm=unsure.limit)
    return replace(
        observed,
        clearance_mm=_wall_mm(assessed[nearest]),
        wall_site=_site(snapshot, nearest, of_wall=True),
        breach_ratio=limited[riskiest].figures[FigureName.RISK].value / 100.0,
        risk_site=_site(snapshot, riskiest, of_wall=True),
    )


def _wall_mm(assessment: Assessment) -> float:
    """A drill that has not entered the bone is as far from its walls as can be."""
    wall = assessment.figures[FigureName.WALL]
    return NOT_ENTERED_MM if wall.status in (Status.OUTSIDE, Status.UNLIMITED) else wall.value


def _past_mm(assessment: Assessment, snapshot: NavigationSnapshot) -> float:
    """How far the tip is past the planned depth; a tip beside the pedicle is as far from it as can be."""
    to_go, channel = assessment.figures[FigureName.TO_GO], snapshot.setup.channel
    is_beside = to_go.status is Status.OUTSIDE
    return -channel.length_mm if is_beside and isinstance(channel, Channel) else -to_go.value


def _site(snapshot: NavigationSnapshot, tool: str, *, of_wall: bool) -> Site:
    assessment = snapshot.assessments[tool]
    if isinstance(assessment, Absent):
        raise TypeError(f"{tool} has no figures")
    return Site(
        depth_mm=assessment.figures[FigureName.DEPTH].value,
        wall=assessment.wall if of_wall else None,
        against=assessment.against if of_wall else None,
        tool=tool if len(snapshot.tools) > 1 else "",
    )


def _reasons(snapshot: NavigationSnapshot) -> frozenset[AbsentReason]:
    """Why there are no numbers, if there are none: of the tools, of the patient, of the whole."""
    deviations = snapshot.deviations.values()
    if any(isinstance(deviation, Deviation) for deviation in deviations):
        return frozenset()
    withheld = snapshot.setup.withheld
    absent = [one.reason for one in (*deviations, snapshot.vertebra) if isinstance(one, Absent)]
    return frozenset(absent if withheld is None else [*absent, withheld])
