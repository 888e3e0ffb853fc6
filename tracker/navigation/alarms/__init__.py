"""Alarms: their conditions, and how they are raised, sounded, acknowledged and cleared.

All are pure functions of inputs and commands with their times, so replaying a recording reproduces the
alarms. Priorities, sounds and states follow IEC 60601-1-8 as quoted in manuals; no conformity is claimed.
"""

from tracker.navigation.alarms.engine import AlarmEngine
from tracker.navigation.alarms.evidence import Measure, Presence
from tracker.navigation.alarms.input_builder import AlarmInputHistory, alarm_inputs, update_history
from tracker.navigation.alarms.inputs import NOT_KNOWN, AlarmInputs, NotKnown, Reading, Site
from tracker.navigation.alarms.limits import MAX_PAUSE_S, AlarmLimits
from tracker.navigation.alarms.occurrence import AlarmState, Peak
from tracker.navigation.alarms.rules import ALARM_RULES, AlarmRule, Condition, Kind, Priority
from tracker.navigation.alarms.snapshot import QUIET, Alarm, AlarmEvent, AlarmSnapshot, Change, Sound

__all__ = [
    "ALARM_RULES",
    "MAX_PAUSE_S",
    "NOT_KNOWN",
    "QUIET",
    "Alarm",
    "AlarmEngine",
    "AlarmEvent",
    "AlarmInputHistory",
    "AlarmInputs",
    "AlarmLimits",
    "AlarmRule",
    "AlarmSnapshot",
    "AlarmState",
    "Change",
    "Condition",
    "Kind",
    "Measure",
    "NotKnown",
    "Peak",
    "Presence",
    "Priority",
    "Reading",
    "Site",
    "Sound",
    "alarm_inputs",
    "update_history",
]
