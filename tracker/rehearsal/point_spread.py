"""Point spread function of defocus and motion blur, as a sum of few separable kernels."""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

Image8 = npt.NDArray[np.uint8]

DEFOCUS_PX, EXPOSURE_S, MAX_EXPOSURE_S = 0.6, 0.008, 0.033
SHARP_PX = 0.05
STEPS_PER_PX = 4.0
# A kernel's xy covariance below this is invisible: that of an oblique motion by half a pixel.
SLANT_PX2 = 0.01
# Components of a kernel below this ratio of the largest are dropped.
NEGLIGIBLE_RATIO = 0.02
# OpenCV quantises the kernel of an 8-bit to 8-bit filter to 1/256; the quantised values must sum to 1.
FIXED_POINT = 256.0
# Longer kernels have values too small for that.
MAX_FIXED_SAMPLES = 15

# A Gaussian sampled once per pixel has a smaller variance than its sigma squared: table of the nominal sigma
# by the variance of the samples.
_KERNELS = np.arange(-8, 9)
_SIGMAS_PX = np.linspace(0.15, 1.2, 106)
_SAMPLED = np.exp(-0.5 * (_KERNELS / _SIGMAS_PX[:, None]) ** 2)
_VARIANCES_PX2 = (_SAMPLED * _KERNELS**2).sum(axis=1) / _SAMPLED.sum(axis=1)


@dataclass(frozen=True, slots=True, kw_only=True)
class PointSpread:
    """A kernel as a sum of separable kernels.

    Attributes:
        along_x: (n, k), samples of each kernel along x.
        along_y: (n, k), samples of each kernel along y.
    """

    along_x: Array
    along_y: Array

    @property
    def reach_px(self) -> int:
        """Return the kernel radius."""
        return len(self.along_x[0]) // 2

    def of(self, layer: Image8) -> Image8:
        """Filter a layer (h, w, channels); the border is replicated."""
        if len(self.along_x) == 1 and self.along_x.shape[1] <= MAX_FIXED_SAMPLES:
            soft = cv2.sepFilter2D(
                layer, -1, self.along_x[0], self.along_y[0], borderType=cv2.BORDER_REPLICATE
            )
            return np.asarray(soft, dtype=np.uint8)
        total = np.zeros(layer.shape, dtype=np.float32)
        for x, y in zip(self.along_x, self.along_y, strict=True):
            cv2.add(
                total, cv2.sepFilter2D(layer, cv2.CV_32F, x, y, borderType=cv2.BORDER_REPLICATE), dst=total
            )
        # The truncated kernel may give slightly negative values.
        return np.asarray(cv2.convertScaleAbs(np.maximum(total, 0.0, out=total)), dtype=np.uint8)


def point_spread(blur: float, speed_px_s: Array, drawn_px2: float = 0.0) -> PointSpread | None:
    """Return the point spread function of defocus and motion; None if it is a point.

    Defocus is a Gaussian. Motion is linear with constant speed, centred on the middle of the exposure, so
    that the image shows the positions at its own time.

    Args:
        blur: as in the settings.
        speed_px_s: (2,) image velocity of the point.
        drawn_px2: variance already present in the drawn layer, beyond that of a pixel's square.
    """
    sigma = DEFOCUS_PX * blur
    exposure_s = min(EXPOSURE_S * blur, MAX_EXPOSURE_S)
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


def _even_or_odd(samples: Array) -> Array:
    """Return exactly symmetric kernel samples (n, k): OpenCV filters them in half the time."""
    mirrored = samples[:, ::-1]
    signs = np.sign((samples * mirrored).sum(axis=1, keepdims=True))
    return np.asarray((samples + signs * mirrored) / 2.0, dtype=np.float64)


def _in_256ths(samples: Array) -> Array:
    """Return the kernel (k,) as (1, k), quantised to 1/256 with sum 1; the centre takes the remainder."""
    if len(samples) > MAX_FIXED_SAMPLES:
        return np.asarray(samples[None] / samples.sum(), dtype=np.float64)
    out = np.rint(samples / samples.sum() * FIXED_POINT)
    out[len(out) // 2] += FIXED_POINT - out.sum()
    return np.asarray(out[None] / FIXED_POINT, dtype=np.float64)
