"""Compiled kernel for the tilt of a square from its foreshortening."""

import numpy as np

from tracker.compiled import compiled


@compiled
def pose_from_foreshortening(homography, rotation, translation):
    """Write the pose whose projection equals a homography (3, 3) from the plane in mm to first order.

    Returns False where there is none. In a frame whose z is the line of sight, the Jacobian of the projection
    is the upper left block of the rotation divided by the distance; the unit norm of each column gives its
    component along the line of sight.
    """
    unit = 1.0 / homography[2, 2]
    x, y = unit * homography[0, 2], unit * homography[1, 2]
    away = np.sqrt(1.0 + x * x + y * y)
    # Columns: right, down, along the line of sight.
    frame = np.empty((3, 3))
    frame[0, 2], frame[1, 2], frame[2, 2] = x / away, y / away, 1.0 / away
    across = np.sqrt(frame[2, 2] ** 2 + frame[0, 2] ** 2)
    frame[0, 0], frame[1, 0], frame[2, 0] = frame[2, 2] / across, 0.0, -frame[0, 2] / across
    frame[0, 1] = frame[1, 2] * frame[2, 0]
    frame[1, 1] = frame[2, 2] * frame[0, 0] - frame[0, 2] * frame[2, 0]
    frame[2, 1] = -frame[1, 2] * frame[0, 0]
    a, b = away * (frame[0, 0] - x * frame[2, 0]), away * (frame[0, 1] - x * frame[2, 1])
    c, d = away * (frame[1, 0] - y * frame[2, 0]), away * (frame[1, 1] - y * frame[2, 1])
    det = a * d - b * c
    seen, columns = np.empty((2, 2)), np.empty((3, 3))
    for k in range(2):
        p = unit * (homography[0, k] - x * homography[2, k])
        q = unit * (homography[1, k] - y * homography[2, k])
        seen[0, k], seen[1, k] = (d * p - b * q) / det, (a * q - c * p) / det
    # The tilt shortens one singular value; the larger one is the scale.
    squares = seen[0, 0] ** 2 + seen[0, 1] ** 2 + seen[1, 0] ** 2 + seen[1, 1] ** 2
    area = seen[0, 0] * seen[1, 1] - seen[0, 1] * seen[1, 0]
    scale = np.sqrt(0.5 * (squares + np.sqrt(max(squares * squares - 4.0 * area * area, 0.0))))
    if not scale > 1e-12:
        return False
    for k in range(2):
        columns[0, k], columns[1, k] = seen[0, k] / scale, seen[1, k] / scale
        columns[2, k] = np.sqrt(max(1.0 - columns[0, k] ** 2 - columns[1, k] ** 2, 0.0))
    if columns[0, 0] * columns[0, 1] + columns[1, 0] * columns[1, 1] > 0.0:
        columns[2, 1] = -columns[2, 1]
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        columns[k, 2] = columns[i, 0] * columns[j, 1] - columns[j, 0] * columns[i, 1]
    for r in range(3):
        translation[r] = frame[r, 2] / scale
        for k in range(3):
            rotation[r, k] = 0.0
            for m in range(3):
                rotation[r, k] += frame[r, m] * columns[m, k]
    return True
