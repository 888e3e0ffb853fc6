"""Correlation of two vector signals in frames that differ by an unknown, constant rotation."""

from typing import NamedTuple

import numpy as np

from tracker.geometry import Array


class Moments(NamedTuple):
    """First and second moments as sums over samples; the leading axes (...) are blocks or offsets.

    Attributes:
        samples: (...), number of samples.
        a, b: (..., 3), sums of the vectors.
        ab: (..., 3, 3), sums of the outer products.
        aa, bb: (...), sums of the squared lengths.
    """

    samples: Array
    a: Array
    b: Array
    ab: Array
    aa: Array
    bb: Array

    @classmethod
    def of(cls, a: Array, b: Array) -> "Moments":
        """Return the moments of samples (n, 3)."""
        counted = np.array([len(a), np.vdot(a, a), np.vdot(b, b)])
        return cls(counted[0], a.sum(axis=0), b.sum(axis=0), a.T @ b, counted[1], counted[2])

    @classmethod
    def of_blocks(cls, a: Array, b: Array, blocks: int) -> "Moments":
        """Return the moments of samples (n, 3) in `blocks` successive blocks of nearly equal size."""
        starts = np.arange(blocks) * len(a) // blocks
        rows = (
            np.ones(len(a)),
            a,
            b,
            a[:, :, None] * b[:, None, :],
            (a**2).sum(axis=1),
            (b**2).sum(axis=1),
        )
        return cls(*(np.add.reduceat(row, starts, axis=0) for row in rows))

    def without_each(self) -> "Moments":
        """Return, for each block, the moments of all other blocks."""
        return Moments(*(part.sum(axis=0) - part for part in self))

    def rms_a(self) -> tuple[float, float]:
        """Return the RMS length of a, and of a about its mean."""
        return _rms(self.samples, self.a, self.aa)

    def rms_b(self) -> tuple[float, float]:
        """Return the RMS length of b, and of b about its mean."""
        return _rms(self.samples, self.b, self.bb)


def _rms(count: Array, total: Array, squares: Array) -> tuple[float, float]:
    mean_square = float(squares / count)
    about_mean = max(0.0, mean_square - float(((total / count) ** 2).sum()))
    return mean_square**0.5, about_mean**0.5


def correlation_ratio(moments: Moments) -> Array:
    """Return the correlation (...) of a and R b about their means, maximised over the rotation R (Kabsch).

    Its square is the coefficient of determination of the least-squares fit of a by a rotated and scaled b.
    """
    count = moments.samples
    cross = moments.ab - moments.a[..., :, None] * moments.b[..., None, :] / count[..., None, None]
    power_a = moments.aa - (moments.a**2).sum(axis=-1) / count
    power_b = moments.bb - (moments.b**2).sum(axis=-1) / count
    singular = np.linalg.svd(cross, compute_uv=False)
    # Both frames are right-handed, so reflections are excluded.
    singular[..., 2] *= np.sign(np.linalg.det(cross))
    power = np.sqrt(np.maximum(power_a * power_b, np.finfo(np.float64).tiny))
    return np.asarray(singular.sum(axis=-1) / power)
