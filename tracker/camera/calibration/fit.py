"""Joint fit of the camera parameters and the board's pose in each view."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from tracker.camera.detection.view import BoardView
from tracker.errors import CalibrationError
from tracker.geometry import Array

NAMES = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6")
MODELS = (4, 5, 8)
FLAGS = {4: cv2.CALIB_FIX_K3, 5: 0, 8: cv2.CALIB_RATIONAL_MODEL}
CRITERIA = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 100, 1e-9)


@dataclass(frozen=True, slots=True, kw_only=True)
class Fit:
    """A camera with poses.

    Attributes:
        matrix: (3, 3).
        distortion: (4,), (5,) or (8,).
        rotations_rad: (views, 3) rotation vectors, and translations_mm: (views, 3): camera from board.
        residuals_px: for each view (n, 2), observed minus projected.
    """

    matrix: Array
    distortion: Array
    rotations_rad: Array
    translations_mm: Array
    residuals_px: tuple[Array, ...]

    @property
    def shared(self) -> Array:
        """Return fx, fy, cx, cy and the distortion, in the order of `NAMES`."""
        k = self.matrix
        return np.concatenate([[k[0, 0], k[1, 1], k[0, 2], k[1, 2]], self.distortion])


def fit_camera(views: Sequence[BoardView], size_wh_px: tuple[int, int], coefficients: int) -> Fit:
    """Return the camera fitted to these views with this number of distortion coefficients.

    Raises:
        CalibrationError: CALIBRATION_DIVERGED.
    """
    flags = FLAGS[coefficients]
    points = [view.object_points_mm.astype(np.float32) for view in views]
    px = [view.image_points_px.astype(np.float32) for view in views]
    try:
        _, k, d, rotations, translations = cv2.calibrateCamera(
            points, px, size_wh_px, np.eye(3), np.zeros(14), flags=flags, criteria=CRITERIA
        )
    except cv2.error as error:
        raise _diverged(len(views), str(error.err)) from error
    lens: Array = np.asarray(d, dtype=np.float64).ravel()[:coefficients]
    matrix: Array = np.array(k, dtype=np.float64)
    rotation = np.array(rotations, dtype=np.float64).reshape(-1, 3)
    translation = np.array(translations, dtype=np.float64).reshape(-1, 3)
    if not all(np.isfinite(one).all() for one in (matrix, lens, rotation, translation)):
        raise _diverged(len(views), "numbers that are not finite")
    residuals = tuple(
        view.image_points_px - projected(view.object_points_mm, r, t, matrix, lens)
        for view, r, t in zip(views, rotation, translation, strict=True)
    )
    return Fit(
        matrix=matrix,
        distortion=lens,
        rotations_rad=rotation,
        translations_mm=translation,
        residuals_px=residuals,
    )


def projected(
    points_mm: Array, rotation_rad: Array, translation_mm: Array, matrix: Array, lens: Array
) -> Array:
    """Project board points (n, 3) to px (n, 2)."""
    px, _ = cv2.projectPoints(points_mm.reshape(-1, 1, 3), rotation_rad, translation_mm, matrix, lens)
    return np.asarray(px, dtype=np.float64).reshape(-1, 2)


def board_pose(view: BoardView, matrix: Array, lens: Array) -> tuple[Array, Array] | None:
    """Return the board's rotation vector and translation for a known camera; None where PnP fails."""
    points = view.object_points_mm.reshape(-1, 1, 3)
    px = view.image_points_px.reshape(-1, 1, 2)
    try:
        found, rotations, translations, _ = cv2.solvePnPGeneric(
            points, px, matrix, lens, flags=cv2.SOLVEPNP_IPPE
        )
    except cv2.error:
        return None
    if not found:
        return None
    best: tuple[float, Array, Array] | None = None
    for rotation, translation in zip(rotations, translations, strict=True):
        r, t = cv2.solvePnPRefineLM(points, px, matrix, lens, rotation.copy(), translation.copy())
        r, t = np.asarray(r, dtype=np.float64).ravel(), np.asarray(t, dtype=np.float64).ravel()
        off = view.image_points_px - projected(view.object_points_mm, r, t, matrix, lens)
        error = float((off**2).sum())
        if np.isfinite(error) and (best is None or error < best[0]):
            best = error, r, t
    return None if best is None else (best[1], best[2])


def _diverged(views: int, why: str) -> CalibrationError:
    return CalibrationError(
        "CALIBRATION_DIVERGED",
        f"no camera fits the {views} views: {why}",
        "Check columns, rows and layout of the board, and take 10 to 20 views with the board tilted by up to "
        "45 deg in different directions.",
        {"views": views, "divergence": why},
    )
