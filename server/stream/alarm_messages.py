"""The alarms as they go over the wire, in the same message as the image that they were looked for in."""

from datetime import UTC, datetime

from server.clock import utc_text
from server.stream.assessment_messages import TextMessage, text_message
from server.stream.message import Message
from server.texts import alarm_text, without_live_figures
from tracker.navigation.alarms import (
    Alarm,
    AlarmPicture,
    AlarmState,
    Condition,
    Kind,
    Measure,
    Priority,
    Showing,
    Site,
    Sound,
)
from tracker.navigation.clearance import MeasuredAgainst
from tracker.navigation.directions import Wall


class MeasureMessage(Message):
    """A number and its limit."""

    value: float
    limit: float
    unit: str
    """Of both; "%" for a probability, empty for a count."""


class SiteMessage(Message):
    """Where in the bone a number was measured."""

    depth_mm: float
    """Of the tip, past the entry plane."""
    wall: Wall | None
    against: MeasuredAgainst | None
    tool: str | None
    """Null where there is only one."""


class AlarmMessage(Message):
    """One alarm that is to be seen."""

    number: int
    """Of this occurrence; whoever acknowledges names it."""
    condition: Condition
    priority: Priority
    kind: Kind
    state: AlarmState
    presence: Showing
    """Whether the newest moment shows it by its limit alone, without hysteresis; an alarm that is no longer
    present is described in the past tense and has no instruction."""
    raised_at: str
    """UTC, ISO 8601."""
    raised_s_ago: float
    measure: MeasureMessage | None
    """The newest number; null where it is no matter of a number."""
    site: SiteMessage | None
    worst: MeasureMessage | None
    """Since it was raised."""
    worst_at: str | None
    worst_site: SiteMessage | None
    earlier_worst: MeasureMessage | None
    """Of the occurrences before it that nobody has acknowledged."""
    earlier_worst_at: str | None
    acknowledged_by: str
    by: str
    """Who asks, where somebody does."""
    title: TextMessage
    """In capitals."""
    sentence: TextMessage
    """What is, or was, in numbers."""
    remedy: TextMessage
    """Empty where nothing is to be done but to acknowledge."""
    sentence_without_figures: TextMessage
    remedy_without_figures: TextMessage
    """How both read beside figures that are too old to be shown: what figures show is not known then."""
    known: TextMessage
    """Who has acknowledged it; empty where nobody has."""


class AlarmsMessage(Message):
    """All alarms at one moment."""

    revision: int
    """Grows with every change."""
    sound: Sound
    """What is to be heard now, by a screen whose sound is armed."""
    sound_number: int
    """Of the alarm that sounds; a new one begins the sound anew."""
    pause_left_s: float
    """How long the sound stays paused, if nothing new comes; 0 when it is not."""
    alarms: list[AlarmMessage]
    """What stands before what is over; of these the highest first."""


def alarms_message(picture: AlarmPicture, *, now_s: float) -> AlarmsMessage:
    """The message of a picture, as sent at monotonic time `now_s`."""
    return AlarmsMessage(
        revision=picture.revision,
        sound=picture.sound,
        sound_number=picture.sound_number,
        pause_left_s=max(0.0, picture.paused_until_s - now_s),
        alarms=[_alarm(alarm, now_s=now_s, unix_offset_s=picture.unix_offset_s) for alarm in picture.alarms],
    )


def _alarm(alarm: Alarm, *, now_s: float, unix_offset_s: float) -> AlarmMessage:
    words = alarm_text(alarm, unix_offset_s=unix_offset_s)
    unseen = without_live_figures(alarm)
    # Most alarms read the same: made once, because each image's message has them.
    without_figures = words if unseen is alarm else alarm_text(unseen, unix_offset_s=unix_offset_s)
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
        title=text_message(words.title),
        sentence=text_message(words.sentence),
        remedy=text_message(words.remedy),
        sentence_without_figures=text_message(without_figures.sentence),
        remedy_without_figures=text_message(without_figures.remedy),
        known=text_message(words.known),
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
