"""Selection of the pixels that constrain the pose, with their undistorted rays."""

import numpy as np

from tracker.camera.blur_kernels import level_of, mapped
from tracker.camera.projection_kernels import project_with_derivative
from tracker.compiled import compiled
from tracker.geometry.geometry_kernels import copy_vector
from tracker.photometric.render_kernels import footprint
from tracker.photometric.texture import STEEPNESS

SATURATED_GREY = 254
# Spacing of exactly undistorted pixels; rays between them are interpolated quadratically.
APART_PX = 8
# Lens distortion moves the sides of the sampled area by less than this.
OUTLINE_MARGIN_PX = 3.0
# Newton steps to the first ray of a row, to the second, and to each later one. No literals, see `compiled`.
FIRST_STEPS, SECOND_STEPS, NEXT_STEPS = np.int64(3), np.int64(2), np.int64(1)


@compiled
def _extent(rotation, translation, lens, reach_mm, step, width, height, outline):
    """Return first and last column and row, in steps, of the marker's surroundings; empty where not visible.

    Fills `outline` (4, 2), its corners in steps.
    """
    derivative = np.empty((2, 3))
    p = np.empty(3)
    left, top, right, bottom = 1e9, 1e9, -1e9, -1e9
    for k in range(4):
        x = reach_mm if k in (1, 2) else -reach_mm
        y = reach_mm if k in (0, 1) else -reach_mm
        for m in range(3):
            p[m] = rotation[m, 0] * x + rotation[m, 1] * y + translation[m]
        if p[2] < 1.0:
            return 0, -1, 0, -1
        u, v = project_with_derivative(p, lens, derivative)
        outline[k, 0], outline[k, 1] = u / step, v / step
        left, right, top, bottom = min(left, u), max(right, u), min(top, v), max(bottom, v)
    if not (right - left < 1e5 and bottom - top < 1e5):
        return 0, -1, 0, -1
    c0, c1 = max(int(left) // step, 0), min(int(right) // step + 1, width // step - 1)
    r0, r1 = max(int(top) // step, 0), min(int(bottom) // step + 1, height // step - 1)
    return c0, c1, r0, r1


@compiled
def _texels_under(row_at, count, first, size, texel, under):
    """Write the texel index of each point of a row (2, n), in sides, into `under` (n,)."""
    xs, ys = row_at[0], row_at[1]
    half, unit, last = 0.5 * size, 1.0 / texel, size - 1
    for k in range(count):
        c = min(max(int(xs[k] * unit + half), 0), last)
        r = min(max(int(half - ys[k] * unit), 0), last)
        under[k] = first + r * size + c


@compiled
def _pixel_value(image, step, r, c):
    """Return the mean of a step x step block, or -1 where a pixel is saturated."""
    if step == 1:
        one = image[r, c]
        return float(one) if one < SATURATED_GREY else -1.0
    total = 0
    for i in range(step):
        for j in range(step):
            one = image[r * step + i, c * step + j]
            if one >= SATURATED_GREY:
                return -1.0
            total += one
    return total / (step * step)


@compiled
def _solve_ray(u, v, lens, ray, max_iterations, workspace):
    """Undistort a pixel to its ray (2,) by Newton's method from a nearby ray."""
    derivative, p = workspace
    for _ in range(max_iterations):
        p[0], p[1], p[2] = ray[0], ray[1], 1.0
        pu, pv = project_with_derivative(p, lens, derivative)
        a, b, d, e = derivative[0, 0], derivative[0, 1], derivative[1, 0], derivative[1, 1]
        det = a * e - b * d
        du, dv = u - pu, v - pv
        ray[0] += (e * du - b * dv) / det
        ray[1] += (a * dv - d * du) / det


@compiled
def _row_extent(outline, row, minimum, maximum):
    """Return first and last column at which a row can meet a convex outline (4, 2) in px."""
    left, right = 1e9, -1e9
    for k in range(4):
        ax, ay = outline[k, 0], outline[k, 1]
        bx, by = outline[(k + 1) % 4, 0], outline[(k + 1) % 4, 1]
        low, high = min(ay, by) - OUTLINE_MARGIN_PX, max(ay, by) + OUTLINE_MARGIN_PX
        if not low <= row <= high:
            continue
        # Part of this side within the margin of the row.
        for beside in (row - OUTLINE_MARGIN_PX, row + OUTLINE_MARGIN_PX):
            t = min(max((beside - ay) / (by - ay), 0.0), 1.0) if by != ay else 0.0
            x = ax + t * (bx - ax)
            left, right = min(left, x), max(right, x)
        if by == ay:
            left, right = min(left, bx), max(right, bx)
    return max(int(left - OUTLINE_MARGIN_PX), minimum), min(int(right + OUTLINE_MARGIN_PX) + 1, maximum)


@compiled
def _row_of_rays(r, c0, count, step, lens, here, rays):
    """Write the rays (2, n) of a row of pixels. `here` (2,): a ray near the first one, updated in place."""
    half = 0.5 * (step - 1)
    v = step * r + half
    xs, ys = rays[0], rays[1]
    if lens[25] > 0.0:
        # Without distortion the rays are exact.
        for k in range(count):
            xs[k], ys[k] = (step * (c0 + k) + half - lens[2]) / lens[0], (v - lens[3]) / lens[1]
        return
    workspace = (np.empty((2, 3)), np.empty(3))
    _solve_ray(step * c0 + half, v, lens, here, FIRST_STEPS, workspace)
    start, middle, ahead = here.copy(), here.copy(), here.copy()
    _solve_ray(step * (c0 + APART_PX) + half, v, lens, middle, SECOND_STEPS, workspace)
    for first in range(0, count, 2 * APART_PX):
        if first > 0:
            for k in range(2):
                middle[k] = 2.0 * start[k] - middle[k]
            _solve_ray(step * (c0 + first + APART_PX) + half, v, lens, middle, NEXT_STEPS, workspace)
        for k in range(2):
            ahead[k] = 2.0 * middle[k] - start[k]
        _solve_ray(step * (c0 + first + 2 * APART_PX) + half, v, lens, ahead, NEXT_STEPS, workspace)
        # Over this distance the distortion is quadratic.
        dx, dy = 0.5 * (ahead[0] - start[0]), 0.5 * (ahead[1] - start[1])
        ddx, ddy = 0.5 * (ahead[0] + start[0]) - middle[0], 0.5 * (ahead[1] + start[1]) - middle[1]
        for k in range(min(2 * APART_PX, count - first)):
            t = k / APART_PX - 1.0
            xs[first + k], ys[first + k] = middle[0] + t * (dx + t * ddx), middle[1] + t * (dy + t * ddy)
        copy_vector(ahead, start)


@compiled
def _row_on_plane(count, rotation, translation, side_mm, rays, at):
    """Intersect a row of rays (2, n) with the marker's plane (2, n), in sides."""
    xs, ys = rays[0], rays[1]
    r00, r10, r20 = rotation[0, 0] / side_mm, rotation[1, 0] / side_mm, rotation[2, 0] / side_mm
    r01, r11, r21 = rotation[0, 1] / side_mm, rotation[1, 1] / side_mm, rotation[2, 1] / side_mm
    nx, ny, nz = rotation[0, 2], rotation[1, 2], rotation[2, 2]
    t0, t1, t2 = translation[0], translation[1], translation[2]
    # The marker's plane: normal . point = distance.
    distance = nx * t0 + ny * t1 + nz * t2
    us, vs = at[0], at[1]
    for k in range(count):
        x, y = xs[k], ys[k]
        along = distance / (nx * x + ny * y + nz)
        qx, qy, qz = along * x - t0, along * y - t1, along - t2
        us[k], vs[k] = r00 * qx + r10 * qy + r20 * qz, r01 * qx + r11 * qy + r21 * qz


@compiled
def select_pixels(
    image, step, lens, rotation, translation, side_mm, reach_ratio, tex, blur, slope_ratio, stride, rays,
    values
):  # fmt: skip
    """Select pixels, or means of step x step pixels, near the marker that constrain its pose.

    Pixels lie within `reach_ratio` sides of the marker's centre lines and are taken where the texture slope
    at this blur (3,) is at least `slope_ratio` of its maximum, plus one in `stride` of the others. Fills
    `rays` (n, 2), undistorted, and `values` (n,); returns their number.
    """
    _, starts, sizes, blurs, widths, steepness = tex
    height, width = image.shape
    outline = np.empty((4, 2))
    c0, c1, r0, r1 = _extent(rotation, translation, lens, reach_ratio * side_mm, step, width, height, outline)
    ahead = np.empty((2, 2))
    if c1 - c0 < 2 or r1 - r0 < 2 or not footprint(rotation, translation, lens, side_mm, ahead):
        return 0
    m00, m11, _ = mapped(ahead, blur)
    level = level_of(max(m00, m11), blurs)
    size, texel = sizes[level], widths[level]
    minimum, n, flat = slope_ratio * STEEPNESS, 0, 0
    here = np.empty(2)
    here[0], here[1] = translation[0] / translation[2], translation[1] / translation[2]
    row_rays, row_at = np.empty((2, c1 - c0 + 1)), np.empty((2, c1 - c0 + 1))
    under = np.empty(c1 - c0 + 1, np.int64)
    for r in range(r0, r1 + 1):
        begin, end = _row_extent(outline, r, c0, c1)
        count = end - begin + 1
        if count < 1:
            continue
        _row_of_rays(r, begin, count, step, lens, here, row_rays)
        _row_on_plane(count, rotation, translation, side_mm, row_rays, row_at)
        # A texel has three floats.
        _texels_under(row_at, count, starts[level] // 3, size, texel, under)
        for k in range(count):
            if abs(row_at[0, k]) > reach_ratio or abs(row_at[1, k]) > reach_ratio:
                continue
            if steepness[under[k]] <= minimum:
                flat += 1
                if flat % stride != 0:
                    continue
            value = _pixel_value(image, step, r, begin + k)
            if value < 0.0:
                # A saturated pixel does not constrain the position of an edge.
                continue
            if n == len(values):
                return n
            rays[n, 0], rays[n, 1], values[n] = row_rays[0, k], row_rays[1, k], value
            n += 1
    return n
