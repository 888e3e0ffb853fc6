"""The compiled loops of the fields: a square and its paper on a grid, and the blurred model there."""

import numpy as np

from tracker.camera.blur.kernels import MAX_OF_BELL, bell_on, mapped, smear_of
from tracker.compiled import compiled
from tracker.marker.sampling.kernels import sample_square, through

FIELDS, RING = 24, 3  # fields a side of the square, and of its white paper around it
WIDE = FIELDS + 2 * RING
PAD = 7  # fields beyond, which blur brings in
SAMPLES = 2
# Four samples spread over a field blur it by this variance, in fields.
SPREAD = 1.0 / 16.0
# Up to so much more of a blur along one direction, by that of the picture, the first order is enough.
LITTLE_MORE = 0.3
# Taps stand so many sd of the picture's blur apart: farther, and they are seen one by one.
TAP_GAP_SDS = 1.2
MAX_OF_LINE = 25
MIN_FIELDS2 = 1e-6


@compiled
def u_of(c):
    """Where a column (or a row) of fields lies: its middle, -1..1 over the square."""
    return (c - 0.5 * (WIDE - 1)) * (2.0 / FIELDS)


@compiled
def sample_fields(image, h, corners):
    """Fields (WIDE, WIDE) of a square and its paper; its corners (4, 2) are in the unit square of h (8,)."""
    mu, mv = corners[:, 0].mean(), corners[:, 1].mean()
    px = np.empty((4, 2))
    for k in range(4):
        a = mu + (corners[k, 0] - mu) * (WIDE / FIELDS)
        b = mv + (corners[k, 1] - mv) * (WIDE / FIELDS)
        px[k, 0], px[k, 1] = through(h, a, b)
    return sample_square(image, px, WIDE, SAMPLES)


@compiled
def fields_ahead(h, corners, ahead):
    """Into `ahead` (2, 2): by how many fields a pixel's step right and down goes, at a square's middle.

    Its corners (4, 2) are in the unit square of the homography h (8,).
    """
    a, b = corners[:, 0].mean(), corners[:, 1].mean()
    u, v = through(h, a, b)
    w = h[6] * a + h[7] * b + 1.0
    ua, ub, va, vb = (
        (h[0] - h[6] * u) / w,
        (h[1] - h[7] * u) / w,
        (h[3] - h[6] * v) / w,
        (h[4] - h[7] * v) / w,
    )
    right = 0.5 * (corners[1] - corners[0] + corners[2] - corners[3])
    down = 0.5 * (corners[3] - corners[0] + corners[2] - corners[1])
    p, q = ua * right[0] + ub * right[1], ua * down[0] + ub * down[1]
    r, t = va * right[0] + vb * right[1], va * down[0] + vb * down[1]
    unit = FIELDS / (p * t - q * r)
    ahead[0, 0], ahead[0, 1], ahead[1, 0], ahead[1, 1] = unit * t, -unit * q, -unit * r, unit * p


@compiled
def lens_blur(ahead, blur_px, blur):
    """Into `blur` (3,): that of a lens, alike to all sides of the image, and of the samples of a field."""
    even = np.array([blur_px * blur_px, blur_px * blur_px, 0.0])
    blur[0], blur[1], blur[2] = mapped(ahead, even)
    blur[0] += SPREAD
    blur[1] += SPREAD


@compiled
def _smear_in(blur, ahead):
    """The smear in a blur (3,) of fields: its variance in px^2, and how it lies in fields per px (x, y).

    Tilt makes a lens's blur longer to one side, and yet it is a bell: what is a smear shows in pixels.
    """
    det = ahead[0, 0] * ahead[1, 1] - ahead[0, 1] * ahead[1, 0]
    back, bare = np.empty((2, 2)), blur.copy()
    back[0, 0], back[0, 1] = ahead[1, 1] / det, -ahead[0, 1] / det
    back[1, 0], back[1, 1] = -ahead[1, 0] / det, ahead[0, 0] / det
    bare[0] -= SPREAD
    bare[1] -= SPREAD
    seen = np.empty(3)
    seen[0], seen[1], seen[2] = mapped(back, bare)
    smear, x, y = smear_of(seen)
    return smear, ahead[0, 0] * x + ahead[0, 1] * y, ahead[1, 0] * x + ahead[1, 1] * y


