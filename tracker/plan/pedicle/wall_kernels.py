"""Compiled loops for sections through bone; argument types follow from the calls."""

import numpy as np

from tracker.compiled import compiled
from tracker.geometry.geometry_kernels import median, solve_positive


@compiled
def trilinear_at(block, x, y, z):
    """Return the trilinear value of a block [z, y, x] at a fractional index; the border is replicated."""
    slices, rows, columns = block.shape
    x = min(max(x, 0.0), columns - 1.0)
    y = min(max(y, 0.0), rows - 1.0)
    z = min(max(z, 0.0), slices - 1.0)
    # A NaN index would read arbitrary memory.
    i, j, k = max(int(x), 0), max(int(y), 0), max(int(z), 0)
    a, b, c = x - i, y - j, z - k
    i_next, j_next, k_next = min(i + 1, columns - 1), min(j + 1, rows - 1), min(k + 1, slices - 1)
    near = (1.0 - b) * ((1.0 - a) * block[k, j, i] + a * block[k, j, i_next]) + b * (
        (1.0 - a) * block[k, j_next, i] + a * block[k, j_next, i_next]
    )
    far = (1.0 - b) * ((1.0 - a) * block[k_next, j, i] + a * block[k_next, j, i_next]) + b * (
        (1.0 - a) * block[k_next, j_next, i] + a * block[k_next, j_next, i_next]
    )
    return (1.0 - c) * near + c * far


@compiled
def steps_to_wall(block, centre, step, count, min_fall, behind, profile):
    """Return the steps from a centre (3,) to the half-height point of the bone's wall; NaN if none.

    The wall is the maximum before the first fall by `min_fall`; its outside the minimum at that fall or up
    to `behind` steps farther. `centre` and `step` (3,) are indexes x, y, z of the block; of
    `count` steps, `profile` (count,) is overwritten with the sampled values.
    """
    peak, peak_at, trough, last = -np.inf, 0, np.inf, -1
    for n in range(count):
        value = trilinear_at(block, centre[0] + n * step[0], centre[1] + n * step[1], centre[2] + n * step[2])
        profile[n] = value
        if last < 0 and value > peak:
            peak, peak_at = value, n
        if last < 0 and peak - value >= min_fall:
            last = n + behind
        if last >= 0:
            trough = min(trough, value)
        if n == last:
            break
    if last < 0:
        return np.nan
    half = 0.5 * (peak + trough)
    at = peak_at + 1
    while profile[at] >= half:
        at += 1
    upper, lower = profile[at - 1], profile[at]
    return at - 1 + min(max((upper - half) / max(upper - lower, 1e-9), 0.0), 1.0)


@compiled
def walls_around(block, centres, steps, count, min_fall, behind, out):
    """Write into `out` (m, rays): `steps_to_wall` from centres (m, 3) along steps (m, rays, 3)."""
    profile = np.empty(count)
    for m in range(steps.shape[0]):
        for ray in range(steps.shape[1]):
            out[m, ray] = steps_to_wall(block, centres[m], steps[m, ray], count, min_fall, behind, profile)


@compiled
def smooth_curves(radius, basis, ridge, rounds, max_distance, smooth, near_curve):
    """Write the robust Fourier fit of radii (m, rays) and which rays are near it; NaN is no wall.

    `basis` (rays, waves) are the waves at the rays, `ridge` (waves,) what keeps each of them small.
    """
    rays, waves = basis.shape
    ordered, weight = np.empty(rays), np.empty(rays)
    normal, right, amplitude = np.empty((waves, waves)), np.empty(waves), np.empty(waves)
    for m in range(len(radius)):
        for ray in range(rays):
            ordered[ray] = max_distance if np.isnan(radius[m, ray]) else radius[m, ray]
        usual = median(ordered, rays)
        # Start from the lower half of the radii: leaks only increase a radius, so it is the robust start.
        for ray in range(rays):
            weight[ray] = 1.0 if radius[m, ray] < 1.9 * usual else 0.0
        limit = 3.0 * (0.35 + 0.12 * usual)
        for _ in range(rounds):
            for i in range(waves):
                right[i] = 0.0
                for j in range(i, waves):
                    normal[i, j] = 0.0
                normal[i, i] = ridge[i]
            for ray in range(rays):
                if weight[ray] == 0.0:
                    continue
                for i in range(waves):
                    weighted = weight[ray] * basis[ray, i]
                    right[i] += weighted * radius[m, ray]
                    for j in range(i, waves):
                        normal[i, j] += weighted * basis[ray, j]
            solve_positive(normal, right, amplitude)
            for ray in range(rays):
                value = 0.0
                for i in range(waves):
                    value += basis[ray, i] * amplitude[i]
                smooth[m, ray] = value
                rest = 1.0 - ((radius[m, ray] - value) / limit) ** 2
                weight[ray] = rest * rest if rest > 0.0 else 0.0
        for ray in range(rays):
            smooth[m, ray] = min(max(smooth[m, ray], 0.3), max_distance)
            near_curve[m, ray] = abs(radius[m, ray] - smooth[m, ray]) < 0.8 + 0.15 * usual
