"""The alarms as they go over the wire, in the same message as the image that they were looked for in."""

from server.overlay.alarm_words import alarm_words
from server.stream.message import Message
from tracker.navigation.alarms import (
    Alarm,
    AlarmPicture,
    AlarmState,
    Condition,
    Kind,
    Measure,
    Priority,
    Sound,
)


class MeasureMessage(Message):
    """A number and its limit."""

    value: float
    limit: float
    unit: str
    """Of both; "%" for a probability, empty for a count."""


class AlarmMessage(Message):
    """One alarm that is to be seen."""

    number: int
    """Of this occurrence; whoever acknowledges names it."""
    condition: Condition
    priority: Priority
    kind: Kind
    state: AlarmState
    raised_s_ago: float
    measure: MeasureMessage | None
    """The newest number; null where it is no matter of a number."""
    worst: MeasureMessage | None
    """Since it was raised."""
    acknowledged_by: str
    by: str
    """Who asks, where somebody does."""
    sentence: str
    """In English: what happened, in numbers."""
    remedy: str


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
    """The highest first."""


def alarms_message(picture: AlarmPicture, *, now_s: float) -> AlarmsMessage:
    """The message of a picture, as sent at monotonic time `now_s`."""
    return AlarmsMessage(
        revision=picture.revision,
        sound=picture.sound,
        sound_number=picture.sound_number,
        pause_left_s=max(0.0, picture.paused_until_s - now_s),
        alarms=[_alarm(alarm, now_s=now_s) for alarm in picture.alarms],
    )


def _alarm(alarm: Alarm, *, now_s: float) -> AlarmMessage:
    words = alarm_words(alarm)
    return AlarmMessage(
        number=alarm.number,
        condition=alarm.condition,
        priority=alarm.priority,
        kind=alarm.kind,
        state=alarm.state,
        raised_s_ago=max(0.0, now_s - alarm.raised_at_s),
        measure=_measure(alarm.measure),
        worst=_measure(alarm.worst),
        acknowledged_by=alarm.acknowledged_by,
        by=alarm.by,
        sentence=words.sentence,
        remedy=words.remedy,
    )


def _measure(measure: Measure | None) -> MeasureMessage | None:
    if measure is None:
        return None
    return MeasureMessage(value=measure.value, limit=measure.limit, unit=measure.unit)
