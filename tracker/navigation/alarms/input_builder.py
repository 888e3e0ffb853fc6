"""Build the alarm inputs from a navigation snapshot and the history of previous images."""

from dataclasses import dataclass, replace
from math import isfinite

from tracker.navigation.alarms.inputs import AlarmInputs, Site
from tracker.navigation.assessment import Assessment
from tracker.navigation.deviation import Deviation
from tracker.navigation.figures import FigureName, Status
from tracker.navigation.snapshot import Absent, AbsentReason, NavigationSnapshot
from tracker.plan import Channel
from tracker.pose import Seen, Sighting, is_twice_in_view

NOT_ENTERED_CLEARANCE_MM = 100.0
NOT_REGISTERED = Absent(reason=AbsentReason.NOT_REGISTERED)
REFERENCE_UNSEEN = Absent(reason=AbsentReason.REFERENCE_UNSEEN)


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmInputHistory:
    """State carried over from previous images.

    Attributes:
        navigating: figures were displayed, and plan and registration are still valid.
        drill_seen_at_s: capture time of the last image with a visible tool, also where it is in view twice.
        reference_seen_at_s: capture time of the last image in which the patient's marker was not missing.
    """

    navigating: bool = False
    drill_seen_at_s: float = 0.0
    reference_seen_at_s: float = 0.0


def update_history(
    history: AlarmInputHistory, snapshot: NavigationSnapshot, *, now_s: float, fresh_s: float
) -> AlarmInputHistory:
    """Return the history after one more image, processed at `now_s`.

    Navigation starts with the first figures not older than `fresh_s`, because images are late during startup.
    It ends when channel or registration is removed, but not when figures are absent because of a lost marker
    or a motion, which alarms report.
    """
    setup, at_s = snapshot.setup, snapshot.captured_at_s
    if isinstance(setup.channel, Absent) or setup.registration == NOT_REGISTERED:
        history = replace(history, navigating=False)
    elif any(isinstance(deviation, Deviation) for deviation in snapshot.deviations.values()):
        history = replace(history, navigating=history.navigating or now_s - at_s <= fresh_s)
    markers = {tool.marker for tool in setup.tools.values()}
    # A marker that is in view twice is not missing; `MARKER_TWICE` reports it.
    if any(_is_in_view(snapshot.sightings.get(marker)) for marker in markers):
        history = replace(history, drill_seen_at_s=at_s)
    # Without a patient reference nothing is missing.
    if snapshot.vertebra != REFERENCE_UNSEEN:
        history = replace(history, reference_seen_at_s=at_s)
    return history


def _is_in_view(sighting: Sighting | None) -> bool:
    return isinstance(sighting, Seen) or is_twice_in_view(sighting)


def alarm_inputs(
    snapshot: NavigationSnapshot | None,
    history: AlarmInputHistory,
    *,
    now_s: float,
    fresh_s: float,
    put_away_after_s: float,
    navigating: bool | None = None,
) -> AlarmInputs:
    """Return the alarm inputs that follow from the newest image; the server adds its own.

    Args:
        snapshot: snapshot of the newest image; None before the first. When it is older than `fresh_s`, only
            its age is used and not its figures.
        history: history including this snapshot.
        now_s: present time on the clock of the capture time.
        fresh_s: maximum age of an image whose figures are used.
        put_away_after_s: a drill unseen for longer was put away.
        navigating: state of the procedure; None takes it from `history`.
    """
    navigates = history.navigating if navigating is None else navigating
    if snapshot is None:
        return AlarmInputs(navigating=navigates)
    unseen_s = max(0.0, snapshot.captured_at_s - history.drill_seen_at_s) if history.navigating else 0.0
    reference_s = max(0.0, snapshot.captured_at_s - history.reference_seen_at_s)
    reasons = _reasons(snapshot)
    silent_s = max(0.0, now_s - snapshot.captured_at_s)
    inputs = AlarmInputs(
        navigating=navigates,
        image_number=snapshot.image_number,
        captured_at_s=snapshot.captured_at_s,
        drill_unseen_s=unseen_s,
        drill_put_away=unseen_s > put_away_after_s,
        camera_silent_s=silent_s,
        image_current=silent_s <= fresh_s,
        reference_unseen_s=reference_s if history.navigating else 0.0,
        markers_unique=AbsentReason.MARKER_TWICE not in reasons,
        pose_certain=AbsentReason.POSE_UNCERTAIN not in reasons,
        pose_steady=AbsentReason.POSE_JUMPED not in reasons,
        camera_in_place=AbsentReason.CAMERA_MOVED not in reasons,
        reference_in_place=AbsentReason.REFERENCE_MOVED not in reasons,
        camera_change=next(iter(snapshot.motion.camera_changes), None),
        focal_length_error=snapshot.motion.focal_length_error,
    )
    return _with_figures(inputs, snapshot) if inputs.image_current else inputs


