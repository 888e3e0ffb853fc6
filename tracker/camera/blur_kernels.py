"""Compiled kernels of an anisotropic Gaussian blur (lens and motion): variances along u, v; covariance."""

import numpy as np

from tracker.compiled import compiled

# Motion blur below this ratio to the Gaussian's variance is treated as part of the Gaussian.
MIN_MOTION_RATIO = 0.25
MAX_GAUSSIAN_SAMPLES = 13


@compiled
def axes_of(along_u, along_v, between):
    """Return the larger and smaller eigenvalue of a blur covariance, and the unit axis (x, y) of the larger.

    The smaller one is negative where a fit has stepped to an indefinite matrix.
    """
    mean, half = 0.5 * (along_u + along_v), np.sqrt((0.5 * (along_u - along_v)) ** 2 + between**2)
    angle = 0.5 * np.arctan2(2.0 * between, along_u - along_v)
    return mean + half, mean - half, np.cos(angle), np.sin(angle)


@compiled
def clamp_blur(blur, minimum, maximum):
    """Clamp the eigenvalues of a blur (3,) to [minimum, maximum], in place."""
    larger, smaller, x, y = axes_of(blur[0], blur[1], blur[2])
    larger, smaller = min(max(larger, minimum), maximum), min(max(smaller, minimum), maximum)
    blur[0] = larger * x * x + smaller * y * y
    blur[1] = larger * y * y + smaller * x * x
    blur[2] = (larger - smaller) * x * y


@compiled
def level_of(variance, blurs):
    """Return the index of the level, blurred by ascending sds (k,), nearest to a blur of this variance."""
    level = 0
    while level < len(blurs) - 1 and blurs[level] * blurs[level + 1] < variance:
        level += 1
    return level


@compiled
def mapped(ahead, blur):
    """Return a blur (3,) transformed by a linear map (2, 2)."""
    a, b, c, d = ahead[0, 0], ahead[0, 1], ahead[1, 0], ahead[1, 1]
    first = a * a * blur[0] + 2 * a * b * blur[2] + b * b * blur[1]
    second = c * c * blur[0] + 2 * c * d * blur[2] + d * d * blur[1]
    return first, second, a * c * blur[0] + (a * d + b * c) * blur[2] + b * d * blur[1]


@compiled
def motion_blur_of(blur):
    """Return the motion part of a blur (3,) in px^2, 0 where it is isotropic, and its direction (x, y)."""
    larger, smaller, x, y = axes_of(blur[0], blur[1], blur[2])
    more = larger - smaller
    return (more if more > MIN_MOTION_RATIO * smaller else 0.0), x, y


@compiled
def gaussian_samples(more, has, little, gap_sds, offsets, weights):
    """Write offsets and weights of a sampled Gaussian of variance `more`; return the number of samples.

    `has` is the variance of the blurred level that is sampled. One sample where `more` is at most `little`
    times `has`: a first-order correction then suffices. Samples are about `gap_sds` sd of the level apart.
    """
    if more <= little * has:
        offsets[0], weights[0] = 0.0, 1.0
        return 1
    if more <= 0.5 * has:
        # Three-point Gauss-Hermite quadrature: exact up to the fifth moment.
        for k in range(3):
            offsets[k], weights[k] = (k - 1) * np.sqrt(3.0 * more), 2.0 / 3.0 if k == 1 else 1.0 / 6.0
        return 3
    sd = np.sqrt(more)
    reach = int(np.ceil(2.3 * sd / (gap_sds * np.sqrt(has))))
    reach = min(max(reach, 1), MAX_GAUSSIAN_SAMPLES // 2)
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
def gaussian_on_level(vu, vv, uv, blurs, minimum, little, gap_sds, offsets, weights):
    """Approximate an anisotropic Gaussian by samples of one of several levels, blurred by ascending sds (k,).

    The smaller variance is at least `minimum`; the samples are those of `gaussian_samples` along the larger
    axis. Returns the level, the number of samples, their unit direction (x, y), and the variances along and
    across it that remain for a first-order correction.
    """
    larger, smaller, x, y = axes_of(vu, vv, uv)
    smaller = max(smaller, minimum)
    level = level_of(smaller, blurs)
    has = blurs[level] ** 2
    samples = gaussian_samples(larger - smaller, has, little, gap_sds, offsets, weights)
    across = smaller - has
    return level, samples, x, y, larger - has if samples == 1 else across, across
