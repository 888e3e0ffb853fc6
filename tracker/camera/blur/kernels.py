"""The compiled loops of the blur; their types are those of their calls."""

import numpy as np

from tracker.compiled import compiled


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
