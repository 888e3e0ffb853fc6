"""The light in which a square may be seen: even, in the shadow of something, or with a highlight."""

from functools import cache

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.marker.explanation.kernels import WIDE, u_of
from tracker.marker.explanation.light.kernels import shadow_edge, shadow_of

SHADOW_ANGLES, SHADOW_PLACES, SHADOW_SOFT = 12, 9, 0.1
LEAST_GAINED_RATIO = 0.15
# One highlight is a bell: its middle anywhere about the square, its sds along and across in half sides.
HIGHLIGHT_MIDDLES = np.linspace(-1.2, 1.2, 7)
HIGHLIGHT_ANGLES, HIGHLIGHT_ROUND, HIGHLIGHT_LONG = 4, (0.35, 0.55, 0.9), (0.9, 0.4)
LEAST_HIGHLIGHT_RATIO = 0.05
STRIDE = 3  # a field of every nine is enough to find one by
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
    return np.asarray(shadow_of(edge)) if part >= LEAST_GAINED_RATIO else None


def highlight_in(rest: Array, explained: Array, weight: Array) -> Array | None:
    """The highlight (fields,), 1 at its brightest, that explains most of what is left, if any does.

    Args:
        rest: what a fit leaves (n, n), in grey levels.
        explained: what it could change (fields, k).
        weight: how much each field says (n, n).
    """
    few, bells = _seldom(), _bells()
    root = np.sqrt(weight.ravel()[few])
    basis, _ = np.linalg.qr(explained[few] * root[:, None])
    left = rest.ravel()[few] * root
    left = left - basis @ (left @ basis)
    # What of a bell is no other light already.
    own = bells[few] * root[:, None]
    own -= basis @ (basis.T @ own)
    along = (left @ own) / np.sqrt(np.sum(own**2, axis=0) + 1e-9)
    # A highlight adds light.
    best = int(np.argmax(along))
    much = along[best] > 0.0 and along[best] ** 2 > LEAST_HIGHLIGHT_RATIO * float(left @ left)
    return bells[:, best].copy() if much else None


@cache
def _seldom() -> npt.NDArray[np.int64]:
    """Fields of a sparse grid."""
    at = np.arange(0, WIDE, STRIDE)
    return np.asarray((at[:, None] * WIDE + at).ravel())


@cache
def _bells() -> Array:
    """Highlights (fields, n), round and long."""
    shapes = [(sd, sd, 0.0) for sd in HIGHLIGHT_ROUND]
    turns = np.arange(HIGHLIGHT_ANGLES) * np.pi / HIGHLIGHT_ANGLES
    shapes += [(*HIGHLIGHT_LONG, float(turn)) for turn in turns]
    u, v = (one.ravel()[:, None] for one in grid())
    a, b = (one.ravel() for one in np.meshgrid(HIGHLIGHT_MIDDLES, HIGHLIGHT_MIDDLES))
    bells = []
    for along, across, turn in shapes:
        x = (u - a) * np.cos(turn) + (v - b) * np.sin(turn)
        y = (v - b) * np.cos(turn) - (u - a) * np.sin(turn)
        bells.append(np.exp(-0.5 * ((x / along) ** 2 + (y / across) ** 2)))
    return np.hstack(bells)
