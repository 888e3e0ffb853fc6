"""Sample positions and weights that approximate a blur kernel on one prerendered texture level.

Defocus is an isotropic Gaussian PSF in the image, motion blur a box along a line; on a tilted marker both are
stretched. A longer Gaussian of equal variance leaves a tenth of the contrast unexplained at 10 px of motion:
tip errors of camera B were nine times the Cramer-Rao bound, against 1.2 times with the line.
"""

import numpy as np

from tracker.camera.blur_kernels import MAX_GAUSSIAN_SAMPLES, gaussian_on_level, mapped, motion_blur_of
from tracker.compiled import compiled

# Below this ratio of extra variance along one direction, the first-order term suffices without kernel
# samples.
FIRST_ORDER_RATIO = 0.1
# Spacing of kernel samples in sd of the texture's blur: farther apart, they become visible separately.
SAMPLE_SPACING_SDS = 1.25
MAX_LINE_SAMPLES = 41
MIN_SIDES2 = 1e-8
MAX_KERNEL_SAMPLES = MAX_GAUSSIAN_SAMPLES * MAX_LINE_SAMPLES


@compiled
def kernel_samples_of(plane_per_px, blur, blurs, kernel_samples):
    """Fill `kernel_samples` (4, n) with the samples of a blur kernel (3,) given in px^2.

    Rows: shifts along x and y in sides, weights, shifts along the motion in px. `blurs`: sd of each texture
    level in sides. Returns the texture level, the number of samples, a direction in the plane with the
    variances along and across it that remain to first order, in sides^2, and the motion blur: its variance
    and direction.
    """
    motion, sx, sy = motion_blur_of(blur)
    gaussian = blur.copy()
    gaussian[0] -= motion * sx * sx
    gaussian[1] -= motion * sy * sy
    gaussian[2] -= motion * sx * sy
    m00, m11, m01 = mapped(plane_per_px, gaussian)
    offsets, weights = np.empty(MAX_GAUSSIAN_SAMPLES), np.empty(MAX_GAUSSIAN_SAMPLES)
    level, gaussian_samples, ex, ey, along, across = gaussian_on_level(
        m00, m11, m01, blurs, MIN_SIDES2, FIRST_ORDER_RATIO, SAMPLE_SPACING_SDS, offsets, weights
    )
    # Displacement on the plane per pixel along the motion.
    px, py = (
        plane_per_px[0, 0] * sx + plane_per_px[0, 1] * sy,
        plane_per_px[1, 0] * sx + plane_per_px[1, 1] * sy,
    )
    lines, gap = 1, 0.0
    if motion > 0.0:
        length = np.sqrt(12.0 * motion)
        lines = int(np.ceil(length * np.sqrt(px * px + py * py) / (SAMPLE_SPACING_SDS * blurs[level])))
        lines = min(max(lines, 3), MAX_LINE_SAMPLES)
        # This spacing gives the discrete samples the variance of the continuous line.
        gap = length / np.sqrt(lines * lines - 1.0)
    count = 0
    for j in range(lines):
        moved = (j - 0.5 * (lines - 1)) * gap
        for k in range(gaussian_samples):
            kernel_samples[0, count], kernel_samples[1, count] = (
                offsets[k] * ex + moved * px,
                offsets[k] * ey + moved * py,
            )
            kernel_samples[2, count], kernel_samples[3, count] = weights[k] / lines, moved
            count += 1
    return level, count, (ex, ey, along, across), (motion, sx, sy)
