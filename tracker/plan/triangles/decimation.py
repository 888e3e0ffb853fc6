"""Fewer triangles, with the shape kept."""

import fast_simplification
import numpy as np

from tracker.geometry import Array
from tracker.plan.triangles.links import Faces, areas_of, referenced

# The library's own choice: with less, edges of long triangles are never cheap enough, and too many stay.
EAGERNESS = 7.0
FEWEST_FACES = 100


def decimated(vertices_mm: Array, faces: Faces, *, max_faces: int) -> tuple[Array, Faces]:
    """The mesh with at most about so many triangles, by joining the vertices that change its shape least.

    Source: M. Garland, P. Heckbert, Surface simplification using quadric error metrics, SIGGRAPH 1997.
    """
    if faces.shape[0] <= max_faces:
        return vertices_mm, faces
    # The library's matrices lose digits far from the origin, and LPS is often far.
    middle = vertices_mm.mean(axis=0)
    points, corners = fast_simplification.simplify(
        np.ascontiguousarray(vertices_mm - middle),
        np.ascontiguousarray(faces),
        target_count=max(max_faces, FEWEST_FACES),
        agg=EAGERNESS,
    )[:2]
    points = np.asarray(points, dtype=np.float64) + middle
    corners = np.asarray(corners, dtype=np.int64)
    return referenced(points, corners[areas_of(points, corners) > 0.0])
