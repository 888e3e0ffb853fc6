"""The light in which a square may be seen: even, in the shadow of something, or with a highlight."""

from functools import cache

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.marker.explanation.fields.kernels import WIDE, u_of
from tracker.marker.explanation.light.kernels import shadow_edge, shadow_of

SHADOW_ANGLES, SHADOW_PLACES, SHADOW_SOFT = 12, 9, 0.1
MIN_GAINED_RATIO = 0.15
# Nodes a side of the net of splines that highlights are made of.
NODES = 6


@cache
def grid() -> tuple[Array, Array]:
    """(u, v) of the fields, -1..1 over the square."""
    at = np.array([u_of(c) for c in range(WIDE)])
    u, v = np.meshgrid(at, at)
    return u, v


@cache
def smooth_light(order: int) -> Array:
    """What smooth light may add (fields, n): glare, and the ink's own grey where light varies."""
    u, v = grid()
    terms = [u**m * v ** (n - m) for n in range(order + 1) for m in range(n + 1)]
    return np.stack([one.ravel() for one in terms], axis=1)


@cache
def contrasts() -> Array:
    """How contrast may vary (fields, 3)."""
    return np.ascontiguousarray(smooth_light(1))


@cache
def highlights() -> Array:
    """What highlights may add (fields, NODES^2)."""
    centres = np.arange(WIDE) + 0.5
    gap = WIDE / (NODES - 1.0)
    t = np.abs(centres[:, None] - np.arange(NODES) * gap) / gap
    one = np.where(t < 0.5, 0.75 - t**2, 0.5 * np.clip(1.5 - t, 0.0, None) ** 2)
    return np.asarray(np.einsum("ri,cj->rcij", one, one).reshape(WIDE * WIDE, NODES * NODES))


def shadow_in(seen: Array, picture: npt.NDArray[np.float32], visible: npt.NDArray[np.bool_]) -> Array | None:
    """The straight edge of a shadow (fields,), from 0 to 1, that explains most of what is left, if any."""
    edge = np.empty(3)
    part = shadow_edge(seen, picture, visible, SHADOW_ANGLES, SHADOW_PLACES, SHADOW_SOFT, edge)
    return np.asarray(shadow_of(edge)) if part >= MIN_GAINED_RATIO else None
