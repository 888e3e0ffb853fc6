"""The compiled loops of the blur; their types are those of their calls."""

import numpy as np

from tracker.compiled import compiled

# A smear with less of the bell's variance is as good as a longer bell.
MIN_SMEAR_RATIO = 0.25
MAX_OF_BELL = 13


@compiled
def axes_of(along_u, along_v, between):
    """A blur's larger and smaller variance, and the unit direction (x, y) of the larger one.

    Of what is no blur, as a fit may step to, the smaller one is below 0.
    """
    mean, half = 0.5 * (along_u + along_v), np.sqrt((0.5 * (along_u - along_v)) ** 2 + between**2)
    angle = 0.5 * np.arctan2(2.0 * between, along_u - along_v)
    return mean + half, mean - half, np.cos(angle), np.sin(angle)


@compiled
def keep_within(blur, least, most):
    """Keep a blur (3,), in place, within these variances in every direction."""
    larger, smaller, x, y = axes_of(blur[0], blur[1], blur[2])
    larger, smaller = min(max(larger, least), most), min(max(smaller, least), most)
    blur[0] = larger * x * x + smaller * y * y
    blur[1] = larger * y * y + smaller * x * x
    blur[2] = (larger - smaller) * x * y


@compiled
def level_of(variance, blurs):
    """Which of some pictures, blurred by these sds (k,), ascending, is next to a blur of this variance."""
    level = 0
    while level < len(blurs) - 1 and blurs[level] * blurs[level + 1] < variance:
        level += 1
    return level


@compiled
def mapped(ahead, blur):
    """A blur (3,) after a linear map (2, 2): variances along the first axis, the second, and between."""
    a, b, c, d = ahead[0, 0], ahead[0, 1], ahead[1, 0], ahead[1, 1]
    first = a * a * blur[0] + 2 * a * b * blur[2] + b * b * blur[1]
    second = c * c * blur[0] + 2 * c * d * blur[2] + d * d * blur[1]
    return first, second, a * c * blur[0] + (a * d + b * c) * blur[2] + b * d * blur[1]


@compiled
def smear_of(blur):
    """The variance that motion added to a blur (3,) in px^2, 0 where it is a bell; its direction (x, y)."""
    larger, smaller, x, y = axes_of(blur[0], blur[1], blur[2])
    more = larger - smaller
    return (more if more > MIN_SMEAR_RATIO * smaller else 0.0), x, y


@compiled
def bell_over(more, has, little, gap_sds, offsets, weights):
    """A bell of this variance over a picture whose blur has that one; how many taps it takes.

    One, where it is so `little` of what the picture has that the first order is enough. Taps stand about so
    many sd of the picture's blur apart.
    """
    if more <= little * has:
        offsets[0], weights[0] = 0.0, 1.0
        return 1
    if more <= 0.5 * has:
        # Gauss and Hermite's three places: their first five moments are the bell's.
        for k in range(3):
            offsets[k], weights[k] = (k - 1) * np.sqrt(3.0 * more), 2.0 / 3.0 if k == 1 else 1.0 / 6.0
        return 3
    sd = np.sqrt(more)
    reach = int(np.ceil(2.3 * sd / (gap_sds * np.sqrt(has))))
    reach = min(max(reach, 1), MAX_OF_BELL // 2)
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
def bell_on(vu, vv, uv, blurs, least, little, gap_sds, offsets, weights):
    """How a bell of these variances is made of one of some pictures, blurred by these sds (k,), ascending.

    Its smaller variance is no less than `least`; the rest is as of `bell_over`, along the larger one. Returns
    the picture's number, how many taps, their unit direction (x, y), and the variances along and across it
    that are left to first order.
    """
    larger, smaller, x, y = axes_of(vu, vv, uv)
    smaller = max(smaller, least)
    level = level_of(smaller, blurs)
    has = blurs[level] ** 2
    taps = bell_over(larger - smaller, has, little, gap_sds, offsets, weights)
    across = smaller - has
    return level, taps, x, y, larger - has if taps == 1 else across, across
