"""Temporal calibration: the constant offset between two sources' clocks, from a motion that both recorded.

The angular velocities are cross-correlated as vectors, after the best rotation between the two frames
(Kabsch). Unlike the velocities of points, they are equal for every marker on a rigid tool, and three signed
components contain more information than one magnitude. A motion without rotation requires the same point in
both sources.
"""

from tracker.pose.temporal_calibration.calibration import TimeOffset, calibrate_time_offset
from tracker.pose.temporal_calibration.limits import TimeOffsetLimits
from tracker.pose.temporal_calibration.series import Motion, PoseSeries

__all__ = ["Motion", "PoseSeries", "TimeOffset", "TimeOffsetLimits", "calibrate_time_offset"]
