"""Seen from aside, the middle of a dot's image is not the image of the dot's middle: by how much."""

import numpy as np

from tracker.camera.calibration.fit import Fit, projected
from tracker.camera.detection.view import BoardView
from tracker.geometry import Array

RIM_POINTS = 24


def dot_shifts_px(fit: Fit, index: int, view: BoardView) -> Array:
    """For each dot (n, 2): the middle of the area of its image, minus the image of its middle.

    Zero where points are corners. Heikkilä, "Geometric camera calibration using circular control points",
    2000; here the rim is projected through the lens, which bends it too.
    """
    if not view.dot_radii_mm.size:
        return np.zeros_like(view.image_points_px)
    angle = 2.0 * np.pi * np.arange(RIM_POINTS) / RIM_POINTS
    # A polygon is smaller than its circle, and has the same middle.
    circle = np.stack([np.cos(angle), np.sin(angle), np.zeros(RIM_POINTS)], axis=1)
    rims = view.object_points_mm[:, None, :] + view.dot_radii_mm[:, None, None] * circle
    pose = fit.rotations_rad[index], fit.translations_mm[index]
    rim = projected(rims.reshape(-1, 3), *pose, fit.matrix, fit.distortion).reshape(-1, RIM_POINTS, 2)
    middle = projected(view.object_points_mm, *pose, fit.matrix, fit.distortion)
    around = rim - middle[:, None, :]
    after = np.roll(around, -1, axis=1)
    cross = around[..., 0] * after[..., 1] - around[..., 1] * after[..., 0]
    return np.asarray(((around + after) * cross[..., None]).sum(axis=1) / (3.0 * cross.sum(axis=1)[:, None]))
