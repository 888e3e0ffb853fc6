"""CT slices in radiological orientation, with the LPS position of every pixel."""

from tracker.plan.slices.oblique import across_channel, along_channel, oblique_slice
from tracker.plan.slices.planes import Plane, patient_slice, reach_mm
from tracker.plan.slices.slice import Edges, Slice
from tracker.plan.slices.window import WINDOWS, Window, shown

__all__ = [
    "WINDOWS",
    "Edges",
    "Plane",
    "Slice",
    "Window",
    "across_channel",
    "along_channel",
    "oblique_slice",
    "patient_slice",
    "reach_mm",
    "shown",
]
