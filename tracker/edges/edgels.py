"""Edge elements: where the gradient is greatest across an edge, placed to sub-pixel."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.compiled import compiled
from tracker.edges.gradient import Gradient

Float32 = npt.NDArray[np.float32]
Int32 = npt.NDArray[np.int32]


@dataclass(frozen=True, slots=True, kw_only=True)
class Edgels:
    """The edge elements of an image.

    Attributes:
        x, y: (n,), position in px of the gradient's window, sub-pixel.
        nx, ny: (n,), unit direction of the gradient: from dark to bright, across the edge.
        strength: (n,), gradient magnitude.
        at: (h, w), index of the edgel in each pixel, -1 where there is none.
    """

    x: Float32
    y: Float32
    nx: Float32
    ny: Float32
    strength: Float32
    at: Int32


def edgels_of(gradient: Gradient) -> Edgels:
    """All edgels over the gradient's noise threshold, in row order."""
    x, y, nx, ny, strength, at = _edgels(gradient.x, gradient.y, np.float32(gradient.threshold))
    return Edgels(x=x, y=y, nx=nx, ny=ny, strength=strength, at=at)


@compiled
def _edgels(  # type: ignore[no-untyped-def]  # compiled: its types are those of the call
    gx, gy, threshold
):
    height, width = gx.shape
    at = np.full((height, width), -1, np.int32)
    most = height * width // 2 + 1
    found = np.empty((5, most), np.float32)
    n = 0
    for v in range(1, height - 1):
        for u in range(1, width - 1):
            a, b = gx[v, u], gy[v, u]
            abs_a, abs_b = abs(a), abs(b)
            if abs_a + abs_b < threshold:
                continue
            strength = np.sqrt(np.float32(a) * np.float32(a) + np.float32(b) * np.float32(b))
            if strength < threshold:
                continue
            # Compared along the axis that the gradient is nearer to: one edgel for each row of a steep
            # edge, for each column of a flat one, so that chains have neither gaps nor doubles.
            if abs_a >= abs_b:
                sign = 1 if a > 0 else -1
                before, here, after = sign * gx[v, u - 1], sign * a, sign * gx[v, u + 1]
            else:
                sign = 1 if b > 0 else -1
                before, here, after = sign * gy[v - 1, u], sign * b, sign * gy[v + 1, u]
            if not (here > before and here >= after):
                continue
            shift = np.float32(0.5) * np.float32(before - after) / np.float32(before - 2 * here + after)
            if abs_a >= abs_b:
                found[0, n], found[1, n] = u + shift, v
            else:
                found[0, n], found[1, n] = u, v + shift
            found[2, n], found[3, n], found[4, n] = a / strength, b / strength, strength
            at[v, u] = n
            n += 1
    kept = found[:, :n].copy()
    return kept[0], kept[1], kept[2], kept[3], kept[4], at
