"""OpenCV's lens model as the compiled loops want it.

`CameraModel.px_from_camera` is the reference; a test holds the two together.
"""

import numpy as np

from tracker.geometry import Array


def lens_of(matrix: Array, distortion: Array) -> Array:
    """Of K (3, 3) and OpenCV's coefficients (up to 14), the numbers (26,) that the loops take.

    fx, fy, cx, cy, 12 coefficients, the sensor's tilt matrix row by row, 1 for no lens.
    """
    coefficients = np.zeros(14)
    coefficients[: distortion.size] = distortion
    tx, ty = coefficients[12], coefficients[13]
    about_x = np.array([[1, 0, 0], [0, np.cos(tx), np.sin(tx)], [0, -np.sin(tx), np.cos(tx)]])
    about_y = np.array([[np.cos(ty), 0, -np.sin(ty)], [0, 1, 0], [np.sin(ty), 0, np.cos(ty)]])
    turned = about_y @ about_x
    keystone = np.array([[turned[2, 2], 0, -turned[0, 2]], [0, turned[2, 2], -turned[1, 2]], [0, 0, 1]])
    k = matrix
    return np.concatenate(
        [
            [k[0, 0], k[1, 1], k[0, 2], k[1, 2]],
            coefficients[:12],
            (keystone @ turned).ravel(),
            [0.0 if coefficients.any() else 1.0],
        ]
    )
