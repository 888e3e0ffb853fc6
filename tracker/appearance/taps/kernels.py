"""The compiled loops of the taps; their types are those of their calls."""

import numpy as np

from tracker.camera.blur.kernels import MAX_OF_BELL, bell_on, mapped, smear_of
from tracker.compiled import compiled

# Up to so much more of a bell's variance along one direction, by that of the picture, no taps are needed.
LITTLE_MORE = 0.1
# Taps stand so many sd of the picture's blur apart: farther, and they are seen one by one.
TAP_GAP_SDS = 1.25
MAX_OF_LINE = 41
MIN_SIDES2 = 1e-8
MAX_TAPS = MAX_OF_BELL * MAX_OF_LINE


@compiled
def taps_of(ahead, blur, blurs, taps):
    """Fill `taps` (4, n) for a blur (3,) in px^2: moves along x and y in sides, weights, moves by the smear.

    `blurs`: of the pictures, sd in sides. Returns the picture's number, how many taps, a direction in the
    plane with the variances along and across it that are left to first order, in sides^2, and the smear: its
    variance and direction. Its moves are in px, like these.
    """
    smear, sx, sy = smear_of(blur)
    bell = blur.copy()
    bell[0] -= smear * sx * sx
    bell[1] -= smear * sy * sy
    bell[2] -= smear * sx * sy
    m00, m11, m01 = mapped(ahead, bell)
    offsets, weights = np.empty(MAX_OF_BELL), np.empty(MAX_OF_BELL)
    level, bells, ex, ey, along, across = bell_on(
        m00, m11, m01, blurs, MIN_SIDES2, LITTLE_MORE, TAP_GAP_SDS, offsets, weights
    )
    # What a pixel along the smear is on the plane.
    px, py = ahead[0, 0] * sx + ahead[0, 1] * sy, ahead[1, 0] * sx + ahead[1, 1] * sy
    lines, gap = 1, 0.0
    if smear > 0.0:
        length = np.sqrt(12.0 * smear)
        lines = int(np.ceil(length * np.sqrt(px * px + py * py) / (TAP_GAP_SDS * blurs[level])))
        lines = min(max(lines, 3), MAX_OF_LINE)
        # So far apart that the variance is the line's.
        gap = length / np.sqrt(lines * lines - 1.0)
    count = 0
    for j in range(lines):
        moved = (j - 0.5 * (lines - 1)) * gap
        for k in range(bells):
            taps[0, count], taps[1, count] = offsets[k] * ex + moved * px, offsets[k] * ey + moved * py
            taps[2, count], taps[3, count] = weights[k] / lines, moved
            count += 1
    return level, count, (ex, ey, along, across), (smear, sx, sy)
