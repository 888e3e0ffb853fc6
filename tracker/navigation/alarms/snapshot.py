"""The alarms at one step: their states, the sound, and the changes since the previous step."""

from dataclasses import dataclass
from enum import StrEnum

from tracker.camera import CameraControl
from tracker.navigation.alarms.evidence import Measure, Presence
from tracker.navigation.alarms.inputs import Site
from tracker.navigation.alarms.occurrence import AlarmState, Peak
from tracker.navigation.alarms.rules import ALARM_RULES, Condition, Kind, Priority


class Sound(StrEnum):
    """Sound to play; one at a time."""

    SILENT = "silent"
    LOW = "low"
    MEDIUM = "medium"
    HIGH = "high"


class Change(StrEnum):
    """Change of an alarm or of the sound."""

    RAISED = "raised"
    WORSE = "worse"  # acknowledged, then worse: it sounds again
    CLEARED = "cleared"
    LATCHED = "latched"  # cleared, and still displayed because nobody acknowledged it
    ACKNOWLEDGED = "acknowledged"
    PAUSED = "paused"
    RESUMED = "resumed"  # somebody ended the pause
    PAUSE_OVER = "pause_over"  # the pause expired
    PAUSE_BROKEN = "pause_broken"  # a new alarm ended the pause


@dataclass(frozen=True, slots=True, kw_only=True)
class Alarm:
    """One displayed alarm.

    Attributes:
        number: number of this occurrence; increases with each raised alarm. Acknowledgements refer to it.
        condition: the condition that raised it.
        state: active, acknowledged or latched.
        raised_at_s: time at which it was raised.
        presence: whether the newest step shows the condition by its limit alone, without hysteresis. An alarm
            that is no longer present is described in the past tense.
        measure: the newest value and its limit; None without a value.
        site: position in the bone of that value.
        peak: the most severe moment since it was raised.
        earlier_peak: the most severe moment of the previous, unacknowledged occurrences.
        acknowledged_by: name of the acknowledging person; empty for none.
        by: name of the requesting person, if any.
        control: the camera control concerned, if any.
    """

    number: int
    condition: Condition
    state: AlarmState
    raised_at_s: float
    presence: Presence = Presence.YES
    measure: Measure | None = None
    site: Site | None = None
    peak: Peak | None = None
    earlier_peak: Peak | None = None
    acknowledged_by: str = ""
    by: str = ""
    control: CameraControl | None = None

    @property
    def priority(self) -> Priority:
        """Return the priority of the condition."""
        return ALARM_RULES[self.condition].priority

    @property
    def kind(self) -> Kind:
        """Return the category of the condition."""
        return ALARM_RULES[self.condition].kind


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmEvent:
    """One change, for the log.

    Attributes:
        at_s: time of the change.
        change: kind of the change.
        alarm: the alarm after the change; None if the change concerns all alarms.
        by: name of the person who caused it; empty for none.
        pause_s: duration of a pause of the sound.
    """

    at_s: float
    change: Change
    alarm: Alarm | None = None
    by: str = ""
    pause_s: float = 0.0

    @property
    def condition(self) -> Condition | None:
        """Condition of the alarm; None if the change concerns all alarms."""
        return None if self.alarm is None else self.alarm.condition


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmSnapshot:
    """All alarms at one step.

    Attributes:
        at_s: time of the step.
        alarms: the displayed ones: by priority, then active, latched, acknowledged, then newest first.
        sound: to play now.
        sound_number: number of the sounding alarm; 0 if none. A new number restarts the sound.
        paused_until_s: latest end of the pause of the sound; 0 if not paused.
        revision: increases with every change.
        events: changes since the previous snapshot.
        unix_offset_s: added to these times gives Unix time; the engine has no clock and leaves it 0.
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
        """Return the first alarm; None if there is none."""
        return self.alarms[0] if self.alarms else None

    @property
    def pause_left_s(self) -> float:
        """Return the remaining pause of the sound [s]; a new alarm can end it earlier."""
        return max(0.0, self.paused_until_s - self.at_s)


QUIET = AlarmSnapshot()