@compiled
def _lay(weights, x, y, weight):
    """Add a tap, in half fields from the middle, to the four next to it; the variance (x, y) that adds."""
    middle = len(weights) // 2
    most = middle - 1.001
    # What is no number must not become a place beside the array.
    x = middle + (x if abs(x) <= most else np.copysign(most, x))
    y = middle + (y if abs(y) <= most else np.copysign(most, y))
    c, r = int(x), int(y)
    fx, fy = x - c, y - r
    weights[r, c] += (1.0 - fx) * (1.0 - fy) * weight
    weights[r, c + 1] += fx * (1.0 - fy) * weight
    weights[r + 1, c] += (1.0 - fx) * fy * weight
    weights[r + 1, c + 1] += fx * fy * weight
    return 0.25 * weight * fx * (1.0 - fx), 0.25 * weight * fy * (1.0 - fy)


@compiled
def _taps(blur, ahead, blurs, weights):
    """How a blur (3,), variances in fields, is made of one picture and `weights` (n, n) of half fields.

    `ahead`: of `fields_ahead`. Returns the number of the picture, and what is left of the variance to first
    order (3,).
    """
    weights[:, :] = 0.0
    smear, sx, sy = _smear_in(blur, ahead)
    vu, vv, uv = blur[0] - smear * sx * sx, blur[1] - smear * sy * sy, blur[2] - smear * sx * sy
    offsets, shares = np.empty(MAX_OF_BELL), np.empty(MAX_OF_BELL)
    level, bells, ex, ey, along, across = bell_on(
        vu, vv, uv, blurs, MIN_FIELDS2, LITTLE_MORE, TAP_GAP_SDS, offsets, shares
    )
    # Motion smears evenly over its way: a box, whose variance is a twelfth.
    lines, gap = 1, 0.0
    if smear > 0.0:
        length = np.sqrt(12.0 * smear * (sx * sx + sy * sy))
        lines = min(max(int(np.ceil(length / (TAP_GAP_SDS * blurs[level]))), 2), MAX_OF_LINE)
        # So far apart that the variance is the box's.
        gap = np.sqrt(12.0 * smear / (lines * lines - 1.0))
    more_u, more_v = 0.0, 0.0
    for j in range(lines):
        moved = (j - 0.5 * (lines - 1)) * gap
        for k in range(bells):
            x, y = offsets[k] * ex + moved * sx, offsets[k] * ey + moved * sy
            du, dv = _lay(weights, 2.0 * x, 2.0 * y, shares[k] / lines)
            more_u += du
            more_v += dv
    return (
        level,
        along * ex * ex + across * ey * ey - more_u,
        along * ey * ey + across * ex * ex - more_v,
        (along - across) * ex * ey,
    )


@compiled
def picture_at(layers, blurs, blur, ahead, out):
    """The blurred model, its slopes and its curvatures into `out` (6, WIDE, WIDE).

    The blur (3,) is in fields; `ahead`, of `fields_ahead`, tells what of it is smear.
    """
    weights = np.empty((4 * PAD + 1, 4 * PAD + 1))
    level, vu, vv, uv = _taps(blur, ahead, blurs, weights)
    out[:, :, :] = np.float32(0.0)
    for i in range(4 * PAD + 1):
        for j in range(4 * PAD + 1):
            if weights[i, j] == 0.0:
                continue
            weight = np.float32(weights[i, j])
            phase = 2 * (i % 2) + j % 2
            r0, c0 = i // 2, j // 2
            for k in range(6):
                for r in range(WIDE):
                    to, source = out[k, r], layers[level, phase, k, r0 + r]
                    for c in range(WIDE):
                        to[c] += weight * source[c0 + c]
    vu, vv, uv = np.float32(0.5 * vu), np.float32(0.5 * vv), np.float32(uv)
    for r in range(WIDE):
        for c in range(WIDE):
            out[0, r, c] += vu * out[3, r, c] + vv * out[4, r, c] + uv * out[5, r, c]
