"""Mesh decimation that preserves the shape."""

import fast_simplification
import numpy as np

from tracker.geometry import Array
from tracker.plan.triangles.connectivity import Faces, areas_of, referenced

# The library's default; with a lower value, edges of long triangles are not collapsed and too many remain.
AGGRESSIVENESS = 7.0
MIN_FACES = 100


def decimated(vertices_mm: Array, faces: Faces, *, max_faces: int) -> tuple[Array, Faces]:
    """Return the mesh with at most about `max_faces` triangles (quadric edge collapse).

    Source: M. Garland, P. Heckbert, Surface simplification using quadric error metrics, SIGGRAPH 1997.
    """
    if faces.shape[0] <= max_faces:
        return vertices_mm, faces
    # The library's matrices lose digits far from the origin, and LPS is often far.
    middle = vertices_mm.mean(axis=0)
    points, corners = fast_simplification.simplify(
        np.ascontiguousarray(vertices_mm - middle),
        np.ascontiguousarray(faces),
        target_count=max(max_faces, MIN_FACES),
        agg=AGGRESSIVENESS,
    )[:2]
    points = np.asarray(points, dtype=np.float64) + middle
    corners = np.asarray(corners, dtype=np.int64)
    return referenced(points, corners[areas_of(points, corners) > 0.0])
