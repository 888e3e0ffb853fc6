"""OpenCV's lens model as the compiled loops want it.

`CameraModel.px_from_camera` is the reference; a test holds the two together.
"""

from typing import TYPE_CHECKING

import numpy as np

from tracker.geometry import Array

if TYPE_CHECKING:
    from tracker.camera.model import CameraModel


def lens_numbers(camera: "CameraModel") -> Array:
    """fx, fy, cx, cy, then OpenCV's 12 coefficients, then the sensor's tilt matrix row by row: (25,)."""
    coefficients = np.zeros(14)
    coefficients[: camera.distortion.size] = camera.distortion
    tx, ty = coefficients[12], coefficients[13]
    about_x = np.array([[1, 0, 0], [0, np.cos(tx), np.sin(tx)], [0, -np.sin(tx), np.cos(tx)]])
    about_y = np.array([[np.cos(ty), 0, -np.sin(ty)], [0, 1, 0], [np.sin(ty), 0, np.cos(ty)]])
    turned = about_y @ about_x
    keystone = np.array([[turned[2, 2], 0, -turned[0, 2]], [0, turned[2, 2], -turned[1, 2]], [0, 0, 1]])
    k = camera.matrix
    return np.concatenate(
        [[k[0, 0], k[1, 1], k[0, 2], k[1, 2]], coefficients[:12], (keystone @ turned).ravel()]
    )
