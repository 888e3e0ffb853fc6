"""Consistent, outward winding of triangles."""

import numpy as np
import numpy.typing as npt
import scipy

from tracker.geometry import Array
from tracker.plan.triangles.connectivity import Faces, parts_of

Flags = npt.NDArray[np.bool_]


def wound_outwards(vertices_mm: Array, faces: Faces) -> tuple[Faces, int]:
    """Return the triangles (m, 3), counter-clockwise seen from outside, and the number flipped.

    First neighbours are made consistent, with as few flips as possible in each component. A component inside
    the largest one (a cavity) keeps its orientation relative to it. The inside of an open component is the
    side of its centre; this is ambiguous for a nearly flat one.
    """
    count, parts = parts_of(faces, vertices_mm.shape[0])
    turned = _disagreeing(faces)
    volumes = _volumes(vertices_mm[np.where(turned[:, None], faces[:, ::-1], faces)], parts, count)
    inside_out = volumes < 0.0
    low = np.full((count, 3), np.inf)
    high = np.full((count, 3), -np.inf)
    np.minimum.at(low, parts, vertices_mm[faces].min(axis=1))
    np.maximum.at(high, parts, vertices_mm[faces].max(axis=1))
    outer = int(np.abs(volumes).argmax())
    within = ((low > low[outer]) & (high < high[outer])).all(axis=1)
    inside_out[within] = inside_out[outer]
    turned = turned ^ inside_out[parts]
    return np.where(turned[:, None], faces[:, ::-1], faces), int(turned.sum())


def _volumes(corners_mm: Array, parts: npt.NDArray[np.int64], count: int) -> Array:
    """Return the signed volume of each component of triangles (m, 3, 3) about its centre: (count,)."""
    sums = np.stack(
        [np.bincount(parts, weights=corners_mm.mean(axis=1)[:, axis], minlength=count) for axis in range(3)],
        axis=1,
    )
    middles = sums / np.bincount(parts, minlength=count)[:, None]
    own = corners_mm - middles[parts][:, None, :]
    six_volumes = np.einsum("ij,ij->i", own[:, 0], np.cross(own[:, 1], own[:, 2]))
    return np.asarray(np.bincount(parts, weights=six_volumes, minlength=count) / 6.0)


def _disagreeing(faces: Faces) -> Flags:
    """Return which triangles (m,) to flip so that neighbours agree.

    Each triangle is taken twice, original and flipped, and joined with the consistent copy of each
    neighbour: joined components then have equal winding.
    """
    faces_count = faces.shape[0]
    runs = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    keys = runs.min(axis=1) * (int(faces.max()) + 1) + runs.max(axis=1)
    order = np.argsort(keys, kind="stable")
    _, first, counts = np.unique(keys[order], return_index=True, return_counts=True)
    pairs = first[counts == 2]
    one, other = order[pairs], order[pairs + 1]
    same_way = (runs[one, 0] < runs[one, 1]) == (runs[other, 0] < runs[other, 1])
    f, g = one // 3, other // 3
    shift = np.where(same_way, faces_count, 0)
    a = np.concatenate([f, f + faces_count])
    b = np.concatenate([g + shift, g + faces_count - shift])
    graph = scipy.sparse.coo_array(
        (np.ones(a.size, np.int8), (a, b)), shape=(2 * faces_count, 2 * faces_count)
    )
    _, labels = scipy.sparse.csgraph.connected_components(graph, directed=False)
    turned = labels[:faces_count] > labels[faces_count:]
    # Flip as few as possible: the majority orientation of a component is kept.
    patch = np.minimum(labels[:faces_count], labels[faces_count:])
    share = np.bincount(patch, weights=turned) / np.maximum(np.bincount(patch), 1)
    return np.asarray(turned ^ (share[patch] > 0.5))
