"""Bias of circular control points: the centroid of a dot's image is not the image of its centre."""

import numpy as np

from tracker.camera.calibration.fit import Fit, projected
from tracker.camera.detection.view import BoardView
from tracker.geometry import Array

RIM_POINTS = 24


def dot_shifts_px(fit: Fit, index: int, view: BoardView) -> Array:
    """Return for each dot (n, 2) the centroid of its image minus the image of its centre.

    Zero where points are corners. Heikkilä, "Geometric camera calibration using circular control points",
    2000; here the rim is projected with lens distortion.
    """
    if not view.dot_radii_mm.size:
        return np.zeros_like(view.image_points_px)
    angle = 2.0 * np.pi * np.arange(RIM_POINTS) / RIM_POINTS
    # A polygon is smaller than its circle, but has the same centroid.
    circle = np.stack([np.cos(angle), np.sin(angle), np.zeros(RIM_POINTS)], axis=1)
    rims = view.object_points_mm[:, None, :] + view.dot_radii_mm[:, None, None] * circle
    pose = fit.rotations_rad[index], fit.translations_mm[index]
    rim = projected(rims.reshape(-1, 3), *pose, fit.matrix, fit.distortion).reshape(-1, RIM_POINTS, 2)
    middle = projected(view.object_points_mm, *pose, fit.matrix, fit.distortion)
    around = rim - middle[:, None, :]
    after = np.roll(around, -1, axis=1)
    cross = around[..., 0] * after[..., 1] - around[..., 1] * after[..., 0]
    return np.asarray(((around + after) * cross[..., None]).sum(axis=1) / (3.0 * cross.sum(axis=1)[:, None]))
