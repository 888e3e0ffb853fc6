"""Alarm messages, sent with the image in which they were evaluated."""

from datetime import UTC, datetime

from server.clock import utc_text
from server.stream.assessment_messages import TextMessage, text_message
from server.stream.message import Message
from server.texts import alarm_text, with_unknown_presence
from tracker.navigation.alarms import (
    Alarm,
    AlarmSnapshot,
    AlarmState,
    Condition,
    Kind,
    Measure,
    Presence,
    Priority,
    Site,
    Sound,
)
from tracker.navigation.clearance import WallSource
from tracker.navigation.directions import Wall


class MeasureMessage(Message):
    """A value and its limit."""

    value: float
    limit: float
    unit: str
    """Of both; "%" for a probability, empty for a count."""


class SiteMessage(Message):
    """Location in the bone at which a value was measured."""

    depth_mm: float
    """Of the tip, past the entry plane."""
    wall: Wall | None
    against: WallSource | None
    tool: str | None
    """Null with a single tool."""


class AlarmMessage(Message):
    """One displayed alarm."""

    number: int
    """Of this occurrence; an acknowledgement names it."""
    condition: Condition
    priority: Priority
    kind: Kind
    state: AlarmState
    presence: Presence
    """Whether the newest image shows it by its limit alone, without hysteresis; an alarm that is no longer
    present is described in the past tense and has no instruction."""
    raised_at: str
    """UTC, ISO 8601."""
    raised_s_ago: float
    measure: MeasureMessage | None
    """The newest value; null for an alarm without a value."""
    site: SiteMessage | None
    worst: MeasureMessage | None
    """Since it was raised."""
    worst_at: str | None
    worst_site: SiteMessage | None
    earlier_worst: MeasureMessage | None
    """Of earlier occurrences that nobody has acknowledged."""
    earlier_worst_at: str | None
    acknowledged_by: str
    by: str
    """Who requests it, for a hold."""
    title: TextMessage
    """In capitals."""
    sentence: TextMessage
    """The condition, present or past, with numbers."""
    remedy: TextMessage
    """Empty where it only has to be acknowledged."""
    sentence_without_figures: TextMessage
    remedy_without_figures: TextMessage
    """Both texts beside figures that are too old to be shown."""
    known: TextMessage
    """Who has acknowledged it; empty where nobody has."""


class AlarmsMessage(Message):
    """All alarms at one moment."""

    revision: int
    """Grows with every change."""
    sound: Sound
    """The sound to be played by a screen whose sound is armed."""
    sound_number: int
    """Number of the alarm that sounds; a new one restarts the sound."""
    pause_left_s: float
    """Remaining pause of the sound, without a new alarm; 0 when it is not paused."""
    alarms: list[AlarmMessage]
    """Present alarms before past ones; within both the highest priority first."""


def alarms_message(picture: AlarmSnapshot, *, now_s: float) -> AlarmsMessage:
    """Return the message of an alarm picture, sent at monotonic time `now_s`."""
    return AlarmsMessage(
        revision=picture.revision,
        sound=picture.sound,
        sound_number=picture.sound_number,
        pause_left_s=max(0.0, picture.paused_until_s - now_s),
        alarms=[_alarm(alarm, now_s=now_s, unix_offset_s=picture.unix_offset_s) for alarm in picture.alarms],
    )


def _alarm(alarm: Alarm, *, now_s: float, unix_offset_s: float) -> AlarmMessage:
    texts = alarm_text(alarm, unix_offset_s=unix_offset_s)
    unseen = with_unknown_presence(alarm)
    # Most alarms have equal texts, which are then made once: every image's message contains them.
    without_figures = texts if unseen is alarm else alarm_text(unseen, unix_offset_s=unix_offset_s)
    peak, earlier = alarm.peak, alarm.earlier_peak
    return AlarmMessage(
        number=alarm.number,
        condition=alarm.condition,
        priority=alarm.priority,
        kind=alarm.kind,
        state=alarm.state,
        presence=alarm.presence,
        raised_at=_utc(alarm.raised_at_s + unix_offset_s),
        raised_s_ago=max(0.0, now_s - alarm.raised_at_s),
        measure=_measure(alarm.measure),
        site=_site(alarm.site),
        worst=None if peak is None else _measure(peak.measure),
        worst_at=None if peak is None else _utc(peak.at_s + unix_offset_s),
        worst_site=None if peak is None else _site(peak.site),
        earlier_worst=None if earlier is None else _measure(earlier.measure),
        earlier_worst_at=None if earlier is None else _utc(earlier.at_s + unix_offset_s),
        acknowledged_by=alarm.acknowledged_by,
        by=alarm.by,
        title=text_message(texts.title),
        sentence=text_message(texts.sentence),
        remedy=text_message(texts.remedy),
        sentence_without_figures=text_message(without_figures.sentence),
        remedy_without_figures=text_message(without_figures.remedy),
        known=text_message(texts.known),
    )


def _measure(measure: Measure | None) -> MeasureMessage | None:
    if measure is None:
        return None
    return MeasureMessage(value=measure.value, limit=measure.limit, unit=measure.unit)


def _site(site: Site | None) -> SiteMessage | None:
    if site is None:
        return None
    return SiteMessage(depth_mm=site.depth_mm, wall=site.wall, against=site.against, tool=site.tool or None)


def _utc(unix_s: float) -> str:
    return utc_text(datetime.fromtimestamp(unix_s, tz=UTC))
