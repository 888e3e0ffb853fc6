"""The alarms: which conditions raise them, how they come, sound, are acknowledged and go.

Pure: moments and commands with their time go in, pictures come out, and a recording replayed gives the same
alarms. Priorities, sounds and states follow what manuals quote of IEC 60601-1-8; no conformity is claimed.
"""

from tracker.navigation.alarms.conditions import TRAITS, Condition, Kind, Priority, Trait
from tracker.navigation.alarms.engine import AlarmEngine
from tracker.navigation.alarms.evidence import Measure, Showing
from tracker.navigation.alarms.limits import MAX_PAUSE_S, AlarmLimits
from tracker.navigation.alarms.observed import NOT_KNOWN, NotKnown, Observed, Reading, Site
from tracker.navigation.alarms.observing import Memory, observed_of, remembered
from tracker.navigation.alarms.occurrence import AlarmState, Peak
from tracker.navigation.alarms.picture import QUIET, Alarm, AlarmEvent, AlarmPicture, Change, Sound

__all__ = [
    "MAX_PAUSE_S",
    "NOT_KNOWN",
    "QUIET",
    "TRAITS",
    "Alarm",
    "AlarmEngine",
    "AlarmEvent",
    "AlarmLimits",
    "AlarmPicture",
    "AlarmState",
    "Change",
    "Condition",
    "Kind",
    "Measure",
    "Memory",
    "NotKnown",
    "Observed",
    "Peak",
    "Priority",
    "Reading",
    "Showing",
    "Site",
    "Sound",
    "Trait",
    "observed_of",
    "remembered",
]
