"""Parameters of OpenCV's lens model for the compiled kernels.

`CameraModel.px_from_camera` is the reference implementation; a test compares the two.
"""

import numpy as np

from tracker.geometry import Array


def pack_lens(matrix: Array, distortion: Array) -> Array:
    """Return the parameter vector (26,) of the kernels from K (3, 3) and up to 14 coefficients of OpenCV.

    fx, fy, cx, cy, 12 coefficients, the sensor's tilt matrix row by row, 1 without distortion.
    """
    coefficients = np.zeros(14)
    coefficients[: distortion.size] = distortion
    tx, ty = coefficients[12], coefficients[13]
    about_x = np.array([[1, 0, 0], [0, np.cos(tx), np.sin(tx)], [0, -np.sin(tx), np.cos(tx)]])
    about_y = np.array([[np.cos(ty), 0, -np.sin(ty)], [0, 1, 0], [np.sin(ty), 0, np.cos(ty)]])
    tilt = about_y @ about_x
    keystone = np.array([[tilt[2, 2], 0, -tilt[0, 2]], [0, tilt[2, 2], -tilt[1, 2]], [0, 0, 1]])
    k = matrix
    return np.concatenate(
        [
            [k[0, 0], k[1, 1], k[0, 2], k[1, 2]],
            coefficients[:12],
            (keystone @ tilt).ravel(),
            [0.0 if coefficients.any() else 1.0],
        ]
    )
