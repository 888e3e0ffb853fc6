"""Compiled loops of the pedicle model; argument types follow from the calls."""

import math

import numpy as np

from tracker.compiled import compiled

# The foot point settles to 1e-4 mm within these steps, also near the ends of a flat ellipse.
FOOT_STEPS = 5
# The curvature of an inner wall is limited where the cortex is almost as thick as the outer wall is curved.
MIN_INNER_RADIUS_RATIO = 0.25
MIN_GROWTH = 0.2
ROOT_HALF, PDF_AT_ZERO = 1.0 / math.sqrt(2.0), 1.0 / math.sqrt(2.0 * math.pi)


@compiled
def foot_on_ellipse(u, v, a, b):
    """Return cosine and sine of the parameter of the ellipse's point that is nearest to (u, v).

    Fixed-point iteration on the evolute: it converges from everywhere, also from inside.
    """
    x, y = abs(u), abs(v)
    c, s = math.sqrt(0.5), math.sqrt(0.5)
    for _ in range(FOOT_STEPS):
        centre_x, centre_y = (a * a - b * b) * c * c * c / a, (b * b - a * a) * s * s * s / b
        radius = math.hypot(a * c - centre_x, b * s - centre_y)
        to_x, to_y = x - centre_x, y - centre_y
        scale = radius / max(math.hypot(to_x, to_y), 1e-12)
        c = min(max((to_x * scale + centre_x) / a, 0.0), 1.0)
        s = min(max((to_y * scale + centre_y) / b, 0.0), 1.0)
        length = max(math.hypot(c, s), 1e-12)
        c, s = c / length, s / length
    return math.copysign(c, u), math.copysign(s, v)


@compiled
def wall_at(p, along, x, y, out):
    """Write distance to the outer wall, its curvature and the place of the foot point at one point.

    `out` (12,): distance, curvature of the ellipse, normal (u, v), foot (cos, sin), local point (u, v), half
    axes (a, b), support (distance of the tangent from the centre), slope of the bump along the wall.
    """
    squared = along * along
    a = math.exp(p[6]) * max(1.0 + p[9] * along + p[10] * squared, MIN_GROWTH)
    b = math.exp(p[7]) * max(1.0 + p[11] * along + p[12] * squared, MIN_GROWTH)
    x -= p[0] + p[1] * along + p[2] * squared
    y -= p[3] + p[4] * along + p[5] * squared
    cr, sr = math.cos(p[8]), math.sin(p[8])
    u, v = cr * x + sr * y, cr * y - sr * x
    c, s = foot_on_ellipse(u, v, a, b)
    speed = math.sqrt(a * a * s * s + b * b * c * c)
    nu, nv = b * c / speed, a * s / speed
    support = a * b / speed
    c3, s3 = c * (4.0 * c * c - 3.0), s * (3.0 - 4.0 * s * s)
    c4, s4 = 1.0 - 8.0 * c * c * s * s, 4.0 * c * s * (c * c - s * s)
    bump = p[13] * c3 + p[14] * s3 + p[15] * c4 + p[16] * s4
    bump_by = 3.0 * (p[14] * c3 - p[13] * s3) + 4.0 * (p[16] * c4 - p[15] * s4)
    out[0] = (u - a * c) * nu + (v - b * s) * nv - support * bump
    out[1] = a * b / (speed * speed * speed)
    out[2], out[3], out[4], out[5], out[6], out[7] = nu, nv, c, s, u, v
    out[8], out[9], out[10], out[11] = a, b, support, support * bump_by / speed


@compiled
def walls_at(p, along, across, distance, angle):
    """Write the distance to the wall and the polar angle of points: along (n,), across (n, 2)."""
    wall = np.empty(12)
    for n in range(len(along)):
        wall_at(p, along[n], across[n, 0], across[n, 1], wall)
        distance[n], angle[n] = wall[0], math.atan2(wall[7], wall[6])


@compiled
def normal_cdf(x):
    """Return the distribution function of the standard normal distribution."""
    return 0.5 * math.erfc(-x * ROOT_HALF)


@compiled
def normal_pdf(x):
    """Return the density of the standard normal distribution."""
    return PDF_AT_ZERO * math.exp(-0.5 * x * x)


@compiled
def blurred_edge(distance, box_mm, sigma):
    """Return the share of a voxel inside an edge, and its derivatives by distance and sigma.

    The edge is blurred by a box of this width and a Gaussian; the distance is positive outside.
    """
    far, close = 0.5 * box_mm - distance, -0.5 * box_mm - distance
    cdf_far, cdf_close = normal_cdf(far / sigma), normal_cdf(close / sigma)
    pdf_far, pdf_close = normal_pdf(far / sigma), normal_pdf(close / sigma)
    share = (far * cdf_far - close * cdf_close + sigma * (pdf_far - pdf_close)) / box_mm
    return share, (cdf_close - cdf_far) / box_mm, (pdf_far - pdf_close) / box_mm


