"""Registration by points: landmarks marked on the CT and touched with the calibrated tip."""

from tracker.registration.points.pairs import CommonTip, PairedPoints
from tracker.registration.points.registration import PointRegistration, register_points
from tracker.registration.points.settings import PointGate, PointSettings

__all__ = [
    "CommonTip",
    "PairedPoints",
    "PointGate",
    "PointRegistration",
    "PointSettings",
    "register_points",
]
