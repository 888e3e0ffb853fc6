"""One condition on its way: normal, active, acknowledged, cleared but latched, and back.

    normal --shows for its time--> active --gone for its time--> normal, or latched where it latches
    active --acknowledged--> acknowledged --gone--> normal;   acknowledged --worse--> active
    latched --acknowledged--> normal;   latched --shows again--> active

Every change is made by one of two pure functions here.
"""

from dataclasses import dataclass, replace
from enum import StrEnum
from math import inf

from tracker.camera import CameraControl
from tracker.navigation.alarms.conditions import Trait
from tracker.navigation.alarms.evidence import Evidence, Measure, Showing
from tracker.navigation.alarms.observed import Site


class AlarmState(StrEnum):
    """Where a condition stands."""

    NORMAL = "normal"  # nothing is said
    ACTIVE = "active"  # it is there, and sounds
    ACKNOWLEDGED = "acknowledged"  # it is there, somebody knows: in sight, without sound
    LATCHED = "latched"  # it was there, nobody has acknowledged it: in sight, without sound


@dataclass(frozen=True, slots=True, kw_only=True)
class Peak:
    """The worst moment of an occurrence.

    Attributes:
        measure: its number and limit.
        severity: how bad that was; larger is worse.
        at_s: when.
        site: where in the bone; None where it is no matter of a place.
    """

    measure: Measure
    severity: float
    at_s: float
    site: Site | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Occurrence:
    """One condition at one moment.

    Attributes:
        state: where it stands.
        raised_at_s: when it became active the last time.
        showing_since_s: from when on it shows without a break, while it is not yet raised; else infinite.
        showing_images: how many images in a row show it since then.
        gone_since_s: from when on it is gone without a break, while it is not yet cleared; else infinite.
        measure: the last number that was known.
        site: where the last number was measured.
        peak: the worst moment since it was raised; None where it is no matter of a number.
        pending_peak: likewise since it shows, while it is not yet raised.
        earlier_peak: the worst moment of the occurrences before this one that nobody has acknowledged.
        acknowledged_severity: how bad it was at worst when it was acknowledged.
        acknowledged_by: who did; empty when nobody did.
        by: who asks, where somebody does.
        control: of the camera that it is about, where it is about one.
    """

    state: AlarmState = AlarmState.NORMAL
    raised_at_s: float = 0.0
    showing_since_s: float = inf
    showing_images: int = 0
    gone_since_s: float = inf
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
    def is_standing(self) -> bool:
        """Whether the condition was raised and is not cleared."""
        return self.state in (AlarmState.ACTIVE, AlarmState.ACKNOWLEDGED)


@dataclass(frozen=True, slots=True, kw_only=True)
class Moment:
    """What a step knows beside the evidence.

    Attributes:
        at_s: its time.
        new_image: whether it brings one.
        image_gap_s: from the image before to this one.
        again_after_mm: how much worse an acknowledged alarm must get to sound again.
    """

    at_s: float
    new_image: bool = False
    image_gap_s: float = 0.0
    again_after_mm: float = inf


def advanced(was: Occurrence, evidence: Evidence, trait: Trait, moment: Moment) -> Occurrence:
    """The condition after one more moment."""
    if was.is_standing:
        return _standing(was, evidence, trait, moment)
    shows = evidence.showing is Showing.YES
    is_open = (evidence.showing is Showing.UNKNOWN and trait.holds) or evidence.superseded
    waits = was.showing_since_s < inf and is_open
    if not (shows or waits):
        return replace(was, showing_since_s=inf, showing_images=0, pending_peak=None)
    since_s = min(was.showing_since_s, moment.at_s)
    images = was.showing_images + (1 if shows and moment.new_image else 0)
    now = replace(was, showing_since_s=since_s, showing_images=images)
    now = _with_measure(now, evidence)
    now = replace(now, pending_peak=_worse(was.pending_peak, _peak(evidence, moment)))
    # What is superseded goes on being confirmed, and is raised when it shows itself.
    is_confirmed = _is_confirmed(now, trait, moment) and not evidence.superseded
    return _raised(now, moment) if is_confirmed else now


