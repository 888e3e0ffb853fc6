"""Validate the points of each view before any camera is fitted."""

from collections.abc import Sequence

import numpy as np
import scipy

from tracker.camera.detection.plane import off_plane_px, plane_map
from tracker.camera.detection.view import BoardView
from tracker.errors import CalibrationError
from tracker.geometry import Array

MIN_POINTS = 6
# Distortion displaces points by a fraction of a grid step; points in a wrong order are displaced by whole
# steps.
MAX_OFF_STEPS = 0.6
PARALLEL_DEG, SAME_PLACE_RATIO = 4.0, 0.03


def fault_of(view: BoardView, size_wh_px: tuple[int, int]) -> str:
    """Return why this view cannot be used, with numbers, or an empty string."""
    if view.ids.size < MIN_POINTS:
        return f"{view.ids.size} points, at least {MIN_POINTS} are needed"
    px, board = view.image_points_px, view.object_points_mm[:, :2]
    beyond = (px < -0.5) | (px > np.array(size_wh_px) - 0.5)
    if beyond.any():
        return f"{int(beyond.any(axis=1).sum())} points lie outside of the image"
    if np.linalg.matrix_rank(board - board.mean(axis=0), tol=1e-6) < 2 or _thickness(px) < 3.0:
        return "all points lie on one line"
    homography = plane_map(board, px, is_robust=False)
    residual = off_plane_px(board, px, is_robust=False)
    if homography is None or residual is None:
        return "its points are not the image of a flat board"
    off = float(np.sqrt((residual**2).sum(axis=1).mean())) / _step_px(px)
    if off > MAX_OFF_STEPS:
        return (
            f"the order of its points is wrong: they lie {off:.1f} steps of the grid off a flat board (RMS)"
        )
    middle = board.mean(axis=0)
    if _handedness(homography, middle) < 0:
        return "the order of its points is wrong: they are mirrored, as if the board were seen from behind"
    return ""


def reject_one_pose(views: Sequence[BoardView], size_wh_px: tuple[int, int]) -> None:
    """Reject views that all show the board in the same orientation.

    Raises:
        CalibrationError: VIEWS_FROM_ONE_PLACE or VIEWS_ALL_PARALLEL.
    """
    normals, places = zip(*(_rough_pose(view, size_wh_px) for view in views), strict=True)
    cosines = np.clip(np.array(normals) @ np.array(normals).T, -1.0, 1.0)
    widest_deg = float(np.degrees(np.arccos(cosines.min())))
    if widest_deg >= PARALLEL_DEG:
        return
    where = np.array(places)
    apart = float(
        np.linalg.norm(where - where.mean(axis=0), axis=1).max() / np.linalg.norm(where.mean(axis=0))
    )
    context: dict[str, object] = {
        "views": len(views),
        "tilt_range_deg": widest_deg,
        "needed_deg": PARALLEL_DEG,
        "moved_ratio": apart,
        "moved_percent": 100 * apart,
    }
    remedy = "Take 10 to 20 views with the board tilted by 20 to 45 deg to different sides, near and far."
    if apart < SAME_PLACE_RATIO:
        raise CalibrationError(
            "VIEWS_FROM_ONE_PLACE",
            f"all {len(views)} views show the board in one place: it is tilted by {widest_deg:.1f} deg "
            f"between them and moved by {100 * apart:.1f} % of its distance, needed {PARALLEL_DEG:g} deg",
            remedy,
            context,
        )
    raise CalibrationError(
        "VIEWS_ALL_PARALLEL",
        f"in all {len(views)} views the board is parallel to itself within {widest_deg:.1f} deg, needed "
        f"{PARALLEL_DEG:g} deg: distance and focal length cannot be separated",
        remedy,
        context,
    )


def _rough_pose(view: BoardView, size_wh_px: tuple[int, int]) -> tuple[Array, Array]:
    """Return the board's normal and position for a typical camera of this image size."""
    focal = 1.2 * max(size_wh_px)
    k = np.array([[focal, 0, size_wh_px[0] / 2], [0, focal, size_wh_px[1] / 2], [0, 0, 1]])
    found = plane_map(view.object_points_mm[:, :2], view.image_points_px, is_robust=False)
    h = np.linalg.inv(k) @ (np.eye(3) if found is None else found)
    h = h / np.sqrt(np.linalg.norm(h[:, 0]) * np.linalg.norm(h[:, 1]))
    a, b = h[:, 0] / np.linalg.norm(h[:, 0]), h[:, 1] / np.linalg.norm(h[:, 1])
    normal = np.cross(a, b)
    middle = h @ np.append(view.object_points_mm[:, :2].mean(axis=0), 1.0)
    return normal / np.linalg.norm(normal), middle * np.sign(middle[2])


def _handedness(homography: Array, at: Array) -> float:
    """Return the sign of the homography's Jacobian determinant at a point."""
    scale = float(homography[2] @ np.append(at, 1.0))
    return float(np.sign(np.linalg.det(homography) * scale**-3))


def _step_px(px: Array) -> float:
    nearest, _ = scipy.spatial.KDTree(px).query(px, k=2)
    return float(np.median(nearest[:, 1]))


def _thickness(px: Array) -> float:
    """Return the sd in px of points perpendicular to their best-fitting line."""
    return float(np.linalg.svd(px - px.mean(axis=0), compute_uv=False)[-1] / np.sqrt(len(px)))
