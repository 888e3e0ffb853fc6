"""Compiled kernels of the camera projection; argument types follow from the calls."""

import numpy as np

from tracker.compiled import compiled


@compiled
def _distort(x, y, lens, by):
    """Return the pixel of a direction (x, y), z = 1; write its Jacobian (2, 2) by x and y to `by`."""
    r2 = x * x + y * y
    upper = 1.0 + r2 * (lens[4] + r2 * (lens[5] + r2 * lens[8]))
    lower = 1.0 + r2 * (lens[9] + r2 * (lens[10] + r2 * lens[11]))
    radial = upper / lower
    upper_by = lens[4] + r2 * (2.0 * lens[5] + r2 * 3.0 * lens[8])
    lower_by = lens[9] + r2 * (2.0 * lens[10] + r2 * 3.0 * lens[11])
    # Twice the derivative by r2, because the derivatives of r2 are 2 x and 2 y.
    radial_by = 2.0 * (upper_by - radial * lower_by) / lower
    p1, p2 = lens[6], lens[7]
    xd = x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x) + r2 * (lens[12] + r2 * lens[13])
    yd = y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y + r2 * (lens[14] + r2 * lens[15])
    prism_x, prism_y = 2.0 * (lens[12] + 2.0 * r2 * lens[13]), 2.0 * (lens[14] + 2.0 * r2 * lens[15])
    mixed = x * y * radial_by + 2.0 * (p1 * x + p2 * y)
    xx = radial + x * x * radial_by + 2.0 * p1 * y + 6.0 * p2 * x + x * prism_x
    xy, yx = mixed + y * prism_x, mixed + x * prism_y
    yy = radial + y * y * radial_by + 6.0 * p1 * y + 2.0 * p2 * x + y * prism_y
    w = lens[22] * xd + lens[23] * yd + lens[24]
    xt = (lens[16] * xd + lens[17] * yd + lens[18]) / w
    yt = (lens[19] * xd + lens[20] * yd + lens[21]) / w
    fx, fy = lens[0] / w, lens[1] / w
    tilt_xx, tilt_xy = lens[16] - xt * lens[22], lens[17] - xt * lens[23]
    tilt_yx, tilt_yy = lens[19] - yt * lens[22], lens[20] - yt * lens[23]
    by[0, 0], by[0, 1] = fx * (tilt_xx * xx + tilt_xy * yx), fx * (tilt_xx * xy + tilt_xy * yy)
    by[1, 0], by[1, 1] = fy * (tilt_yx * xx + tilt_yy * yx), fy * (tilt_yx * xy + tilt_yy * yy)
    return lens[0] * xt + lens[2], lens[1] * yt + lens[3]


@compiled
def project_with_derivative(p, lens, derivative):
    """Return the pixel (u, v) of a point (3,) in camera mm; write its Jacobian (2, 3) to `derivative`."""
    z = p[2]
    x, y = p[0] / z, p[1] / z
    if lens[25] > 0.0:
        fx, fy = lens[0], lens[1]
        derivative[0, 0], derivative[0, 1], derivative[0, 2] = fx / z, 0.0, -fx * x / z
        derivative[1, 0], derivative[1, 1], derivative[1, 2] = 0.0, fy / z, -fy * y / z
        return fx * x + lens[2], fy * y + lens[3]
    u, v = _distort(x, y, lens, derivative[:, :2])
    ux, uy, vx, vy = derivative[0, 0], derivative[0, 1], derivative[1, 0], derivative[1, 1]
    derivative[0, 0], derivative[0, 1], derivative[0, 2] = ux / z, uy / z, -(ux * x + uy * y) / z
    derivative[1, 0], derivative[1, 1], derivative[1, 2] = vx / z, vy / z, -(vx * x + vy * y) / z
    return u, v


@compiled
def project_square(rotation, translation, lens, side_mm):
    """Return the pixels (4, 2) of a square's corners: top-left, top-right, bottom-right, bottom-left."""
    derivative, p, pixels = np.empty((2, 3)), np.empty(3), np.empty((4, 2))
    for i in range(4):
        x = 0.5 * side_mm if i in (1, 2) else -0.5 * side_mm
        y = 0.5 * side_mm if i in (0, 1) else -0.5 * side_mm
        for k in range(3):
            p[k] = rotation[k, 0] * x + rotation[k, 1] * y + translation[k]
        pixels[i, 0], pixels[i, 1] = project_with_derivative(p, lens, derivative)
    return pixels
