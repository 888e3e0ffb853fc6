"""Predicted grey values of pixels from the blurred texture, and their derivatives by pose and blur.

A blur kernel is approximated by samples of one prerendered texture level. Defocus is an isotropic Gaussian
PSF in the image, motion blur a box along a line; on a tilted marker both are stretched. A longer Gaussian of
equal variance leaves a tenth of the contrast unexplained at 10 px of motion: tip errors of camera B were nine
times the Cramer-Rao bound, against 1.2 times with the line.
"""

import math

import numpy as np

from tracker.camera.blur_kernels import MAX_GAUSSIAN_SAMPLES, gaussian_on_level, mapped, motion_blur_of
from tracker.camera.projection_kernels import project_with_derivative
from tracker.compiled import compiled
from tracker.marker.model import PAPER_RATIO

# Below this ratio of extra variance along one direction, the first-order term suffices without kernel
# samples.
FIRST_ORDER_RATIO = 0.1
# Spacing of kernel samples in sd of the texture's blur: farther apart, they become visible separately.
SAMPLE_SPACING_SDS = 1.25
MAX_LINE_SAMPLES = 41
MIN_SIDES2 = 1e-8
MAX_KERNEL_SAMPLES = MAX_GAUSSIAN_SAMPLES * MAX_LINE_SAMPLES
# Beyond this many sd of the blur, the background does not contribute to a pixel.
FAR_SDS = 4.0
# Pixels are processed in batches of this size, so that loops vectorise and the data stay in the cache.
BATCH = 256


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


@compiled
def add_texture_samples(texels, start, size, texel, at, begin, count, right, up, weight, workspace, out):
    """Add weighted texture value, slopes and curvatures at shifted points to `out` (6, many).

    `at` (n, 2) in half sides, shift (right, up) in sides. `workspace`: texels (12, many), texel indices
    (many,), fractions (2, many).
    """
    found, index, part = workspace
    half, maximum = 0.5 * (size - 1), size - 1.001
    for k in range(count):
        x = min(max((0.5 * at[begin + k, 0] + right) / texel + half, 0.0), maximum)
        y = min(max(half - (0.5 * at[begin + k, 1] + up) / texel, 0.0), maximum)
        c, r = int(x), int(y)
        part[0, k], part[1, k] = x - c, y - r
        index[k] = start + 3 * (r * size + c)
    row = 3 * size
    # Gather first, so that the interpolation vectorises.
    for k in range(count):
        upper, lower = texels[index[k] : index[k] + 6], texels[index[k] + row : index[k] + row + 6]
        for m in range(6):
            found[m, k], found[6 + m, k] = upper[m], lower[m]
    _interpolate(found, part, count, texel, weight, out)


@compiled
def _interpolate(found, part, count, texel, weight, out):
    """Interpolate value, slopes and curvatures between four texels (12, many); add them to `out`."""
    v0, r0, u0, v1, r1, u1 = found[0], found[1], found[2], found[3], found[4], found[5]
    v2, r2, u2, v3, r3, u3 = found[6], found[7], found[8], found[9], found[10], found[11]
    value, right, up, xx_out, yy_out, xy_out = out[0], out[1], out[2], out[3], out[4], out[5]
    ways, downs = part[0], part[1]
    response_row, scale = 0.5 * texel, weight / texel
    for k in range(count):
        fx, fy = ways[k], downs[k]
        gx, gy = 1.0 - fx, 1.0 - fy
        a, b, d, e = gx * gy, fx * gy, gx * fy, fx * fy
        right[k] += weight * (a * r0[k] + b * r1[k] + d * r2[k] + e * r3[k])
        up[k] += weight * (a * u0[k] + b * u1[k] + d * u2[k] + e * u3[k])
        # Slopes are per side to the right and upwards; rows run downwards.
        xx = gy * (r1[k] - r0[k]) + fy * (r3[k] - r2[k])
        yy = gx * (u0[k] - u2[k]) + fx * (u1[k] - u3[k])
        xy = gx * (r0[k] - r2[k]) + fx * (r1[k] - r3[k])
        xx_out[k] += scale * xx
        yy_out[k] += scale * yy
        xy_out[k] += scale * xy
        # Second-order correction of the bilinear interpolation, which underestimates curvature.
        bends = response_row * (fx * gx * xx + fy * gy * yy)
        value[k] += weight * (a * v0[k] + b * v1[k] + d * v2[k] + e * v3[k] - bends)


