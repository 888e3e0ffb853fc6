"""Illumination bases of a square: smooth offsets, contrast, a shadow edge and a spline of highlights."""

from functools import cache

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.marker.photometric_fit.grid_kernels import GRID_CELLS, cell_coordinate
from tracker.marker.photometric_fit.shadow_kernels import shadow_edge, shadow_of

SHADOW_ANGLES, SHADOW_PLACES, SHADOW_SOFT = 12, 9, 0.1
MIN_GAINED_RATIO = 0.15
# Nodes per side of the spline grid of highlights.
NODES = 6


@cache
def grid() -> tuple[Array, Array]:
    """Return the coordinates (u, v) of the cells, -1..1 over the square."""
    at = np.array([cell_coordinate(c) for c in range(GRID_CELLS)])
    u, v = np.meshgrid(at, at)
    return u, v


@cache
def smooth_light(order: int) -> Array:
    """Return the polynomial basis of smooth offsets (cells, n)."""
    u, v = grid()
    terms = [u**m * v ** (n - m) for n in range(order + 1) for m in range(n + 1)]
    return np.stack([one.ravel() for one in terms], axis=1)


@cache
def contrasts() -> Array:
    """Return the basis of contrast variation (cells, 3)."""
    return np.ascontiguousarray(smooth_light(1))


@cache
def highlights() -> Array:
    """Return the spline basis of highlights (cells, NODES^2)."""
    centres = np.arange(GRID_CELLS) + 0.5
    gap = GRID_CELLS / (NODES - 1.0)
    t = np.abs(centres[:, None] - np.arange(NODES) * gap) / gap
    one = np.where(t < 0.5, 0.75 - t**2, 0.5 * np.clip(1.5 - t, 0.0, None) ** 2)
    return np.asarray(np.einsum("ri,cj->rcij", one, one).reshape(GRID_CELLS * GRID_CELLS, NODES * NODES))


def shadow_in(
    observed: Array, picture: npt.NDArray[np.float32], visible: npt.NDArray[np.bool_]
) -> Array | None:
    """Return the shadow edge (cells,), 0 to 1, with the largest decrease of the residuals, or None."""
    edge = np.empty(3)
    part = shadow_edge(observed, picture, visible, SHADOW_ANGLES, SHADOW_PLACES, SHADOW_SOFT, edge)
    return np.asarray(shadow_of(edge)) if part >= MIN_GAINED_RATIO else None