def _with_figures(inputs: AlarmInputs, snapshot: NavigationSnapshot) -> AlarmInputs:
    """Add the worst figures of all tools: clearance, depth, breach probability, uncertainty."""
    assessed = {name: one for name, one in snapshot.assessments.items() if isinstance(one, Assessment)}
    unseen = frozenset(snapshot.assessments) - frozenset(assessed)
    inputs = replace(inputs, unseen_tools=unseen if len(snapshot.tools) > 1 else frozenset())
    if not assessed:
        return inputs
    limited = {name: one for name, one in assessed.items() if one.against is not None}
    deepest = max(assessed, key=lambda name: _past_mm(assessed[name], snapshot))
    inputs = replace(
        inputs,
        past_depth_mm=_past_mm(assessed[deepest], snapshot),
        depth_site=_site(snapshot, deepest, of_wall=False),
    )
    if not limited:
        return inputs
    riskiest = max(limited, key=lambda name: _risk_ratio(limited[name]))
    nearest = min(assessed, key=lambda name: _wall_mm(assessed[name]))
    # For a drill across the channel it is infinite, which does not measure the pose uncertainty.
    finite = [one for one in limited.values() if isfinite(one.figures[FigureName.ERROR].value)]
    if finite:
        unsure = max(finite, key=_error_excess_mm)
        error = unsure.figures[FigureName.ERROR]
        inputs = replace(
            inputs,
            tip_sd_mm=error.value,
            max_tip_sd_mm=error.limit,
            setup_sufficient=unsure.setup_suffices,
        )
    return replace(
        inputs,
        clearance_mm=_wall_mm(assessed[nearest]),
        wall_site=_site(snapshot, nearest, of_wall=True),
        breach_ratio=_risk_ratio(limited[riskiest]),
        risk_site=_site(snapshot, riskiest, of_wall=True),
    )


def _error_excess_mm(assessment: Assessment) -> float:
    error = assessment.figures[FigureName.ERROR]
    return error.value - error.limit


def _wall_mm(assessment: Assessment) -> float:
    """Return the clearance in mm; `NOT_ENTERED_CLEARANCE_MM` for a drill outside the bone."""
    wall = assessment.figures[FigureName.WALL]
    return NOT_ENTERED_CLEARANCE_MM if wall.status in (Status.OUTSIDE, Status.UNLIMITED) else wall.value


def _risk_ratio(assessment: Assessment) -> float:
    """Return the probability of a breach; 0 for a drill at no wall, for which none is displayed."""
    risk = assessment.figures[FigureName.RISK]
    return 0.0 if risk.status is Status.OUTSIDE else risk.value / 100.0


def _past_mm(assessment: Assessment, snapshot: NavigationSnapshot) -> float:
    """Return the depth past the planned end; the smallest possible for a tip beside the pedicle."""
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
    """Return the reasons why no figures exist, of tools, vertebra and setup; empty if any exist."""
    deviations = snapshot.deviations.values()
    if any(isinstance(deviation, Deviation) for deviation in deviations):
        return frozenset()
    withheld = snapshot.setup.withheld
    absent = [one.reason for one in (*deviations, snapshot.vertebra) if isinstance(one, Absent)]
    return frozenset(absent if withheld is None else [*absent, withheld])