@compiled
def footprint(rotation, translation, lens, side_mm, plane_per_px):
    """Write the Jacobian of plane coordinates (sides) by pixel coordinates into `plane_per_px` (2, 2).

    Returns False where the plane is seen edge-on.
    """
    derivative = np.empty((2, 3))
    p = translation.copy()
    project_with_derivative(p, lens, derivative)
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    for k in range(3):
        a += derivative[0, k] * rotation[k, 0]
        b += derivative[0, k] * rotation[k, 1]
        c += derivative[1, k] * rotation[k, 0]
        d += derivative[1, k] * rotation[k, 1]
    det = a * d - b * c
    if abs(det) < 1e-12:
        return False
    plane_per_px[0, 0], plane_per_px[0, 1] = d / det / side_mm, -b / det / side_mm
    plane_per_px[1, 0], plane_per_px[1, 1] = -c / det / side_mm, a / det / side_mm
    return True


@compiled
def paper_fraction(at, lens, rotation, translation, side_mm, blur, share):
    """Write the fraction of each pixel's blur kernel on the marker's paper, 0..1, into `share` (n,)."""
    plane_per_px = np.empty((2, 2))
    share[:] = 1.0
    if not footprint(rotation, translation, lens, side_mm, plane_per_px):
        return
    m00, m11, _ = mapped(plane_per_px, blur)
    # In half sides, as `at` is.
    sx, sy = 2.0 * np.sqrt(max(m00, 1e-12)), 2.0 * np.sqrt(max(m11, 1e-12))
    edge = 1.0 + 2.0 * PAPER_RATIO
    for i in range(len(share)):
        x, y = (edge - abs(at[i, 0])) / sx, (edge - abs(at[i, 1])) / sy
        if x < FAR_SDS:
            share[i] *= 1.0 - 0.5 * math.erfc(x * np.sqrt(0.5))
        if y < FAR_SDS:
            share[i] *= 1.0 - 0.5 * math.erfc(y * np.sqrt(0.5))


@compiled
def rays_to_plane(rays, begin, count, rotation, translation, side_mm, at):
    """Intersect rays with the marker's plane; write the points in half sides into `at` (n, 2)."""
    r00, r10, r20 = rotation[0, 0], rotation[1, 0], rotation[2, 0]
    r01, r11, r21 = rotation[0, 1], rotation[1, 1], rotation[2, 1]
    nx, ny, nz = rotation[0, 2], rotation[1, 2], rotation[2, 2]
    t0, t1, t2 = translation[0], translation[1], translation[2]
    distance, unit = nx * t0 + ny * t1 + nz * t2, 2.0 / side_mm
    for i in range(begin, begin + count):
        x, y = rays[i, 0], rays[i, 1]
        depth = distance / (nx * x + ny * y + nz)
        ax, ay, az = depth * x - t0, depth * y - t1, depth - t2
        at[i, 0] = unit * (r00 * ax + r10 * ay + r20 * az)
        at[i, 1] = unit * (r01 * ax + r11 * ay + r21 * az)


@compiled
def _pose_derivatives(rays, begin, count, rotation, translation, side_mm, seen, spread, rows):
    """Write the predicted value and its derivatives by pose into `rows` (10, n), from `begin` on."""
    ex, ey, along, across = spread
    r00, r10, r20 = rotation[0, 0], rotation[1, 0], rotation[2, 0]
    r01, r11, r21 = rotation[0, 1], rotation[1, 1], rotation[2, 1]
    nx, ny, nz = rotation[0, 2], rotation[1, 2], rotation[2, 2]
    t0, t1, t2 = translation[0], translation[1], translation[2]
    distance, unit = nx * t0 + ny * t1 + nz * t2, 1.0 / side_mm
    value, right, up, xxs, yys, xys = seen[0], seen[1], seen[2], seen[3], seen[4], seen[5]
    end = begin + count
    picture, m0, m1, m2 = rows[0, begin:end], rows[1, begin:end], rows[2, begin:end], rows[3, begin:end]
    w0, w1, w2 = rows[4, begin:end], rows[5, begin:end], rows[6, begin:end]
    for k in range(count):
        xx, yy, xy = xxs[k], yys[k], xys[k]
        bend_along = ex * ex * xx + 2.0 * ex * ey * xy + ey * ey * yy
        picture[k] = value[k] + 0.5 * (along * bend_along + across * (xx + yy - bend_along))
        x, y = rays[begin + k, 0], rays[begin + k, 1]
        by_facing = 1.0 / (nx * x + ny * y + nz)
        depth = distance * by_facing
        ax, ay, az = depth * x - t0, depth * y - t1, depth - t2
        gx = unit * (right[k] * r00 + up[k] * r01)
        gy = unit * (right[k] * r10 + up[k] * r11)
        gz = unit * (right[k] * r20 + up[k] * r21)
        # A point of the plane under this ray moves by d (n.v) / (n.d) - v when the marker moves by v.
        slide = (gx * x + gy * y + gz) * by_facing
        qx, qy, qz = nx * slide - gx, ny * slide - gy, nz * slide - gz
        m0[k], m1[k], m2[k] = qx, qy, qz
        w0[k], w1[k], w2[k] = ay * qz - az * qy, az * qx - ax * qz, ax * qy - ay * qx


