"""Temporal calibration: the constant offset between two sources' clocks, from a motion that both saw.

Angular velocities are compared as vectors, at the rotation between the two frames that fits best: they are
equal for every marker on a rigid tool, unlike the speeds of its points, and three signed components determine
more than one magnitude. A tool that is moved without being turned needs one same point in both sources.
"""

from tracker.pose.temporal_calibration.calibration import TimeOffset, calibrate_time_offset
from tracker.pose.temporal_calibration.limits import TimeOffsetLimits
from tracker.pose.temporal_calibration.series import Motion, PoseSeries

__all__ = ["Motion", "PoseSeries", "TimeOffset", "TimeOffsetLimits", "calibrate_time_offset"]
