"""Alarms: inputs, log and sounds.

The rules are in `tracker.navigation.alarms`; this package adds clock, screens, disk and people.
"""

from server.alarms.log import AlarmLog, NoLog, StoredAlarmLog
from server.alarms.service import AlarmService, ProcedureFacts, alarm_limits, without_alarms

__all__ = [
    "AlarmLog",
    "AlarmService",
    "NoLog",
    "ProcedureFacts",
    "StoredAlarmLog",
    "alarm_limits",
    "without_alarms",
]
