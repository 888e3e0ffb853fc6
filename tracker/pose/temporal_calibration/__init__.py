"""Temporal calibration: the constant offset between two sources' clocks, from a motion that both saw."""

from tracker.pose.temporal_calibration.calibration import TimeOffset, calibrate_time_offset
from tracker.pose.temporal_calibration.limits import TimeOffsetLimits
from tracker.pose.temporal_calibration.series import Motion, PoseSeries

__all__ = ["Motion", "PoseSeries", "TimeOffset", "TimeOffsetLimits", "calibrate_time_offset"]
