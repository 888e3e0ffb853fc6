"""Exact pixel coverage of an outline, so that edges move smoothly with the pose."""

from collections.abc import Sequence

import numpy as np

from tracker.geometry import Array


def coverage_image(
    outlines_px: Sequence[Array], weights: Sequence[float], size_wh_px: tuple[int, int]
) -> Array:
    """Return the sum over closed outlines of their weight times the covered share of each pixel (h, w).

    Args:
        outlines_px: each (n, 2), without crossings, either way round; (0, 0) is a pixel's middle.
        weights: one for each outline.
        size_wh_px: of the answer; what lies beyond is cut off.
    """
    width, height = size_wh_px
    starts, steps, signed = [], [], []
    for outline, weight in zip(outlines_px, weights, strict=True):
        begin = np.asarray(outline, dtype=np.float64) + 0.5
        step = np.roll(begin, -1, axis=0) - begin
        doubled_area = float(np.sum(begin[:, 0] * step[:, 1] - begin[:, 1] * step[:, 0]))
        starts.append(begin)
        steps.append(step)
        signed.append(np.full(len(begin), -weight * np.sign(doubled_area)))
    at, by, weight_of = np.concatenate(starts), np.concatenate(steps), np.concatenate(signed)
    edge, begin_at, end_at = _pieces(at, by, (width, height))
    # Each piece lies in one cell: what it covers there, and that it covers all cells to its right.
    middle = at[edge] + by[edge] * (0.5 * (begin_at + end_at))[:, None]
    drop = by[edge, 1] * (end_at - begin_at) * weight_of[edge]
    row = np.floor(middle[:, 1]).astype(np.int64)
    x = np.clip(middle[:, 0], 0.0, float(width))
    column = np.floor(x).astype(np.int64)
    inside = (row >= 0) & (row < height)
    row, column, x, drop = row[inside], column[inside], x[inside], drop[inside]
    cell = row * (width + 2) + column
    right = drop * (x - column)
    count = height * (width + 2)
    covered = np.bincount(cell, drop - right, count) + np.bincount(cell + 1, right, count)
    return np.asarray(np.cumsum(covered.reshape(height, width + 2), axis=1)[:, :width], dtype=np.float64)


def _pieces(at: Array, by: Array, size_wh: tuple[int, int]) -> tuple[Array, Array, Array]:
    """Split all edges at the grid lines: edge number, start and end parameter."""
    count = len(at)
    edges = [np.arange(count), np.arange(count)]
    cuts = [np.zeros(count), np.ones(count)]
    for axis, size in enumerate(size_wh):
        low = np.minimum(at[:, axis], at[:, axis] + by[:, axis])
        high = np.maximum(at[:, axis], at[:, axis] + by[:, axis])
        first = np.maximum(np.ceil(low), 0.0)
        crossed = np.maximum(np.minimum(np.floor(high), size) - first + 1.0, 0.0).astype(np.int64)
        crossed[by[:, axis] == 0.0] = 0
        edge = np.repeat(np.arange(count), crossed)
        nth = np.arange(len(edge)) - np.repeat(np.cumsum(crossed) - crossed, crossed)
        edges.append(edge)
        cuts.append(np.clip((first[edge] + nth - at[edge, axis]) / by[edge, axis], 0.0, 1.0))
    edge_of, cut = np.concatenate(edges), np.concatenate(cuts)
    order = np.lexsort((cut, edge_of))
    edge_of, cut = edge_of[order], cut[order]
    joined = edge_of[1:] == edge_of[:-1]
    return edge_of[:-1][joined], cut[:-1][joined], cut[1:][joined]
