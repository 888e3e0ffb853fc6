"""State machine of one alarm condition: normal, active, acknowledged, latched.

    normal --present for confirm_s--> active --absent for clear_s--> normal, or latched if the rule latches
    active --acknowledged--> acknowledged --absent--> normal;   acknowledged --worse--> active
    latched --acknowledged--> normal;   latched --present again--> active

Two pure functions make all transitions: `advanced` and `acknowledged`.
"""

from dataclasses import dataclass, replace
from enum import StrEnum
from math import inf

from tracker.camera import CameraControl
from tracker.navigation.alarms.evidence import Evidence, Measure, Presence
from tracker.navigation.alarms.inputs import Site
from tracker.navigation.alarms.rules import AlarmRule


class AlarmState(StrEnum):
    """State of an alarm."""

    NORMAL = "normal"  # no alarm
    ACTIVE = "active"  # present, with sound
    ACKNOWLEDGED = "acknowledged"  # present and acknowledged: displayed, without sound
    LATCHED = "latched"  # cleared but not acknowledged: displayed, without sound


@dataclass(frozen=True, slots=True, kw_only=True)
class Peak:
    """The most severe moment of an occurrence.

    Attributes:
        measure: its value and limit.
        severity: larger is worse.
        at_s: its time.
        site: position in the bone; None if not applicable.
    """

    measure: Measure
    severity: float
    at_s: float
    site: Site | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Occurrence:
    """State of one condition at one step.

    Attributes:
        state: of the alarm.
        raised_at_s: time at which it last became active.
        present_since_s: start of the uninterrupted presence while not yet raised; else infinite.
        present_images: number of consecutive images since then.
        absent_since_s: start of the uninterrupted absence while not yet cleared; else infinite.
        measure: the last known value.
        site: where that value was measured.
        peak: the most severe moment since it was raised; None without a value.
        pending_peak: the same since it is present, while not yet raised.
        earlier_peak: the most severe moment of the previous, unacknowledged occurrences.
        acknowledged_severity: severity of the peak at the acknowledgement.
        acknowledged_by: name of the acknowledging person; empty for none.
        by: name of the requesting person, if any.
        control: the camera control concerned, if any.
    """

    state: AlarmState = AlarmState.NORMAL
    raised_at_s: float = 0.0
    present_since_s: float = inf
    present_images: int = 0
    absent_since_s: float = inf
    measure: Measure | None = None
    site: Site | None = None
    peak: Peak | None = None
    pending_peak: Peak | None = None
    earlier_peak: Peak | None = None
    acknowledged_severity: float = inf
    acknowledged_by: str = ""
    by: str = ""
    control: CameraControl | None = None

    @property
    def is_raised(self) -> bool:
        """Return whether the condition was raised and is not cleared."""
        return self.state in (AlarmState.ACTIVE, AlarmState.ACKNOWLEDGED)


@dataclass(frozen=True, slots=True, kw_only=True)
class StepContext:
    """Time and image of one step.

    Attributes:
        at_s: time of the step.
        new_image: whether it has a new image.
        image_gap_s: from the previous image to this one.
        realarm_after_mm: increase in severity after which an acknowledged alarm sounds again.
    """

    at_s: float
    new_image: bool = False
    image_gap_s: float = 0.0
    realarm_after_mm: float = inf


def advanced(was: Occurrence, evidence: Evidence, trait: AlarmRule, moment: StepContext) -> Occurrence:
    """Return the occurrence after one more step."""
    if was.is_raised:
        return _advance_raised(was, evidence, trait, moment)
    shows = evidence.presence is Presence.YES
    is_open = (evidence.presence is Presence.UNKNOWN and trait.persists_when_unknown) or evidence.superseded
    is_pending = was.present_since_s < inf
    if not (shows or (is_pending and is_open)):
        # Most conditions at most steps: none is present, and a copy of each would cost more than all else.
        return replace(was, present_since_s=inf, present_images=0, pending_peak=None) if is_pending else was
    since_s = min(was.present_since_s, moment.at_s)
    images = was.present_images + (1 if shows and moment.new_image else 0)
    now = replace(was, present_since_s=since_s, present_images=images)
    now = _with_measure(now, evidence)
    now = replace(now, pending_peak=_worse(was.pending_peak, _peak(evidence, moment)))
    # A superseded condition continues its confirmation, and is raised once it is not superseded.
    is_confirmed = _is_confirmed(now, trait, moment) and not evidence.superseded
    return _raised(now, moment) if is_confirmed else now


