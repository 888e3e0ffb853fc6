"""Point-based registration: landmarks marked on the CT and captured with the calibrated tip."""

from tracker.registration.points.pairs import CommonTip, PointPairs
from tracker.registration.points.registration import PointRegistration, register_points
from tracker.registration.points.settings import PointGate, PointSettings
from tracker.registration.points.uncertainty import expected_covariance

__all__ = [
    "CommonTip",
    "PointGate",
    "PointPairs",
    "PointRegistration",
    "PointSettings",
    "expected_covariance",
    "register_points",
]
