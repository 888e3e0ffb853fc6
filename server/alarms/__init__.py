"""Alarms: what they look at, what is kept of them, and how they sound.

Their rules are in `tracker.navigation.alarms`; here are the clock, the screens, the disk and the people.
"""

from server.alarms.desk import AlarmDesk, ProcedureFacts, alarm_limits, no_alarms
from server.alarms.log import AlarmLog, NoLog, StoredAlarmLog

__all__ = [
    "AlarmDesk",
    "AlarmLog",
    "NoLog",
    "ProcedureFacts",
    "StoredAlarmLog",
    "alarm_limits",
    "no_alarms",
]