def acknowledged(was: Occurrence, *, by: str) -> Occurrence:
    """Return the occurrence after it was acknowledged."""
    if was.state is AlarmState.ACTIVE:
        return replace(
            was,
            state=AlarmState.ACKNOWLEDGED,
            acknowledged_by=by,
            acknowledged_severity=-inf if was.peak is None else was.peak.severity,
        )
    if was.state is AlarmState.LATCHED:
        # A condition that is present again but not yet raised continues its confirmation.
        return replace(was, state=AlarmState.NORMAL, acknowledged_by="", peak=None, earlier_peak=None)
    return was


def _is_confirmed(now: Occurrence, trait: AlarmRule, moment: StepContext) -> bool:
    if moment.at_s - now.present_since_s >= trait.confirm_s:
        return True
    if trait.confirm_images == 0:
        return False
    # With a slow camera or missing images, the confirmation time can end before the next image.
    return now.present_images >= trait.confirm_images or (
        moment.new_image and now.present_images > 0 and moment.image_gap_s >= trait.confirm_s
    )


def _advance_raised(was: Occurrence, evidence: Evidence, trait: AlarmRule, moment: StepContext) -> Occurrence:
    gone = evidence.presence is Presence.NO or (
        evidence.presence is Presence.UNKNOWN and not trait.persists_when_unknown
    )
    if gone:
        absent_since_s = min(was.absent_since_s, moment.at_s)
        now = replace(_at_worst(was, evidence, moment), absent_since_s=absent_since_s)
        return _cleared(now, trait) if moment.at_s - absent_since_s >= trait.clear_s else now
    now = replace(_at_worst(was, evidence, moment), absent_since_s=inf)
    worse_by = (-inf if now.peak is None else now.peak.severity) - was.acknowledged_severity
    if trait.latches and was.state is AlarmState.ACKNOWLEDGED and worse_by >= moment.realarm_after_mm:
        return _raised(now, moment)
    return now


def _raised(was: Occurrence, moment: StepContext) -> Occurrence:
    if not was.is_raised:
        # A latched alarm retains its own peak in addition to that of the new occurrence.
        is_latched = was.state is AlarmState.LATCHED
        earlier = _worse(was.earlier_peak, was.peak) if is_latched else None
        was = replace(was, peak=was.pending_peak, pending_peak=None, earlier_peak=earlier)
    return replace(
        was,
        state=AlarmState.ACTIVE,
        raised_at_s=moment.at_s,
        present_since_s=inf,
        present_images=0,
        absent_since_s=inf,
        acknowledged_by="",
        acknowledged_severity=inf,
    )


def _cleared(was: Occurrence, trait: AlarmRule) -> Occurrence:
    latched = trait.latches and was.state is AlarmState.ACTIVE
    if not latched:
        return Occurrence(
            measure=was.measure,
            site=was.site,
            peak=was.peak,
            raised_at_s=was.raised_at_s,
            control=was.control,
        )
    return replace(was, state=AlarmState.LATCHED, absent_since_s=inf)


def _at_worst(was: Occurrence, evidence: Evidence, moment: StepContext) -> Occurrence:
    """Return the occurrence with the value of this step and an updated peak."""
    return replace(_with_measure(was, evidence), peak=_worse(was.peak, _peak(evidence, moment)))


def _with_measure(was: Occurrence, evidence: Evidence) -> Occurrence:
    """Return the occurrence with the value and requester of this step."""
    if evidence.presence is Presence.UNKNOWN:
        return was
    now = replace(was, by=evidence.by or was.by, control=evidence.control or was.control)
    if evidence.measure is None:
        # The condition is present without a value: the last value is outdated.
        return replace(now, measure=None, site=None) if evidence.presence is Presence.YES else now
    return replace(now, measure=evidence.measure, site=evidence.site)


def _peak(evidence: Evidence, moment: StepContext) -> Peak | None:
    if evidence.presence is Presence.UNKNOWN or evidence.measure is None:
        return None
    return Peak(measure=evidence.measure, severity=evidence.severity, at_s=moment.at_s, site=evidence.site)


def _worse(one: Peak | None, other: Peak | None) -> Peak | None:
    """Return the more severe of two peaks; the first one if equal."""
    if one is None or other is None:
        return one or other
    return other if other.severity > one.severity else one
