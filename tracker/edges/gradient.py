"""Image gradient (the paper's equations 6 and 7) and its noise threshold."""

from dataclasses import dataclass
from math import isnan
from typing import TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from tracker.edges.edge_kernels import median_magnitude

GreyImage: TypeAlias = npt.NDArray[np.uint8]
GradientImage: TypeAlias = npt.NDArray[np.int16]

# A step of h grey levels gives a Sobel response of up to 4 h.
SOBEL_GAIN = 4.0
# The gradient magnitude of pure noise has a Rayleigh distribution with median 1.18 sd. One noise pixel in 500
# exceeds three medians; non-maximum suppression and chaining remove those.
NOISE_MEDIANS = 3.0
# Contrasts under 3 grey levels are indistinguishable from 8-bit quantisation; texture must not raise the
# threshold above a dimly lit marker.
MIN_THRESHOLD, MAX_THRESHOLD = 3.0 * SOBEL_GAIN, 110.0
SAMPLE_STRIDE = 7


@dataclass(frozen=True, slots=True, kw_only=True)
class Gradient:
    """The gradient of an image or of a window of it.

    Attributes:
        x: (h, w), derivative to the right, Sobel's scale (4 per grey level of a step).
        y: (h, w), derivative downwards.
        left_px: column of the image at which the window starts.
        top_px: row of the image at which it starts.
        threshold: gradient magnitude below which a response counts as noise.
    """

    x: GradientImage
    y: GradientImage
    left_px: int
    top_px: int
    threshold: float


def gradient_of(image: GreyImage, *, left_px: int = 0, top_px: int = 0) -> Gradient:
    """Compute the gradient of a grey image (h, w), or of a window that starts at (left_px, top_px)."""
    x, y = cv2.spatialGradient(image)
    gx, gy = np.asarray(x, dtype=np.int16), np.asarray(y, dtype=np.int16)
    return Gradient(x=gx, y=gy, left_px=left_px, top_px=top_px, threshold=noise_threshold(gx, gy))


def noise_threshold(x: GradientImage, y: GradientImage) -> float:
    """Return the gradient magnitude that noise rarely exceeds, from the median over a sparse grid."""
    median = float(median_magnitude(x, y, SAMPLE_STRIDE))
    if isnan(median):
        return MIN_THRESHOLD
    return min(max(NOISE_MEDIANS * median, MIN_THRESHOLD), MAX_THRESHOLD)
