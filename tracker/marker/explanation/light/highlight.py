"""One highlight: the bell that explains most of what other light leaves."""

from functools import cache
from itertools import product

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.marker.explanation.fields.kernels import WIDE
from tracker.marker.explanation.light.light import grid

# A bell's middle is anywhere about the square; its sds along and across are in half sides. Those of a sparse
# set are tried first.
MIDDLES = np.linspace(-1.2, 1.2, 7)
ANGLES, ROUND, LONG = 4, (0.35, 0.55, 0.9), (0.9, 0.4)
MIN_RATIO = 0.05
STRIDE = 3  # a field of every nine is enough to find one by
# The best is then moved and widened, step by step, to where it explains most: not far away, and no narrower
# than this, where it could take the place of a part of the shape.
ROUNDS, MAX_MOVED, FARTHEST, MIN_SD, MAX_SD = 4, 0.3, 1.5, 0.42, 1.5
DAMPING = 0.02


def highlight_in(rest: Array, explained: Array, weight: Array) -> Array | None:
    """The highlight (fields,), 1 at its brightest, that explains most of what is left, if any does.

    Args:
        rest: what a fit leaves (n, n), in grey levels.
        explained: what it could change (fields, k).
        weight: how much each field says (n, n).
    """
    few = _seldom()
    root = np.sqrt(weight.ravel()[few])
    basis, _ = np.linalg.qr(explained[few] * root[:, None])
    left = rest.ravel()[few] * root
    left = left - basis @ (left @ basis)

    def own(some: Array) -> Array:
        """What of light (fields, n) is no other light already, where it is asked."""
        there = some[few] * root[:, None]
        return np.asarray(there - basis @ (basis.T @ there))

    def explains(own_some: Array) -> Array:
        return np.asarray((left @ own_some) / np.sqrt(np.sum(own_some**2, axis=0) + 1e-9))

    along = explains(own(_bells()))
    # A highlight adds light.
    which = int(np.argmax(along))
    shape, most = _shapes()[which], float(along[which])
    if not (most > 0.0 and most**2 > MIN_RATIO * float(left @ left)):
        return None
    best = _with_slopes(shape)
    for _ in range(ROUNDS):
        shape = _moved(shape, own(best), left)
        there = _with_slopes(shape)
        better = float(explains(own(there[:, :1]))[0])
        if not better > most:
            break
        best, most = there, better
    return best[:, 0]


def _moved(shape: Array, own: Array, left: Array) -> Array:
    """A bell's shape after a step towards what is left; `own` (fields, 6) are the bell and its slopes."""
    a, g = own.T @ own, own.T @ left
    solved = np.linalg.solve(a + DAMPING * np.diag(np.diag(a)) + 1e-9 * np.eye(len(a)), g)
    step = solved[1:] / max(float(solved[0]), 1e-6)
    middle = shape[:2] + np.clip(step[:2], -MAX_MOVED, MAX_MOVED)
    uu, vv, uv = shape[2:] + step[2:]
    values, ways = np.linalg.eigh(np.array([[uu, uv], [uv, vv]]))
    values = np.clip(values, MAX_SD**-2, MIN_SD**-2)
    inverse = ways @ np.diag(values) @ ways.T
    return np.array([*np.clip(middle, -FARTHEST, FARTHEST), inverse[0, 0], inverse[1, 1], inverse[0, 1]])


def _with_slopes(shape: Array) -> Array:
    """A bell (fields,), 1 at its brightest, and what it changes by each number of its shape: (fields, 6).

    The shape is its middle, and the inverse of its variances: along u, along v, and of both.
    """
    u, v, uu, vv, uv = shape
    x, y = (one.ravel() - middle for one, middle in zip(grid(), (u, v), strict=True))
    bell = np.exp(-0.5 * (uu * x * x + vv * y * y + 2.0 * uv * x * y))
    slopes = (uu * x + uv * y, vv * y + uv * x, -0.5 * x * x, -0.5 * y * y, -x * y)
    return np.stack([bell, *(bell * one for one in slopes)], axis=1)


@cache
def _seldom() -> npt.NDArray[np.int64]:
    """Fields of a sparse grid."""
    at = np.arange(0, WIDE, STRIDE)
    return np.asarray((at[:, None] * WIDE + at).ravel())


@cache
def _shapes() -> Array:
    """The shapes (n, 5) that are tried first, round and long."""
    forms = [(sd, sd, 0.0) for sd in ROUND] + [(*LONG, k * np.pi / ANGLES) for k in range(ANGLES)]
    shapes = []
    for along, across, turn in forms:
        c, s, a, b = np.cos(turn), np.sin(turn), along**-2, across**-2
        inverse = (c * c * a + s * s * b, s * s * a + c * c * b, c * s * (a - b))
        shapes += [(u, v, *inverse) for u, v in product(MIDDLES, MIDDLES)]
    return np.array(shapes)


@cache
def _bells() -> Array:
    """The same as highlights (fields, n)."""
    return np.column_stack([_with_slopes(one)[:, 0] for one in _shapes()])
