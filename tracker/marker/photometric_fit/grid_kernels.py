"""Sampling grid of a square and its paper, and the blurred model on that grid.

Motion blur is separated from defocus in image pixels. On a marker tilted by 60 degrees the defocus is twice
as long in one direction; in marker coordinates that would be fitted as motion blur, and true markers would
correlate at 0.93 instead of 0.98.
"""

import numpy as np

from tracker.camera.blur_kernels import MAX_GAUSSIAN_SAMPLES, gaussian_on_level, mapped, motion_blur_of
from tracker.compiled import compiled
from tracker.marker.sampling_kernels import sample_square, through

SQUARE_CELLS, RING = 24, 3  # cells a side of the square, and of its white paper around it
GRID_CELLS = SQUARE_CELLS + 2 * RING
PAD = 7  # cells beyond, which blur brings in
SAMPLES = 2
# Four samples spread over a cell add this variance of blur, in cells^2.
SAMPLING_VARIANCE = 1.0 / 16.0
# Up to this ratio of extra variance along one direction, the first-order correction is accurate enough.
FIRST_ORDER_RATIO = 0.3
# Spacing of kernel samples in sd of the layer's blur: farther apart, they become visible separately.
SAMPLE_SPACING_SDS = 1.2
MAX_LINE_SAMPLES = 25
MIN_VARIANCE_CELLS2 = 1e-6


@compiled
def cell_coordinate(c):
    """Return the coordinate of a column or row centre, -1..1 over the square."""
    return (c - 0.5 * (GRID_CELLS - 1)) * (2.0 / SQUARE_CELLS)


@compiled
def _centre(corners):
    """Return the mean of four corners (4, 2)."""
    return (
        0.25 * (corners[0, 0] + corners[1, 0] + corners[2, 0] + corners[3, 0]),
        0.25 * (corners[0, 1] + corners[1, 1] + corners[2, 1] + corners[3, 1]),
    )


@compiled
def sample_cells(image, h, corners, out):
    """Sample the cells of a square and its paper into `out` (GRID_CELLS, GRID_CELLS).

    Its corners (4, 2) are in the unit square of the homography h (8,).
    """
    mu, mv = _centre(corners)
    px = np.empty((4, 2))
    for k in range(4):
        a = mu + (corners[k, 0] - mu) * (GRID_CELLS / SQUARE_CELLS)
        b = mv + (corners[k, 1] - mv) * (GRID_CELLS / SQUARE_CELLS)
        px[k, 0], px[k, 1] = through(h, a, b)
    sample_square(image, px, SAMPLES, out)


@compiled
def cells_per_px(h, corners, ahead):
    """Write the Jacobian of grid cells by image pixels at the square's centre into `ahead` (2, 2).

    Its corners (4, 2) are in the unit square of the homography h (8,).
    """
    a, b = _centre(corners)
    u, v = through(h, a, b)
    w = h[6] * a + h[7] * b + 1.0
    ua, ub, va, vb = (
        (h[0] - h[6] * u) / w,
        (h[1] - h[7] * u) / w,
        (h[3] - h[6] * v) / w,
        (h[4] - h[7] * v) / w,
    )
    right_a = 0.5 * (corners[1, 0] - corners[0, 0] + corners[2, 0] - corners[3, 0])
    right_b = 0.5 * (corners[1, 1] - corners[0, 1] + corners[2, 1] - corners[3, 1])
    down_a = 0.5 * (corners[3, 0] - corners[0, 0] + corners[2, 0] - corners[1, 0])
    down_b = 0.5 * (corners[3, 1] - corners[0, 1] + corners[2, 1] - corners[1, 1])
    p, q = ua * right_a + ub * right_b, ua * down_a + ub * down_b
    r, t = va * right_a + vb * right_b, va * down_a + vb * down_b
    unit = SQUARE_CELLS / (p * t - q * r)
    ahead[0, 0], ahead[0, 1], ahead[1, 0], ahead[1, 1] = unit * t, -unit * q, -unit * r, unit * p


@compiled
def lens_blur(ahead, blur_px, blur):
    """Write an isotropic image blur plus the sampling of a cell into `blur` (3,), in cells^2."""
    blur[0], blur[1], blur[2] = blur_px * blur_px, blur_px * blur_px, 0.0
    blur[0], blur[1], blur[2] = mapped(ahead, blur)
    blur[0] += SAMPLING_VARIANCE
    blur[1] += SAMPLING_VARIANCE


