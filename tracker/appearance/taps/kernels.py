"""The compiled loops of the taps; their types are those of their calls."""

import numpy as np

from tracker.camera.blur.kernels import axes_of, level_of
from tracker.compiled import compiled

# Up to so much more of a bell's variance along one direction, by that of the picture, three taps are enough.
LITTLE_MORE = 0.5
# Taps stand so many sd of the picture's blur apart: farther, and they are seen one by one.
TAP_GAP_SDS = 1.25
MOST_OF_BELL, MOST_OF_LINE = 13, 41
MOST_TAPS = MOST_OF_BELL * MOST_OF_LINE
# A smear with less of the bell's variance is as good as a longer bell.
LEAST_SMEAR_RATIO = 0.25


@compiled
def in_sides(ahead, blur):
    """A blur (3,) in px^2 as variances in the marker's plane, in sides^2: along x, between, along y."""
    m00 = ahead[0, 0] ** 2 * blur[0] + 2 * ahead[0, 0] * ahead[0, 1] * blur[2] + ahead[0, 1] ** 2 * blur[1]
    m11 = ahead[1, 0] ** 2 * blur[0] + 2 * ahead[1, 0] * ahead[1, 1] * blur[2] + ahead[1, 1] ** 2 * blur[1]
    m01 = (
        ahead[0, 0] * ahead[1, 0] * blur[0]
        + (ahead[0, 0] * ahead[1, 1] + ahead[0, 1] * ahead[1, 0]) * blur[2]
        + ahead[0, 1] * ahead[1, 1] * blur[1]
    )
    return m00, m01, m11


@compiled
def smear_of(blur):
    """The variance that motion added to a blur (3,) in px^2, 0 where it is a bell; its direction (x, y)."""
    larger, smaller, x, y = axes_of(blur[0], blur[1], blur[2])
    more = larger - smaller
    return (more if more > LEAST_SMEAR_RATIO * smaller else 0.0), x, y


@compiled
def _bell(more, has, offsets, weights):
    """A bell of this variance over a picture whose blur has that one; how many taps it takes."""
    if more <= 0.1 * has:
        offsets[0], weights[0] = 0.0, 1.0
        return 1
    if more <= LITTLE_MORE * has:
        # Gauss and Hermite's three places: their first five moments are the bell's.
        for k in range(3):
            offsets[k], weights[k] = (k - 1) * np.sqrt(3.0 * more), 2.0 / 3.0 if k == 1 else 1.0 / 6.0
        return 3
    sd = np.sqrt(more)
    reach = int(np.ceil(2.3 * sd / (TAP_GAP_SDS * np.sqrt(has))))
    reach = min(max(reach, 1), MOST_OF_BELL // 2)
    gap = 2.3 * sd / reach
    count = 2 * reach + 1
    total, variance = 0.0, 0.0
    for k in range(count):
        offsets[k] = (k - reach) * gap
        weights[k] = np.exp(-0.5 * (offsets[k] / sd) ** 2)
        total += weights[k]
        variance += weights[k] * offsets[k] ** 2
    scale = np.sqrt(more / (variance / total))
    for k in range(count):
        offsets[k] *= scale
        weights[k] /= total
    return count


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
    m00, m01, m11 = in_sides(ahead, bell)
    larger, smaller, ex, ey = axes_of(m00, m11, m01)
    smaller = max(smaller, 1e-8)
    level = level_of(smaller, blurs)
    has = blurs[level] ** 2
    offsets, weights = np.empty(MOST_OF_BELL), np.empty(MOST_OF_BELL)
    bells = _bell(larger - smaller, has, offsets, weights)
    across = smaller - has
    along = larger - has if bells == 1 else across
    # What a pixel along the smear is on the plane.
    px, py = ahead[0, 0] * sx + ahead[0, 1] * sy, ahead[1, 0] * sx + ahead[1, 1] * sy
    lines, gap = 1, 0.0
    if smear > 0.0:
        length = np.sqrt(12.0 * smear)
        lines = int(np.ceil(length * np.sqrt(px * px + py * py) / (TAP_GAP_SDS * blurs[level])))
        lines = min(max(lines, 3), MOST_OF_LINE)
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
