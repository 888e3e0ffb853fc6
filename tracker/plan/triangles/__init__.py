"""Triangle mesh operations: connectivity, winding, smoothing, decimation."""

from tracker.plan.triangles.connectivity import (
    Connectivity,
    connectivity_of,
    largest_part,
    referenced,
    vertex_normals,
)
from tracker.plan.triangles.decimation import decimated
from tracker.plan.triangles.smoothing import smoothed, smoothed_values
from tracker.plan.triangles.winding import wound_outwards

__all__ = [
    "Connectivity",
    "connectivity_of",
    "decimated",
    "largest_part",
    "referenced",
    "smoothed",
    "smoothed_values",
    "vertex_normals",
    "wound_outwards",
]
