"""What defocus and motion during the exposure make of a point, as few separable filters."""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

Image8 = npt.NDArray[np.uint8]

DEFOCUS_PX, EXPOSURE_S, LONGEST_EXPOSURE_S = 0.6, 0.008, 0.033
SHARP_PX = 0.05
STEPS_PER_PX = 4.0
# Below this a kernel's covariance of x and y cannot be seen: of a motion by half a pixel askew.
SLANT_PX2 = 0.01
# Parts of a kernel below this share of its largest are left out.
NEGLIGIBLE_RATIO = 0.02
# OpenCV counts the taps of a filter from 8 bit to 8 bit in 1/256; they must add up to 1 in these.
FIXED_POINT = 256.0
# More taps are too small for that.
MAX_FIXED_TAPS = 15

# A Gaussian that is sampled once a pixel has less variance than its formula says: the formula's sigma by the
# variance of the samples.
_TAPS = np.arange(-8, 9)
_SIGMAS_PX = np.linspace(0.15, 1.2, 106)
_SAMPLED = np.exp(-0.5 * (_TAPS / _SIGMAS_PX[:, None]) ** 2)
_VARIANCES_PX2 = (_SAMPLED * _TAPS**2).sum(axis=1) / _SAMPLED.sum(axis=1)


@dataclass(frozen=True, slots=True, kw_only=True)
class PointSpread:
    """A kernel as a sum of separable ones.

    Attributes:
        along_x: (n, k) taps of each along x.
        along_y: (n, k) taps of each along y.
    """

    along_x: Array
    along_y: Array

    @property
    def reach_px(self) -> int:
        """How far it spreads a point."""
        return len(self.along_x[0]) // 2

    def of(self, layer: Image8) -> Image8:
        """What it makes of a layer (h, w, channels); beyond its borders the layer goes on as it ends."""
        if len(self.along_x) == 1 and self.along_x.shape[1] <= MAX_FIXED_TAPS:
            soft = cv2.sepFilter2D(
                layer, -1, self.along_x[0], self.along_y[0], borderType=cv2.BORDER_REPLICATE
            )
            return np.asarray(soft, dtype=np.uint8)
        total = np.zeros(layer.shape, dtype=np.float32)
        for x, y in zip(self.along_x, self.along_y, strict=True):
            cv2.add(
                total, cv2.sepFilter2D(layer, cv2.CV_32F, x, y, borderType=cv2.BORDER_REPLICATE), dst=total
            )
        # What was left out of the kernel may leave a little below 0.
        return np.asarray(cv2.convertScaleAbs(np.maximum(total, 0.0, out=total)), dtype=np.uint8)


def point_spread(blur: float, speed_px_s: Array, drawn_px2: float = 0.0) -> PointSpread | None:
    """What defocus and motion during the exposure make of a point; None if it stays one.

    Defocus is a Gaussian; the motion is a straight line, even in time, centred on the middle of the exposure,
    so that the picture shows where things are at its own time.

    Args:
        blur: as in the settings.
        speed_px_s: (2,) how fast the point moves.
        drawn_px2: variance that what is drawn has already, beyond that of a pixel's square.
    """
    sigma = DEFOCUS_PX * blur
    exposure_s = min(EXPOSURE_S * blur, LONGEST_EXPOSURE_S)
    path = np.asarray(speed_px_s, dtype=np.float64) * exposure_s
    length = float(np.linalg.norm(path))
    left_px2 = sigma**2 - drawn_px2
    if left_px2 < SHARP_PX**2 and length < SHARP_PX:
        return None
    sigma = float(np.interp(left_px2, _VARIANCES_PX2, _SIGMAS_PX, right=np.sqrt(max(left_px2, 0.0))))
    count = max(1, int(np.ceil(length * STEPS_PER_PX)))
    steps = ((np.arange(count)[:, None] + 0.5) / count - 0.5) * path
    reach = int(np.ceil(3.0 * sigma + length / 2.0)) + 1
    at = np.arange(-reach, reach + 1)
    along_x = np.exp(-0.5 * ((at[None, :] - steps[:, :1]) / sigma) ** 2)
    along_y = np.exp(-0.5 * ((at[None, :] - steps[:, 1:]) / sigma) ** 2)
    if abs(path[0] * path[1]) / 12.0 < SLANT_PX2:
        # The product of both marginals.
        return PointSpread(along_x=_in_256ths(along_x.sum(axis=0)), along_y=_in_256ths(along_y.sum(axis=0)))
    columns, sizes, rows = np.linalg.svd(along_y.T @ along_x)
    count = int((sizes > NEGLIGIBLE_RATIO * sizes[0]).sum())
    x, y = _even_or_odd(rows[:count]), _even_or_odd(columns.T[:count]) * sizes[:count, None]
    return PointSpread(along_x=x, along_y=y / float(x.sum(axis=1) @ y.sum(axis=1)))


def _even_or_odd(taps: Array) -> Array:
    """Taps (n, k) without rounding errors: OpenCV filters in half the time where both halves are the same."""
    mirrored = taps[:, ::-1]
    signs = np.sign((taps * mirrored).sum(axis=1, keepdims=True))
    return np.asarray((taps + signs * mirrored) / 2.0, dtype=np.float64)


def _in_256ths(taps: Array) -> Array:
    """The taps (k,) as (1, k), few ones in 1/256, that add up to 1; the middle one takes what is over."""
    if len(taps) > MAX_FIXED_TAPS:
        return np.asarray(taps[None] / taps.sum(), dtype=np.float64)
    out = np.rint(taps / taps.sum() * FIXED_POINT)
    out[len(out) // 2] += FIXED_POINT - out.sum()
    return np.asarray(out[None] / FIXED_POINT, dtype=np.float64)
