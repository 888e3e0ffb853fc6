"""The tracker of Coaxial: pure computation on arrays, without files, clocks, threads or sockets."""

from tracker.camera import CameraModel
from tracker.errors import CalibrationError, InvalidInput, NavigationError, PlanError, RegistrationError
from tracker.marker import MarkerModel
from tracker.pipeline import Tracker
from tracker.pose import Seen, Sighting, ToolModel, Unseen, UnseenReason

__all__ = [
    "CalibrationError",
    "CameraModel",
    "InvalidInput",
    "MarkerModel",
    "NavigationError",
    "PlanError",
    "RegistrationError",
    "Seen",
    "Sighting",
    "ToolModel",
    "Tracker",
    "Unseen",
    "UnseenReason",
]
