"""What the alarms say at one moment: which stand, which one sounds, and what has just changed."""

from dataclasses import dataclass
from enum import StrEnum

from tracker.camera import CameraControl
from tracker.navigation.alarms.conditions import TRAITS, Condition, Kind, Priority
from tracker.navigation.alarms.evidence import Measure, Showing
from tracker.navigation.alarms.observed import Site
from tracker.navigation.alarms.occurrence import AlarmState, Peak


class Sound(StrEnum):
    """What is to be heard: one sound at a time."""

    SILENT = "silent"
    LOW = "low"
    MEDIUM = "medium"
    HIGH = "high"


class Change(StrEnum):
    """What may happen to an alarm, or to the sound of all."""

    RAISED = "raised"
    WORSE = "worse"  # acknowledged, then worse: it sounds again
    CLEARED = "cleared"
    LATCHED = "latched"  # cleared, and kept in sight because nobody has acknowledged it
    ACKNOWLEDGED = "acknowledged"
    PAUSED = "paused"
    RESUMED = "resumed"  # somebody ended the pause
    PAUSE_OVER = "pause_over"  # its time was over
    PAUSE_BROKEN = "pause_broken"  # by an alarm that it was not made for


@dataclass(frozen=True, slots=True, kw_only=True)
class Alarm:
    """One alarm that is to be seen.

    Attributes:
        number: of this occurrence; grows by one with each that is raised. Whoever acknowledges names it.
        condition: what it is.
        state: active, acknowledged or latched.
        raised_at_s: when.
        presence: whether the newest moment shows it, by its limit alone, without hysteresis. An alarm that
            is no longer present is described in the past tense.
        measure: the newest number and its limit; None where it is no matter of a number.
        site: where in the bone that was.
        peak: the worst moment since it was raised.
        earlier_peak: the worst moment of the occurrences before it that nobody has acknowledged.
        acknowledged_by: who knows of it; empty when nobody does.
        by: who asks, where somebody does.
        control: of the camera that it is about, where it is about one.
    """

    number: int
    condition: Condition
    state: AlarmState
    raised_at_s: float
    presence: Showing = Showing.YES
    measure: Measure | None = None
    site: Site | None = None
    peak: Peak | None = None
    earlier_peak: Peak | None = None
    acknowledged_by: str = ""
    by: str = ""
    control: CameraControl | None = None

    @property
    def priority(self) -> Priority:
        """How urgent it is."""
        return TRAITS[self.condition].priority

    @property
    def kind(self) -> Kind:
        """What it is about."""
        return TRAITS[self.condition].kind


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmEvent:
    """One change, for the log.

    Attributes:
        at_s: when.
        change: what happened.
        alarm: as it is after the change; None where it is a matter of all.
        by: who did it; empty when nobody did.
        pause_s: how long the sound is paused, where it is.
    """

    at_s: float
    change: Change
    alarm: Alarm | None = None
    by: str = ""
    pause_s: float = 0.0

    @property
    def condition(self) -> Condition | None:
        """Of the alarm; None where it is a matter of all."""
        return None if self.alarm is None else self.alarm.condition


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmPicture:
    """All alarms at one moment.

    Attributes:
        at_s: the moment.
        alarms: those to be seen: what stands before what is over (latched), then the highest first, of these
            what is active first, then the newest first.
        sound: what is to be heard now.
        sound_number: of the alarm that sounds; 0 while none does. A new number begins the sound anew.
        paused_until_s: until when the sound is paused, at the latest; 0 when it is not.
        revision: grows with every change.
        events: what changed since the picture before.
        unix_offset_s: to be added to these times to have Unix time; the engine has no clock, and leaves it 0.
    """

    at_s: float = 0.0
    alarms: tuple[Alarm, ...] = ()
    sound: Sound = Sound.SILENT
    sound_number: int = 0
    paused_until_s: float = 0.0
    revision: int = 0
    events: tuple[AlarmEvent, ...] = ()
    unix_offset_s: float = 0.0

    @property
    def top(self) -> Alarm | None:
        """The first of them; None when all is well."""
        return self.alarms[0] if self.alarms else None

    @property
    def pause_left_s(self) -> float:
        """How long the sound stays paused, if nothing new comes."""
        return max(0.0, self.paused_until_s - self.at_s)


QUIET = AlarmPicture()
