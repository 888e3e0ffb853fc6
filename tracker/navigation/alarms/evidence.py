"""Evaluate the alarm conditions: presence, measured value and limit."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from math import isnan
from types import MappingProxyType
from typing import TypeAlias

from tracker.camera import CameraControl
from tracker.navigation.alarms.inputs import AlarmInputs, NotKnown, Site
from tracker.navigation.alarms.limits import AlarmLimits
from tracker.navigation.alarms.rules import ALARM_RULES, Condition
from tracker.photometric import MAX_FOCAL_LENGTH_ERROR_RATIO


class Presence(StrEnum):
    """Return whether a condition is present."""

    YES = "yes"
    NO = "no"
    UNKNOWN = "unknown"


@dataclass(frozen=True, slots=True, kw_only=True)
class Measure:
    """A value and its limit, in displayed units.

    Attributes:
        value: measured.
        limit: allowed.
        unit: of both; "%" for a probability, empty for a count.
    """

    value: float
    limit: float
    unit: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Evidence:
    """Result of evaluating one condition at one step.

    Attributes:
        presence: whether the condition is present.
        measure: the value and its limit; None if there is none or it is not known.
        severity: severity in the unit of the measure; larger is worse. 0 without a measure.
        site: where in the bone the value was measured; None if not applicable.
        by: name of the requesting person, if any.
        control: the camera control concerned, if any.
        superseded: hidden by a more severe condition; its confirmation time continues meanwhile.
    """

    presence: Presence
    measure: Measure | None = None
    severity: float = 0.0
    site: Site | None = None
    by: str = ""
    control: CameraControl | None = None
    superseded: bool = False


MAX_UNSEEN_WHILE_CLEARING_S = 0.25
MIN_CLEAR_RATIO = 0.02

# A doubtful focal length stays so until its error is this share of the limit.
FOCAL_LENGTH_CLEAR_RATIO = 0.8

UNKNOWN = Evidence(presence=Presence.UNKNOWN)
GONE = Evidence(presence=Presence.NO)
SUPERSEDED = Evidence(presence=Presence.NO, superseded=True)
Evaluator: TypeAlias = Callable[[AlarmInputs, AlarmLimits, bool], Evidence]


def evaluate_condition(
    condition: Condition, inputs: AlarmInputs, limits: AlarmLimits, *, raised: bool
) -> Evidence:
    """Evaluate a condition; a raised one clears only past its hysteresis."""
    if not (inputs.navigating or ALARM_RULES[condition].outside_navigation):
        return GONE
    if ALARM_RULES[condition].needs_current_image and not inputs.image_current:
        return UNKNOWN
    return _EVALUATORS[condition](inputs, limits, raised)


def _showing(shows: bool) -> Presence:
    return Presence.YES if shows else Presence.NO


def _flag(shows: bool) -> Evidence:
    return Evidence(presence=_showing(shows))


def _breach(inputs: AlarmInputs, limits: AlarmLimits, raised: bool) -> Evidence:
    clearance_mm = inputs.clearance_mm
    if isinstance(clearance_mm, NotKnown) or isnan(clearance_mm):
        return UNKNOWN
    shows = clearance_mm < (limits.hysteresis_mm if raised else 0.0)
    measure = Measure(value=clearance_mm, limit=0.0, unit="mm")
    return Evidence(presence=_showing(shows), measure=measure, severity=-clearance_mm, site=inputs.wall_site)


def _past_depth(inputs: AlarmInputs, limits: AlarmLimits, raised: bool) -> Evidence:
    past_mm = inputs.past_depth_mm
    if isinstance(past_mm, NotKnown) or isnan(past_mm):
        return UNKNOWN
    shows = past_mm > (-limits.hysteresis_mm if raised else 0.0)
    measure = Measure(value=past_mm, limit=0.0, unit="mm")
    return Evidence(presence=_showing(shows), measure=measure, severity=past_mm, site=inputs.depth_site)


def _breach_likely(inputs: AlarmInputs, limits: AlarmLimits, raised: bool) -> Evidence:
    ratio, clearance_mm = inputs.breach_ratio, inputs.clearance_mm
    if isinstance(ratio, NotKnown):
        return UNKNOWN
    if not isinstance(clearance_mm, NotKnown) and clearance_mm < 0.0:
        return SUPERSEDED
    limit = limits.breach_ratio
    measure = Measure(value=ratio * 100.0, limit=limit * 100.0, unit="%")
    # NaN counts as over the limit.
    if not ratio <= limit:
        return Evidence(presence=Presence.YES, measure=measure, severity=measure.value, site=inputs.risk_site)
    # Probabilities are displayed in whole percent, so with a lower threshold only 0 would clear the alarm.
    clears_at = max(limit - limits.breach_hysteresis_ratio, min(limit, MIN_CLEAR_RATIO))
    stays = raised and ratio > clears_at
    return Evidence(presence=_showing(stays), measure=measure, severity=measure.value, site=inputs.risk_site)


def _clearance_low(inputs: AlarmInputs, limits: AlarmLimits, raised: bool) -> Evidence:
    clearance_mm = inputs.clearance_mm
    if isinstance(clearance_mm, NotKnown) or isnan(clearance_mm):
        return UNKNOWN
    if clearance_mm < 0.0:
        # A breach is a separate alarm of higher priority.
        return SUPERSEDED
    limit = limits.warning_distance_mm
    measure = Measure(value=clearance_mm, limit=limit, unit="mm")
    shows = clearance_mm < limit + (limits.hysteresis_mm if raised else 0.0)
    return Evidence(presence=_showing(shows), measure=measure, severity=-clearance_mm, site=inputs.wall_site)


def _unseen(unseen_s: float, limit_s: float, raised: bool) -> Evidence:
    measure = Measure(value=unseen_s, limit=limit_s, unit="s")
    # Single missed images of a visible marker must not keep the alarm raised.
    shows = unseen_s > (min(MAX_UNSEEN_WHILE_CLEARING_S, limit_s) if raised else limit_s)
    return Evidence(presence=_showing(shows), measure=measure, severity=measure.value)


def _drill_unseen(inputs: AlarmInputs, limits: AlarmLimits, raised: bool) -> Evidence:
    if inputs.drill_put_away:
        return GONE
    return _unseen(inputs.drill_unseen_s, limits.drill_unseen_after_s, raised)


def _reference_unseen(inputs: AlarmInputs, limits: AlarmLimits, raised: bool) -> Evidence:
    return _unseen(inputs.reference_unseen_s, limits.reference_unseen_after_s, raised)


def _camera_stalled(inputs: AlarmInputs, limits: AlarmLimits, raised: bool) -> Evidence:
    del raised
    limit_s = limits.camera_silent_after_s
    measure = Measure(value=inputs.camera_silent_s, limit=limit_s, unit="s")
    # A stopped camera or tracker has its own alarm.
    works = inputs.camera_works and inputs.tracker_works
    shows = works and inputs.camera_silent_s > limit_s
    return Evidence(presence=_showing(shows), measure=measure, severity=measure.value)


def _pose_uncertain(inputs: AlarmInputs, limits: AlarmLimits, raised: bool) -> Evidence:
    sd_mm, max_mm = inputs.tip_sd_mm, inputs.max_tip_sd_mm
    if not inputs.pose_certain:
        return Evidence(presence=Presence.YES)
    if isinstance(sd_mm, NotKnown) or isinstance(max_mm, NotKnown):
        return UNKNOWN
    # A better view cannot reduce this error; SETUP_INSUFFICIENT reports it.
    return _error_over(sd_mm, max_mm, limits, raised) if inputs.setup_sufficient else SUPERSEDED


def _setup_insufficient(inputs: AlarmInputs, limits: AlarmLimits, raised: bool) -> Evidence:
    sd_mm, max_mm = inputs.tip_sd_mm, inputs.max_tip_sd_mm
    if isinstance(sd_mm, NotKnown) or isinstance(max_mm, NotKnown):
        return UNKNOWN
    return GONE if inputs.setup_sufficient else _error_over(sd_mm, max_mm, limits, raised)


def _error_over(sd_mm: float, max_mm: float, limits: AlarmLimits, raised: bool) -> Evidence:
    measure = Measure(value=sd_mm, limit=max_mm, unit="mm")
    # With a hysteresis larger than the limit the alarm could never be cleared.
    clears_at_mm = max(max_mm - limits.hysteresis_mm, 0.8 * max_mm)
    shows = not sd_mm <= (clears_at_mm if raised else max_mm)
    return Evidence(presence=_showing(shows), measure=measure, severity=measure.value)


def _camera_changed(inputs: AlarmInputs, limits: AlarmLimits, raised: bool) -> Evidence:
    """Evaluate changes of camera controls: any difference counts, because one focus step moves the lens."""
    del limits, raised
    change = inputs.camera_change
    if change is None:
        return GONE
    measure = Measure(value=float(change.now), limit=float(change.calibrated), unit="")
    severity = float(abs(change.now - change.calibrated))
    return Evidence(presence=Presence.YES, measure=measure, severity=severity, control=change.control)


def _focal_length_doubtful(inputs: AlarmInputs, limits: AlarmLimits, raised: bool) -> Evidence:
    del limits
    error = inputs.focal_length_error
    if error is None:
        return GONE
    measure = Measure(value=100.0 * abs(error.ratio), limit=100.0 * MAX_FOCAL_LENGTH_ERROR_RATIO, unit="%")
    stays = raised and measure.value > FOCAL_LENGTH_CLEAR_RATIO * measure.limit
    shows = error.is_doubtful or stays
    return Evidence(presence=_showing(shows), measure=measure, severity=measure.value)


def _check_due(inputs: AlarmInputs, limits: AlarmLimits, raised: bool) -> Evidence:
    del raised
    age_s = inputs.check_age_s
    if isinstance(age_s, NotKnown):
        return UNKNOWN
    measure = Measure(value=age_s / 60.0, limit=limits.check_due_after_s / 60.0, unit="min")
    shows = age_s > limits.check_due_after_s
    return Evidence(presence=_showing(shows), measure=measure, severity=measure.value)


def _no_armed_screen(inputs: AlarmInputs, limits: AlarmLimits, raised: bool) -> Evidence:
    del limits, raised
    measure = Measure(value=float(inputs.armed_screens), limit=1.0, unit="")
    return Evidence(presence=_showing(inputs.armed_screens == 0), measure=measure)


def _disk_nearly_full(inputs: AlarmInputs, limits: AlarmLimits, raised: bool) -> Evidence:
    free_mb = inputs.free_disk_mb
    if isinstance(free_mb, NotKnown):
        return UNKNOWN
    min_mb = limits.min_free_disk_mb
    measure = Measure(value=free_mb, limit=min_mb, unit="MB")
    shows = free_mb < min_mb * (1.1 if raised else 1.0)
    return Evidence(presence=_showing(shows), measure=measure, severity=-free_mb)


def _hold_requested(inputs: AlarmInputs, limits: AlarmLimits, raised: bool) -> Evidence:
    del limits, raised
    by = inputs.hold_requested_by
    return Evidence(presence=_showing(bool(by)), by=by)


_EVALUATORS: Mapping[Condition, Evaluator] = MappingProxyType(
    {
        Condition.BREACH: _breach,
        Condition.PAST_DEPTH: _past_depth,
        Condition.BREACH_LIKELY: _breach_likely,
        Condition.CLEARANCE_LOW: _clearance_low,
        Condition.DRILL_UNSEEN: _drill_unseen,
        Condition.REFERENCE_UNSEEN: _reference_unseen,
        Condition.MARKER_TWICE: lambda inputs, _limits, _raised: _flag(not inputs.markers_unique),
        Condition.CAMERA_STALLED: _camera_stalled,
        Condition.CAMERA_GONE: lambda inputs, _limits, _raised: _flag(not inputs.camera_works),
        Condition.TRACKING_STOPPED: lambda inputs, _limits, _raised: _flag(not inputs.tracker_works),
        Condition.POSE_UNCERTAIN: _pose_uncertain,
        Condition.SETUP_INSUFFICIENT: _setup_insufficient,
        Condition.POSE_JUMPED: lambda inputs, _limits, _raised: _flag(not inputs.pose_steady),
        Condition.CAMERA_MOVED: lambda inputs, _limits, _raised: _flag(not inputs.camera_in_place),
        Condition.REFERENCE_MOVED: lambda inputs, _limits, _raised: _flag(not inputs.reference_in_place),
        Condition.CAMERA_CHANGED: _camera_changed,
        Condition.FOCAL_LENGTH_DOUBTFUL: _focal_length_doubtful,
        Condition.REGISTRATION_OUT_OF_DATE: lambda inputs, _limits, _raised: _flag(
            not inputs.registration_current
        ),
        Condition.CALIBRATION_OUT_OF_DATE: lambda inputs, _limits, _raised: _flag(
            not inputs.calibration_current
        ),
        Condition.CHECK_DUE: _check_due,
        Condition.NO_ARMED_SCREEN: _no_armed_screen,
        Condition.DISK_NEARLY_FULL: _disk_nearly_full,
        Condition.VIEWER_LOST: lambda inputs, _limits, _raised: _flag(inputs.lost_screens > 0),
        Condition.RECORDING_STOPPED: lambda inputs, _limits, _raised: _flag(not inputs.recording_runs),
        Condition.HOLD_REQUESTED: _hold_requested,
    }
)
