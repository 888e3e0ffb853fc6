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
class Occurrence:
    """One condition at one moment.

    Attributes:
        state: where it stands.
        raised_at_s: when it became active the last time.
        showing_since_s: from when on it shows without a break, while it is not yet raised; else infinite.
        showing_images: how many images in a row show it since then.
        gone_since_s: from when on it is gone without a break, while it is not yet cleared; else infinite.
        measure: the last number that was known.
        worst: the number when it was worst, since it was raised.
        worst_severity: how bad that was; larger is worse.
        worst_at_s, worst_site: when and where that was.
        site: where the last number was measured.
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
    worst: Measure | None = None
    site: Site | None = None
    worst_severity: float = -inf
    worst_at_s: float = 0.0
    worst_site: Site | None = None
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
        return replace(was, showing_since_s=inf, showing_images=0)
    since_s = min(was.showing_since_s, moment.at_s)
    images = was.showing_images + (1 if shows and moment.new_image else 0)
    now = replace(was, showing_since_s=since_s, showing_images=images)
    is_first = was.state is AlarmState.NORMAL and was.showing_since_s == inf
    now = _with_measure(now, evidence, moment, is_first=is_first)
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
            acknowledged_severity=was.worst_severity,
        )
    if was.state is AlarmState.LATCHED:
        # What shows again, and is not yet raised, goes on being confirmed; the worst is that of the last one.
        return replace(
            was,
            state=AlarmState.NORMAL,
            acknowledged_by="",
            worst=None,
            worst_site=None,
            worst_severity=-inf,
        )
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
        now = replace(_with_measure(was, evidence, moment), gone_since_s=gone_since_s)
        return _cleared(now, trait) if moment.at_s - gone_since_s >= trait.clear_s else now
    now = replace(_with_measure(was, evidence, moment), gone_since_s=inf)
    worse_by = now.worst_severity - was.acknowledged_severity
    if trait.latches and was.state is AlarmState.ACKNOWLEDGED and worse_by >= moment.again_after_mm:
        return _raised(now, moment)
    return now


def _raised(was: Occurrence, moment: Moment) -> Occurrence:
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
            worst=was.worst,
            worst_at_s=was.worst_at_s,
            worst_site=was.worst_site,
            raised_at_s=was.raised_at_s,
            control=was.control,
        )
    return replace(was, state=AlarmState.LATCHED, gone_since_s=inf)


def _with_measure(
    was: Occurrence, evidence: Evidence, moment: Moment, *, is_first: bool = False
) -> Occurrence:
    """With the number of this moment, and the worst one since the first; by whom it is asked."""
    if evidence.showing is Showing.UNKNOWN:
        return was
    now = replace(was, by=evidence.by or was.by, control=evidence.control or was.control)
    if evidence.measure is None:
        if is_first:
            return replace(now, measure=None, site=None, worst=None, worst_site=None)
        # It shows and has no number any more: the last one is not of now.
        return replace(now, measure=None, site=None) if evidence.showing is Showing.YES else now
    now = replace(now, measure=evidence.measure, site=evidence.site)
    if not is_first and was.worst is not None and evidence.severity <= was.worst_severity:
        return now
    return replace(
        now,
        worst=evidence.measure,
        worst_severity=evidence.severity,
        worst_at_s=moment.at_s,
        worst_site=evidence.site,
    )