@compiled
def _blur_derivatives(begin, count, seen, motion_slopes, plane_per_px, motion, rows):
    """Write the derivatives of the prediction by the blur variances into `rows` (10, n), from `begin` on.

    `motion_slopes` (2, many): slopes of the kernel samples by their shift along the motion. A longer or
    rotated motion path shifts the samples; a wider Gaussian changes the curvature term.
    """
    variance, sx, sy = motion
    end = begin + count
    b0, b1, b2 = rows[7, begin:end], rows[8, begin:end], rows[9, begin:end]
    a, c, b, d = plane_per_px[0, 0], plane_per_px[1, 0], plane_per_px[0, 1], plane_per_px[1, 1]
    xxs, yys, xys = seen[3], seen[4], seen[5]
    for k in range(count):
        xx, yy, xy = xxs[k], yys[k], xys[k]
        b0[k] = 0.5 * (a * a * xx + 2.0 * a * c * xy + c * c * yy)
        b1[k] = 0.5 * (b * b * xx + 2.0 * b * d * xy + d * d * yy)
        b2[k] = a * b * xx + (a * d + c * b) * xy + c * d * yy
    if variance == 0.0:
        return
    # Displacement on the plane per pixel along the motion, and across it.
    px, py, qx, qy = a * sx + b * sy, c * sx + d * sy, b * sx - a * sy, d * sx - c * sy
    rights, ups = motion_slopes[0], motion_slopes[1]
    for k in range(count):
        along = (rights[k] * px + ups[k] * py) / variance
        between = (rights[k] * qx + ups[k] * qy) / variance
        across = 2.0 * (b0[k] + b1[k]) - along
        b0[k] = 0.5 * (sx * sx * along - 2.0 * sx * sy * between + sy * sy * across)
        b1[k] = 0.5 * (sy * sy * along + 2.0 * sx * sy * between + sx * sx * across)
        b2[k] = sx * sy * (along - across) + (sx * sx - sy * sy) * between


@compiled
def _convolve(
    tex, level, at, begin, count, kernel_samples, many, workspace, is_motion_blurred, one, seen, motion_slopes
):
    """Sum the texture samples of a blur kernel into `seen` (6, many), and their motion slopes."""
    texels, starts, sizes, _, widths, _ = tex
    start, size, texel = starts[level], sizes[level], widths[level]
    seen[:, :] = 0.0
    if not is_motion_blurred:
        for k in range(many):
            right, up, weight = kernel_samples[0, k], kernel_samples[1, k], kernel_samples[2, k]
            add_texture_samples(
                texels, start, size, texel, at, begin, count, right, up, weight, workspace, seen
            )
        return
    motion_slopes[:, :] = 0.0
    for k in range(many):
        right, up, weight = kernel_samples[0, k], kernel_samples[1, k], kernel_samples[2, k]
        one[:, :] = 0.0
        add_texture_samples(texels, start, size, texel, at, begin, count, right, up, weight, workspace, one)
        for m in range(6):
            total, part = seen[m], one[m]
            for i in range(count):
                total[i] += part[i]
        for m in range(2):
            out, slope, moved = motion_slopes[m], one[1 + m], kernel_samples[3, k]
            for i in range(count):
                out[i] += moved * slope[i]


@compiled
def predict(rays, lens, rotation, translation, side_mm, blur, tex, rows, at, by_blur):
    """Predict pixel values and derivatives: `rows` (10, n), and plane coordinates `at` (n, 2) in half sides.

    Rows: value 0..1, derivatives by translation (3), rotation (3) and, with `by_blur`, blur (3). Returns
    False where the marker cannot be visible at this pose.
    """
    plane_per_px, kernel_samples = np.empty((2, 2)), np.empty((4, MAX_KERNEL_SAMPLES))
    if translation[2] < 1.0 or not footprint(rotation, translation, lens, side_mm, plane_per_px):
        return False
    level, many, spread, motion = kernel_samples_of(plane_per_px, blur, tex[3], kernel_samples)
    workspace = (np.empty((12, BATCH), np.float32), np.empty(BATCH, np.int64), np.empty((2, BATCH)))
    seen, one, motion_slopes = np.empty((6, BATCH)), np.empty((6, BATCH)), np.empty((2, BATCH))
    for begin in range(0, len(rays), BATCH):
        count = min(BATCH, len(rays) - begin)
        rays_to_plane(rays, begin, count, rotation, translation, side_mm, at)
        _convolve(
            tex,
            level,
            at,
            begin,
            count,
            kernel_samples,
            many,
            workspace,
            motion[0] > 0.0,
            one,
            seen,
            motion_slopes,
        )
        _pose_derivatives(rays, begin, count, rotation, translation, side_mm, seen, spread, rows)
        if by_blur:
            _blur_derivatives(begin, count, seen, motion_slopes, plane_per_px, motion, rows)
    return True