@compiled
def _motion_blur_in(blur, ahead):
    """Return the motion blur in a blur (3,): variance in px^2, and direction in cells per px.

    Tilt stretches an isotropic blur in the grid; only in pixels is an elongation motion.
    """
    det = ahead[0, 0] * ahead[1, 1] - ahead[0, 1] * ahead[1, 0]
    back, bare = np.empty((2, 2)), blur.copy()
    back[0, 0], back[0, 1] = ahead[1, 1] / det, -ahead[0, 1] / det
    back[1, 0], back[1, 1] = -ahead[1, 0] / det, ahead[0, 0] / det
    bare[0] -= SAMPLING_VARIANCE
    bare[1] -= SAMPLING_VARIANCE
    observed = np.empty(3)
    observed[0], observed[1], observed[2] = mapped(back, bare)
    motion, x, y = motion_blur_of(observed)
    return motion, ahead[0, 0] * x + ahead[0, 1] * y, ahead[1, 0] * x + ahead[1, 1] * y


@compiled
def _splat(weights, x, y, weight):
    """Add a kernel sample to its four neighbours on the half-cell grid; return the added variance."""
    middle = len(weights) // 2
    maximum = middle - 1.001
    # NaN must not become an index outside the array.
    x = middle + (x if abs(x) <= maximum else np.copysign(maximum, x))
    y = middle + (y if abs(y) <= maximum else np.copysign(maximum, y))
    c, r = int(x), int(y)
    fx, fy = x - c, y - r
    weights[r, c] += (1.0 - fx) * (1.0 - fy) * weight
    weights[r, c + 1] += fx * (1.0 - fy) * weight
    weights[r + 1, c] += (1.0 - fx) * fy * weight
    weights[r + 1, c + 1] += fx * fy * weight
    return 0.25 * weight * fx * (1.0 - fx), 0.25 * weight * fy * (1.0 - fy)


@compiled
def _kernel_weights(blur, ahead, blurs, weights):
    """Decompose a blur (3,), in cells^2, into one layer and `weights` (n, n) of half cells.

    `ahead`: of `cells_per_px`. Returns the layer number and the variance that remains to first order (3,).
    """
    weights[:, :] = 0.0
    motion, sx, sy = _motion_blur_in(blur, ahead)
    vu, vv, uv = blur[0] - motion * sx * sx, blur[1] - motion * sy * sy, blur[2] - motion * sx * sy
    offsets, shares = np.empty(MAX_GAUSSIAN_SAMPLES), np.empty(MAX_GAUSSIAN_SAMPLES)
    level, bells, ex, ey, along, across = gaussian_on_level(
        vu, vv, uv, blurs, MIN_VARIANCE_CELLS2, FIRST_ORDER_RATIO, SAMPLE_SPACING_SDS, offsets, shares
    )
    # Motion blur is a box, whose variance is a twelfth of its squared length.
    lines, gap = 1, 0.0
    if motion > 0.0:
        length = np.sqrt(12.0 * motion * (sx * sx + sy * sy))
        lines = min(max(int(np.ceil(length / (SAMPLE_SPACING_SDS * blurs[level]))), 2), MAX_LINE_SAMPLES)
        # Spacing for which the samples have the variance of the box.
        gap = np.sqrt(12.0 * motion / (lines * lines - 1.0))
    more_u, more_v = 0.0, 0.0
    for j in range(lines):
        moved = (j - 0.5 * (lines - 1)) * gap
        for k in range(bells):
            x, y = offsets[k] * ex + moved * sx, offsets[k] * ey + moved * sy
            du, dv = _splat(weights, 2.0 * x, 2.0 * y, shares[k] / lines)
            more_u += du
            more_v += dv
    return (
        level,
        along * ex * ex + across * ey * ey - more_u,
        along * ey * ey + across * ex * ex - more_v,
        (along - across) * ex * ey,
    )


@compiled
def render_model(layers, blurs, blur, ahead, out):
    """Render the blurred model, its slopes and curvatures into `out` (6, GRID_CELLS, GRID_CELLS).

    The blur (3,) is in cells^2; `ahead`, of `cells_per_px`, separates its motion part.
    """
    weights = np.empty((4 * PAD + 1, 4 * PAD + 1))
    level, vu, vv, uv = _kernel_weights(blur, ahead, blurs, weights)
    out[:, :, :] = np.float32(0.0)
    for i in range(4 * PAD + 1):
        for j in range(4 * PAD + 1):
            if weights[i, j] == 0.0:
                continue
            weight = np.float32(weights[i, j])
            phase = 2 * (i % 2) + j % 2
            r0, c0 = i // 2, j // 2
            for k in range(6):
                for r in range(GRID_CELLS):
                    to, source = out[k, r], layers[level, phase, k, r0 + r]
                    for c in range(GRID_CELLS):
                        to[c] += weight * source[c0 + c]
    vu, vv, uv = np.float32(0.5 * vu), np.float32(0.5 * vv), np.float32(uv)
    for r in range(GRID_CELLS):
        for c in range(GRID_CELLS):
            out[0, r, c] += vu * out[3, r, c] + vv * out[4, r, c] + uv * out[5, r, c]
