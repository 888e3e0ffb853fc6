"""Surface-based registration: points swept over the lamina against the CT's surface."""

from tracker.registration.surface.closest_points import ClosestPointQuery, ClosestPoints
from tracker.registration.surface.observability import MotionMode, principal_extents_mm
from tracker.registration.surface.registration import SurfaceRegistration, register_surface
from tracker.registration.surface.settings import SurfaceGate, SurfaceSettings

__all__ = [
    "ClosestPointQuery",
    "ClosestPoints",
    "MotionMode",
    "SurfaceGate",
    "SurfaceRegistration",
    "SurfaceSettings",
    "principal_extents_mm",
    "register_surface",
]