def acknowledged(was: Occurrence, *, by: str) -> Occurrence:
    """The condition after somebody has said that they know of it."""
    if was.state is AlarmState.ACTIVE:
        return replace(
            was,
            state=AlarmState.ACKNOWLEDGED,
            acknowledged_by=by,
            acknowledged_severity=-inf if was.peak is None else was.peak.severity,
        )
    if was.state is AlarmState.LATCHED:
        # What shows again, and is not yet raised, goes on being confirmed.
        return replace(was, state=AlarmState.NORMAL, acknowledged_by="", peak=None, earlier_peak=None)
    return was


def _is_confirmed(now: Occurrence, trait: Trait, moment: Moment) -> bool:
    if moment.at_s - now.showing_since_s >= trait.confirm_s:
        return True
    if trait.confirm_images == 0:
        return False
    # Of a slow camera, or after images that did not come, there is no time to wait for the next one.
    return now.showing_images >= trait.confirm_images or (
        moment.new_image and now.showing_images > 0 and moment.image_gap_s >= trait.confirm_s
    )


def _standing(was: Occurrence, evidence: Evidence, trait: Trait, moment: Moment) -> Occurrence:
    gone = evidence.showing is Showing.NO or (evidence.showing is Showing.UNKNOWN and not trait.holds)
    if gone:
        gone_since_s = min(was.gone_since_s, moment.at_s)
        now = replace(_at_worst(was, evidence, moment), gone_since_s=gone_since_s)
        return _cleared(now, trait) if moment.at_s - gone_since_s >= trait.clear_s else now
    now = replace(_at_worst(was, evidence, moment), gone_since_s=inf)
    worse_by = (-inf if now.peak is None else now.peak.severity) - was.acknowledged_severity
    if trait.latches and was.state is AlarmState.ACKNOWLEDGED and worse_by >= moment.again_after_mm:
        return _raised(now, moment)
    return now


def _raised(was: Occurrence, moment: Moment) -> Occurrence:
    if not was.is_standing:
        # One that is over and not acknowledged keeps its own worst moment beside that of the new one.
        is_latched = was.state is AlarmState.LATCHED
        earlier = _worse(was.earlier_peak, was.peak) if is_latched else None
        was = replace(was, peak=was.pending_peak, pending_peak=None, earlier_peak=earlier)
    return replace(
        was,
        state=AlarmState.ACTIVE,
        raised_at_s=moment.at_s,
        showing_since_s=inf,
        showing_images=0,
        gone_since_s=inf,
        acknowledged_by="",
        acknowledged_severity=inf,
    )


def _cleared(was: Occurrence, trait: Trait) -> Occurrence:
    latched = trait.latches and was.state is AlarmState.ACTIVE
    if not latched:
        return Occurrence(
            measure=was.measure,
            site=was.site,
            peak=was.peak,
            raised_at_s=was.raised_at_s,
            control=was.control,
        )
    return replace(was, state=AlarmState.LATCHED, gone_since_s=inf)


def _at_worst(was: Occurrence, evidence: Evidence, moment: Moment) -> Occurrence:
    """With the number of this moment, and the worst moment since it was raised."""
    return replace(_with_measure(was, evidence), peak=_worse(was.peak, _peak(evidence, moment)))


def _with_measure(was: Occurrence, evidence: Evidence) -> Occurrence:
    """With the number of this moment, and by whom it is asked."""
    if evidence.showing is Showing.UNKNOWN:
        return was
    now = replace(was, by=evidence.by or was.by, control=evidence.control or was.control)
    if evidence.measure is None:
        # It shows and has no number any more: the last one is not of now.
        return replace(now, measure=None, site=None) if evidence.showing is Showing.YES else now
    return replace(now, measure=evidence.measure, site=evidence.site)


def _peak(evidence: Evidence, moment: Moment) -> Peak | None:
    if evidence.showing is Showing.UNKNOWN or evidence.measure is None:
        return None
    return Peak(measure=evidence.measure, severity=evidence.severity, at_s=moment.at_s, site=evidence.site)


def _worse(one: Peak | None, other: Peak | None) -> Peak | None:
    """The worse of two; of two that are equally bad the first."""
    if one is None or other is None:
        return one or other
    return other if other.severity > one.severity else one
