"""Which conditions one moment shows, with the number and the limit that say so."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from math import isnan
from types import MappingProxyType
from typing import TypeAlias

from tracker.camera import CameraControl
from tracker.navigation.alarms.conditions import TRAITS, Condition
from tracker.navigation.alarms.limits import AlarmLimits
from tracker.navigation.alarms.observed import NotKnown, Observed, Site


class Showing(StrEnum):
    """Whether a condition is there."""

    YES = "yes"
    NO = "no"
    UNKNOWN = "unknown"


@dataclass(frozen=True, slots=True, kw_only=True)
class Measure:
    """A number and its limit, in the words of a person.

    Attributes:
        value: what was found.
        limit: what was allowed.
        unit: of both; "%" for a probability, empty for a count.
    """

    value: float
    limit: float
    unit: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Evidence:
    """What one moment says of one condition.

    Attributes:
        showing: whether it is there.
        measure: the number that says so; None where it is no matter of a number, or it is not known.
        severity: how bad it is, in the unit of the measure; larger is worse. 0 where there is no measure.
        site: where in the bone the number was measured; None where it is no matter of a place.
        by: who asks, where somebody does.
        control: of the camera that it is about, where it is about one.
        superseded: it does not show because a louder condition does; should that go at once, its own
            confirmation has gone on.
    """

    showing: Showing
    measure: Measure | None = None
    severity: float = 0.0
    site: Site | None = None
    by: str = ""
    control: CameraControl | None = None
    superseded: bool = False


BACK_IN_SIGHT_S = 0.25
MIN_CLEAR_RATIO = 0.02

UNKNOWN = Evidence(showing=Showing.UNKNOWN)
GONE = Evidence(showing=Showing.NO)
SUPERSEDED = Evidence(showing=Showing.NO, superseded=True)
Judge: TypeAlias = Callable[[Observed, AlarmLimits, bool], Evidence]


def evidence_of(condition: Condition, observed: Observed, limits: AlarmLimits, *, standing: bool) -> Evidence:
    """What this moment says of a condition; one that is standing clears only past its hysteresis."""
    if not (observed.navigating or TRAITS[condition].always):
        return GONE
    if TRAITS[condition].of_newest_image and not observed.image_current:
        return UNKNOWN
    return _JUDGES[condition](observed, limits, standing)


def _showing(shows: bool) -> Showing:
    return Showing.YES if shows else Showing.NO


def _flag(shows: bool) -> Evidence:
    return Evidence(showing=_showing(shows))


def _breach(observed: Observed, limits: AlarmLimits, standing: bool) -> Evidence:
    clearance_mm = observed.clearance_mm
    if isinstance(clearance_mm, NotKnown) or isnan(clearance_mm):
        return UNKNOWN
    shows = clearance_mm < (limits.hysteresis_mm if standing else 0.0)
    measure = Measure(value=clearance_mm, limit=0.0, unit="mm")
    return Evidence(showing=_showing(shows), measure=measure, severity=-clearance_mm, site=observed.wall_site)


def _past_depth(observed: Observed, limits: AlarmLimits, standing: bool) -> Evidence:
    past_mm = observed.past_depth_mm
    if isinstance(past_mm, NotKnown) or isnan(past_mm):
        return UNKNOWN
    shows = past_mm > (-limits.hysteresis_mm if standing else 0.0)
    measure = Measure(value=past_mm, limit=0.0, unit="mm")
    return Evidence(showing=_showing(shows), measure=measure, severity=past_mm, site=observed.depth_site)


def _breach_likely(observed: Observed, limits: AlarmLimits, standing: bool) -> Evidence:
    ratio, clearance_mm = observed.breach_ratio, observed.clearance_mm
    if isinstance(ratio, NotKnown):
        return UNKNOWN
    if not isinstance(clearance_mm, NotKnown) and clearance_mm < 0.0:
        return SUPERSEDED
    limit = limits.breach_ratio
    measure = Measure(value=ratio * 100.0, limit=limit * 100.0, unit="%")
    # Also what is no number.
    if not ratio <= limit:
        return Evidence(showing=Showing.YES, measure=measure, severity=measure.value, site=observed.risk_site)
    # Probabilities come in whole percents: lower than this nothing but 0 would clear it.
    clears_at = max(limit - limits.breach_hysteresis_ratio, min(limit, MIN_CLEAR_RATIO))
    stays = standing and ratio > clears_at
    return Evidence(showing=_showing(stays), measure=measure, severity=measure.value, site=observed.risk_site)


def _clearance_low(observed: Observed, limits: AlarmLimits, standing: bool) -> Evidence:
    clearance_mm = observed.clearance_mm
    if isinstance(clearance_mm, NotKnown) or isnan(clearance_mm):
        return UNKNOWN
    if clearance_mm < 0.0:
        # Through the wall is another alarm, and the louder one.
        return SUPERSEDED
    limit = limits.warning_distance_mm
    measure = Measure(value=clearance_mm, limit=limit, unit="mm")
    shows = clearance_mm < limit + (limits.hysteresis_mm if standing else 0.0)
    return Evidence(showing=_showing(shows), measure=measure, severity=-clearance_mm, site=observed.wall_site)


def _unseen(unseen_s: float, limit_s: float, standing: bool) -> Evidence:
    measure = Measure(value=unseen_s, limit=limit_s, unit="s")
    # A marker that is back is missed in single images; those do not hold the alarm.
    shows = unseen_s > (min(BACK_IN_SIGHT_S, limit_s) if standing else limit_s)
    return Evidence(showing=_showing(shows), measure=measure, severity=measure.value)


def _drill_unseen(observed: Observed, limits: AlarmLimits, standing: bool) -> Evidence:
    if observed.drill_put_away:
        return GONE
    return _unseen(observed.drill_unseen_s, limits.drill_unseen_after_s, standing)


def _reference_unseen(observed: Observed, limits: AlarmLimits, standing: bool) -> Evidence:
    return _unseen(observed.reference_unseen_s, limits.reference_unseen_after_s, standing)


def _camera_stalled(observed: Observed, limits: AlarmLimits, standing: bool) -> Evidence:
    del standing
    limit_s = limits.camera_silent_after_s
    measure = Measure(value=observed.camera_silent_s, limit=limit_s, unit="s")
    # Which of the two does not work is said by name.
    works = observed.camera_works and observed.tracker_works
    shows = works and observed.camera_silent_s > limit_s
    return Evidence(showing=_showing(shows), measure=measure, severity=measure.value)


def _pose_uncertain(observed: Observed, limits: AlarmLimits, standing: bool) -> Evidence:
    sd_mm, max_mm = observed.tip_sd_mm, observed.max_tip_sd_mm
    if not observed.pose_certain:
        return Evidence(showing=Showing.YES)
    if isinstance(sd_mm, NotKnown) or isinstance(max_mm, NotKnown):
        return UNKNOWN
    measure = Measure(value=sd_mm, limit=max_mm, unit="mm")
    # A hysteresis larger than the limit could never be cleared.
    clears_at_mm = max(max_mm - limits.hysteresis_mm, 0.8 * max_mm)
    shows = not sd_mm <= (clears_at_mm if standing else max_mm)
    return Evidence(showing=_showing(shows), measure=measure, severity=measure.value)


def _camera_changed(observed: Observed, limits: AlarmLimits, standing: bool) -> Evidence:
    """Any difference: a focus that stepped once has moved the lens, and steps again."""
    del limits, standing
    change = observed.camera_change
    if change is None:
        return GONE
    measure = Measure(value=float(change.now), limit=float(change.calibrated), unit="")
    severity = float(abs(change.now - change.calibrated))
    return Evidence(showing=Showing.YES, measure=measure, severity=severity, control=change.control)


def _check_due(observed: Observed, limits: AlarmLimits, standing: bool) -> Evidence:
    del standing
    age_s = observed.check_age_s
    if isinstance(age_s, NotKnown):
        return UNKNOWN
    measure = Measure(value=age_s / 60.0, limit=limits.check_due_after_s / 60.0, unit="min")
    shows = age_s > limits.check_due_after_s
    return Evidence(showing=_showing(shows), measure=measure, severity=measure.value)


def _no_armed_screen(observed: Observed, limits: AlarmLimits, standing: bool) -> Evidence:
    del limits, standing
    measure = Measure(value=float(observed.armed_screens), limit=1.0, unit="")
    return Evidence(showing=_showing(observed.armed_screens == 0), measure=measure)


def _disk_nearly_full(observed: Observed, limits: AlarmLimits, standing: bool) -> Evidence:
    free_mb = observed.free_disk_mb
    if isinstance(free_mb, NotKnown):
        return UNKNOWN
    min_mb = limits.min_free_disk_mb
    measure = Measure(value=free_mb, limit=min_mb, unit="MB")
    shows = free_mb < min_mb * (1.1 if standing else 1.0)
    return Evidence(showing=_showing(shows), measure=measure, severity=-free_mb)


def _hold_asked(observed: Observed, limits: AlarmLimits, standing: bool) -> Evidence:
    del limits, standing
    by = observed.hold_asked_by
    return Evidence(showing=_showing(bool(by)), by=by)


_JUDGES: Mapping[Condition, Judge] = MappingProxyType(
    {
        Condition.BREACH: _breach,
        Condition.PAST_DEPTH: _past_depth,
        Condition.BREACH_LIKELY: _breach_likely,
        Condition.CLEARANCE_LOW: _clearance_low,
        Condition.DRILL_UNSEEN: _drill_unseen,
        Condition.REFERENCE_UNSEEN: _reference_unseen,
        Condition.CAMERA_STALLED: _camera_stalled,
        Condition.CAMERA_GONE: lambda observed, _limits, _standing: _flag(not observed.camera_works),
        Condition.TRACKING_STOPPED: lambda observed, _limits, _standing: _flag(not observed.tracker_works),
        Condition.POSE_UNCERTAIN: _pose_uncertain,
        Condition.POSE_JUMPED: lambda observed, _limits, _standing: _flag(not observed.pose_steady),
        Condition.CAMERA_MOVED: lambda observed, _limits, _standing: _flag(not observed.camera_in_place),
        Condition.REFERENCE_MOVED: lambda observed, _limits, _standing: _flag(
            not observed.reference_in_place
        ),
        Condition.CAMERA_CHANGED: _camera_changed,
        Condition.REGISTRATION_OUT_OF_DATE: lambda observed, _limits, _standing: _flag(
            not observed.registration_current
        ),
        Condition.CALIBRATION_OUT_OF_DATE: lambda observed, _limits, _standing: _flag(
            not observed.calibration_current
        ),
        Condition.CHECK_DUE: _check_due,
        Condition.NO_ARMED_SCREEN: _no_armed_screen,
        Condition.DISK_NEARLY_FULL: _disk_nearly_full,
        Condition.VIEWER_LOST: lambda observed, _limits, _standing: _flag(observed.lost_screens > 0),
        Condition.RECORDING_STOPPED: lambda observed, _limits, _standing: _flag(not observed.recording_runs),
        Condition.HOLD_ASKED: _hold_asked,
    }
)
