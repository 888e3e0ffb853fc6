"""Registration by surface: points swept over the lamina against the CT's surface."""

from tracker.registration.surface.nearest import Nearest, NearestOnSurface
from tracker.registration.surface.registration import SurfaceRegistration, register_surface
from tracker.registration.surface.settings import SurfaceGate, SurfaceSettings
from tracker.registration.surface.sliding import Direction

__all__ = [
    "Direction",
    "Nearest",
    "NearestOnSurface",
    "SurfaceGate",
    "SurfaceRegistration",
    "SurfaceSettings",
    "register_surface",
]
