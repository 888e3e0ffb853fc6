"""Smoothing that removes slice steps without shrinking the bone.

It works on a sparse matrix; the smoothing in trimesh visits each vertex in Python.
"""

import numpy as np
import scipy

from tracker.geometry import Array
from tracker.plan.triangles.connectivity import Faces, connectivity_of

# Taubin 1995: a shrinking step and a slightly larger inflating step. Wavelengths above 1/PASS_BAND edges
# remain.
STEP_RATIO = 0.5
PASS_BAND = 0.1
VALUE_ROUNDS = 30


def smoothed(vertices_mm: Array, faces: Faces, *, rounds: int) -> Array:
    """Return the vertices (n, 3) after this many rounds of a step to the neighbours' mean and back.

    Border vertices are fixed, because their neighbours on one side only would pull them inwards.

    Source: G. Taubin, A signal processing approach to fair surface design, SIGGRAPH 1995.
    """
    connectivity = connectivity_of(faces)
    count = vertices_mm.shape[0]
    graph, neighbours = _graph(connectivity.edges, count)
    moves = np.ones((count, 1))
    moves[connectivity.border_vertices] = 0.0
    back_ratio = 1.0 / (PASS_BAND - 1.0 / STEP_RATIO)
    out = vertices_mm - vertices_mm.mean(axis=0)
    for _ in range(rounds):
        for ratio in (STEP_RATIO, back_ratio):
            out = out + ratio * moves * (graph @ out / neighbours[:, None] - out)
    return np.asarray(out + vertices_mm.mean(axis=0))


def smoothed_values(values: Array, sd: Array, faces: Faces, *, step_sd: float) -> Array:
    """Return smoothed values (n,) of vertices, weighted by their standard deviations.

    A Gaussian Markov random field with `step_sd` between neighbours, solved by Jacobi iteration; a value with
    a large standard deviation follows its neighbours.
    """
    graph, neighbours = _graph(connectivity_of(faces).edges, values.size)
    own, coupling = 1.0 / sd**2, 1.0 / step_sd**2
    out = values.copy()
    for _ in range(VALUE_ROUNDS):
        out = (own * values + coupling * (graph @ out)) / (own + coupling * neighbours)
    return np.asarray(out)


def _graph(edges: Faces, count: int) -> "tuple[scipy.sparse.csr_array, Array]":
    """Return the adjacency (n, n) of vertices, and the number (n,) of neighbours, at least 1."""
    a, b = edges.T
    graph = scipy.sparse.coo_array(
        (np.ones(2 * a.size), (np.concatenate([a, b]), np.concatenate([b, a]))), shape=(count, count)
    ).tocsr()
    return graph, np.maximum(np.asarray(graph.sum(axis=1)).reshape(-1), 1.0)