@compiled
def model_with_jacobian(p, samples, offsets, hu, jacobian):
    """Write the modelled HU (n,) and its derivative (n, 29) by the parameters, see `tube_model`.

    A voxel is the mean of its parts, at these offsets (k, 3) from its centre; `samples` (n, 7) are the rows
    of `tube_model.Samples`. A wall that is blurred along itself moves towards its centre of curvature, by
    half of curvature times variance. Derivatives of this shift by the wall's place, and of the foot point by
    the half axes, are left out.
    """
    wall = np.empty(12)
    blur_mm2, slice_blur_mm2 = math.exp(2.0 * p[20]), math.exp(2.0 * p[26])
    cortex, marrow = p[17], p[19]
    cr, sr = math.cos(p[8]), math.sin(p[8])
    ea, eb = math.exp(p[6]), math.exp(p[7])
    part_share = 1.0 / len(offsets)
    row = np.empty(29)
    for n in range(len(samples)):
        hu[n] = 0.0
        for m in range(29):
            jacobian[n, m] = 0.0
        box_mm, rest_mm2, beside_mm2 = samples[n, 3], samples[n, 4], samples[n, 5]
        through, within = samples[n, 6], 1.0 - samples[n, 6]
        sigma = math.sqrt(rest_mm2 + within * blur_mm2 + through * slice_blur_mm2)
        spread_mm2 = beside_mm2 + through * blur_mm2 + within * slice_blur_mm2
        for k in range(len(offsets)):
            at = samples[n, 0] + offsets[k, 0]
            wall_at(p, at, samples[n, 1] + offsets[k, 1], samples[n, 2] + offsets[k, 2], wall)
            nu, nv, c, s, u, v, a, b = wall[2], wall[3], wall[4], wall[5], wall[6], wall[7], wall[8], wall[9]
            support, bump_slope = wall[10], wall[11]
            r2 = max(u * u + v * v, 1e-6)
            r = math.sqrt(r2)
            ca, sa = u / r, v / r
            thickness = math.exp(p[18] + p[27] * ca + p[28] * sa)
            outer = wall[1]
            inner = outer / max(1.0 - outer * thickness, MIN_INNER_RADIUS_RATIO)
            into_wall, wall_by, wall_by_sigma = blurred_edge(
                wall[0] + 0.5 * outer * spread_mm2, box_mm, sigma
            )
            into_core, core_by, core_by_sigma = blurred_edge(
                wall[0] + thickness + 0.5 * inner * spread_mm2, box_mm, sigma
            )
            c2a, s2a = ca * ca - sa * sa, 2.0 * sa * ca
            outside = p[21] + p[22] * ca + p[23] * sa + p[24] * c2a + p[25] * s2a
            hu[n] += part_share * (outside + (cortex - outside) * into_wall + (marrow - cortex) * into_core)
            by_wall, by_core = (cortex - outside) * wall_by, (marrow - cortex) * core_by
            by_distance = by_wall + by_core
            beyond = 1.0 - into_wall
            by_thickness = by_core * thickness
            by_angle = beyond * (p[23] * ca - p[22] * sa + 2.0 * (p[25] * c2a - p[24] * s2a))
            by_angle += by_thickness * (p[28] * ca - p[27] * sa)
            # The foot point follows the point along the wall, and the bump with it.
            follow = bump_slope / max(1.0 + outer * wall[0], MIN_INNER_RADIUS_RATIO)
            by_u = by_distance * (nu + nv * follow) - by_angle * v / r2
            by_v = by_distance * (nv - nu * follow) + by_angle * u / r2
            by_x, by_y = cr * by_u - sr * by_v, sr * by_u + cr * by_v
            row[0], row[1], row[2] = -by_x, -by_x * at, -by_x * at * at
            row[3], row[4], row[5] = -by_y, -by_y * at, -by_y * at * at
            # Of the support, by the half axes: its share along each squared normal.
            bump_mm = nu * (u - a * c) + nv * (v - b * s) - wall[0]
            by_a = -by_distance * (nu * c + bump_mm * nu * nu / a)
            by_b = -by_distance * (nv * s + bump_mm * nv * nv / b)
            row[6], row[7] = by_a * a, by_b * b
            row[8] = by_u * v - by_v * u
            free_a = 1.0 if a > 1.0001 * MIN_GROWTH * ea else 0.0
            free_b = 1.0 if b > 1.0001 * MIN_GROWTH * eb else 0.0
            row[9], row[10] = by_a * ea * at * free_a, by_a * ea * at * at * free_a
            row[11], row[12] = by_b * eb * at * free_b, by_b * eb * at * at * free_b
            shape = -by_distance * support
            row[13], row[14] = shape * c * (4.0 * c * c - 3.0), shape * s * (3.0 - 4.0 * s * s)
            row[15], row[16] = shape * (1.0 - 8.0 * c * c * s * s), shape * 4.0 * c * s * (c * c - s * s)
            row[17], row[18], row[19] = into_wall - into_core, by_thickness, into_core
            by_sigma = ((cortex - outside) * wall_by_sigma + (marrow - cortex) * core_by_sigma) / sigma
            by_spread = by_wall * outer + by_core * inner
            row[20] = (by_sigma * within + by_spread * through) * blur_mm2
            row[26] = (by_sigma * through + by_spread * within) * slice_blur_mm2
            row[21], row[22], row[23] = beyond, beyond * ca, beyond * sa
            row[24], row[25] = beyond * c2a, beyond * s2a
            row[27], row[28] = by_thickness * ca, by_thickness * sa
            for m in range(29):
                jacobian[n, m] += part_share * row[m]
