"""Measurement accuracy of a calibrated camera on known displacements on a plane (paper, 3.2).

The plane is never fitted to the measured points, because the residuals of a fit at its own points
underestimate the error. The check detects errors of the lens model and the plane's tilt, but not of the
overall scale, which
comes from the same board: compare `AccuracyReport.plane_distance_mm` with a tape measure.
"""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.camera.displacements import Displacements
from tracker.camera.model import CameraModel
from tracker.camera.ruler import Ruler, distances
from tracker.errors import CalibrationError, InvalidInput
from tracker.geometry import Array

MIN_FIT_POINTS = 4
# Minimum ratio of the minor to the major spread of the points; below it they are collinear.
MIN_WIDTH_RATIO = 0.02
SAME_MM, SAME_PX = 1e-6, 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class AccuracyReport:
    """Table 2 of the paper for a camera: known and measured displacements.

    Attributes:
        displacements: the known displacements and their pixels.
        known_mm: (n,) Rd.
        pixel_distances_px: (n,) Pd.
        measured_mm: (n,) calculated Rd.
        errors_mm: (n,) measured minus known.
        fit_points: number of other points to which the plane was fitted, the minimum over the displacements;
            0 where the pose was measured by hand.
        fit_rms_px: RMS reprojection error of those points; 0 without a fit.
        plane_distance_mm: distance from the camera to the centre of the displacements.
    """

    displacements: Displacements
    known_mm: Array
    pixel_distances_px: Array
    measured_mm: Array
    errors_mm: Array
    fit_points: int
    fit_rms_px: float
    plane_distance_mm: float

    @property
    def maximum_error_mm(self) -> float:
        """Return the largest absolute error."""
        return float(np.abs(self.errors_mm).max())

    @property
    def rms_error_mm(self) -> float:
        """Return the RMS error."""
        return float(np.sqrt(np.mean(self.errors_mm**2)))

    @property
    def pixels_per_mm(self) -> Array:
        """Return Pd/Rd (n,)."""
        return np.asarray(self.pixel_distances_px / self.known_mm)


def accuracy_on_plane(
    camera: CameraModel, displacements: Displacements, *, fit_mm: npt.ArrayLike, fit_px: npt.ArrayLike
) -> AccuracyReport:
    """Return the errors of displacements on a plane whose pose is fitted to other points of it.

    Args:
        camera: the camera to check.
        displacements: the displacements to measure.
        fit_mm: (m, 2) points of the plane in mm, in the same axes as the displacements.
        fit_px: (m, 2), their pixels.

    Raises:
        InvalidInput: ACCURACY_INVALID, ACCURACY_NOT_INDEPENDENT.
        CalibrationError: ACCURACY_PLANE_UNKNOWN.
    """
    on_plane, seen = _checked_fit(camera, fit_mm, fit_px)
    _reject_outside(camera, displacements.first_px, displacements.second_px)
    shared = int(
        (
            _same(on_plane, displacements.points_mm, SAME_MM) | _same(seen, displacements.points_px, SAME_PX)
        ).sum()
    )
    if shared:
        raise InvalidInput(
            "ACCURACY_NOT_INDEPENDENT",
            f"{shared} of the {on_plane.shape[0]} points that the plane is fitted to are measured too",
            "Fit the plane to other points than those that are measured.",
            {"shared_points": shared, "points": on_plane.shape[0]},
        )
    plane, rms_px = _fitted(camera, on_plane, seen)
    first, second = (_on_plane(camera, plane, px) for px in (displacements.first_px, displacements.second_px))
    return _report(
        displacements,
        distances(first, second),
        fit_points=_distinct(on_plane),
        fit_rms_px=rms_px,
        plane_distance_mm=_distance(plane, displacements),
    )


def accuracy_left_out(camera: CameraModel, displacements: Displacements) -> AccuracyReport:
    """Return the leave-one-out errors of displacements, each on the plane fitted to all others.

    Points that a displacement shares with others are excluded from its fit too.

    Raises:
        InvalidInput: ACCURACY_INVALID.
        CalibrationError: ACCURACY_PLANE_UNKNOWN, the others are too few or on one line.
    """
    points_mm, points_px = _checked_fit(camera, displacements.points_mm, displacements.points_px)
    measured, squares, counts, away = [], [], [], []
    for row in range(displacements.first_mm.shape[0]):
        own_mm = np.stack([displacements.first_mm[row], displacements.second_mm[row]])
        own_px = np.stack([displacements.first_px[row], displacements.second_px[row]])
        others = ~(_same(points_mm, own_mm, SAME_MM) | _same(points_px, own_px, SAME_PX))
        plane, rms_px = _fitted(camera, points_mm[others], points_px[others])
        first, second = _on_plane(camera, plane, own_px)
        measured.append(float(distances(first, second)))
        squares.append(rms_px**2)
        counts.append(_distinct(points_mm[others]))
        away.append(_distance(plane, displacements))
    return _report(
        displacements,
        np.array(measured),
        fit_points=min(counts),
        fit_rms_px=float(np.sqrt(np.mean(squares))),
        plane_distance_mm=float(np.mean(away)),
    )


def accuracy_of_ruler(ruler: Ruler, displacements: Displacements) -> AccuracyReport:
    """Return the errors of displacements measured with the paper's ruler."""
    pixels = distances(displacements.first_px, displacements.second_px)
    return _report(
        displacements,
        ruler.displacement_mm(pixels),
        fit_points=0,
        fit_rms_px=0.0,
        plane_distance_mm=ruler.axial_distance_mm,
    )


def accuracy_of_grid(
    camera: CameraModel, points_mm: npt.ArrayLike, points_px: npt.ArrayLike
) -> AccuracyReport:
    """Return the errors on a board of known points (n, 2) seen at pixels (n, 2).

    The plane is fitted to every second point; the others form displacements of about half of the board's
    length. The image must not be one of the calibration.

    Raises: as `accuracy_on_plane`.
    """
    on_board, seen = _checked_fit(camera, points_mm, points_px)
    order = np.lexsort((on_board[:, 0], on_board[:, 1]))
    fit, rest = order[::2], order[1::2]
    half = rest.size // 2
    if half == 0:
        raise _plane_unknown(f"{order.size} points were seen, needed {2 * MIN_FIT_POINTS}")
    first, second = rest[:half], rest[half : 2 * half]
    made = Displacements(
        first_mm=on_board[first], second_mm=on_board[second], first_px=seen[first], second_px=seen[second]
    )
    return accuracy_on_plane(camera, made, fit_mm=on_board[fit], fit_px=seen[fit])


def _report(
    displacements: Displacements,
    measured_mm: Array,
    *,
    fit_points: int,
    fit_rms_px: float,
    plane_distance_mm: float,
) -> AccuracyReport:
    known = distances(displacements.first_mm, displacements.second_mm)
    return AccuracyReport(
        displacements=displacements,
        known_mm=known,
        pixel_distances_px=distances(displacements.first_px, displacements.second_px),
        measured_mm=measured_mm,
        errors_mm=np.asarray(measured_mm - known),
        fit_points=fit_points,
        fit_rms_px=fit_rms_px,
        plane_distance_mm=plane_distance_mm,
    )


def _checked_fit(
    camera: CameraModel, points_mm: npt.ArrayLike, points_px: npt.ArrayLike
) -> tuple[Array, Array]:
    # OpenCV rejects non-contiguous arrays.
    on_plane, seen = (np.ascontiguousarray(points, np.float64) for points in (points_mm, points_px))
    if on_plane.ndim != 2 or on_plane.shape[1] != 2 or on_plane.shape != seen.shape:
        raise InvalidInput(
            "ACCURACY_INVALID",
            f"points of shape {on_plane.shape} were seen at pixels of shape {seen.shape}, needed (n, 2) each",
            "Give two coordinates in mm and two in px for each point.",
            {"shape": str(on_plane.shape), "px_shape": str(seen.shape)},
        )
    if not (np.isfinite(on_plane).all() and np.isfinite(seen).all()):
        raise InvalidInput(
            "ACCURACY_INVALID", "a coordinate is not finite", "Give numbers for all coordinates."
        )
    _reject_outside(camera, seen)
    return on_plane, seen


def _reject_outside(camera: CameraModel, *points_px: Array) -> None:
    width, height = camera.size_wh_px
    for px in points_px:
        outside = (px < -0.5).any(axis=1) | (px > np.array([width, height]) - 0.5).any(axis=1)
        if outside.any():
            u, v = px[outside][0]
            raise InvalidInput(
                "ACCURACY_INVALID",
                f"a point at ({u:.1f}, {v:.1f}) px lies outside of the camera's image of {width}x{height} px",
                "Use images of the size that the camera was calibrated with.",
                {"point_px": [float(u), float(v)], "size_wh_px": [width, height]},
            )


def _same(points: Array, others: Array, within: float) -> npt.NDArray[np.bool_]:
    """Return the mask of points (n, 2) that are among the others (m, 2)."""
    return np.asarray((np.abs(points[:, None, :] - others[None, :, :]).max(axis=2) <= within).any(axis=1))


def _distinct(points: Array) -> int:
    """Return the number of distinct points (n, 2); two displacements may share one."""
    return int(np.unique(np.rint(points / SAME_MM), axis=0).shape[0])


def _fitted(camera: CameraModel, on_plane: Array, seen: Array) -> tuple[tuple[Array, Array], float]:
    """Return rotation and translation from the plane to the camera, and the RMS of the fit in px."""
    count = _distinct(on_plane)
    if count < MIN_FIT_POINTS:
        raise _plane_unknown(f"it has {count} points beside those measured, needed {MIN_FIT_POINTS}")
    middle = on_plane.mean(axis=0)
    spread = np.linalg.svd(on_plane - middle, compute_uv=False)
    if spread[1] < MIN_WIDTH_RATIO * max(float(spread[0]), 1e-9):
        raise _plane_unknown("the points beside those measured lie on one line")
    points = np.concatenate([on_plane, np.zeros((on_plane.shape[0], 1))], axis=1)
    found, turns, moves, _ = cv2.solvePnPGeneric(
        points, seen, camera.matrix, camera.distortion, flags=cv2.SOLVEPNP_IPPE
    )
    best: tuple[tuple[Array, Array], float] | None = None
    for turn, move in zip(turns, moves, strict=True) if found else ():
        fine_turn, fine_move = cv2.solvePnPRefineLM(
            points, seen, camera.matrix, camera.distortion, turn, move
        )
        px, _ = cv2.projectPoints(points, fine_turn, fine_move, camera.matrix, camera.distortion)
        rms = float(np.sqrt(np.mean(np.sum((px.reshape(-1, 2) - seen) ** 2, axis=1))))
        if np.isfinite(rms) and (best is None or rms < best[1]):
            rotation = np.asarray(cv2.Rodrigues(fine_turn)[0], dtype=np.float64)
            best = (rotation, np.asarray(fine_move, dtype=np.float64).ravel()), rms
    if best is None:
        raise _plane_unknown("no pose of the plane fits its points")
    return best


def _on_plane(camera: CameraModel, plane: tuple[Array, Array], px: Array) -> Array:
    """Return the points (n, 2) of the plane in mm seen at pixels (n, 2)."""
    rotation, translation = plane
    directions = camera.normalised_from_px(px)
    rays = np.concatenate([directions, np.ones((px.shape[0], 1))], axis=1) @ rotation
    origin = -translation @ rotation
    if (np.abs(rays[:, 2]) < 1e-9).any() or (-origin[2] / rays[:, 2] <= 0.0).any():
        raise _plane_unknown("a measured point is not seen on it")
    return np.asarray(origin[:2] - rays[:, :2] * (origin[2] / rays[:, 2])[:, None])


def _distance(plane: tuple[Array, Array], displacements: Displacements) -> float:
    rotation, translation = plane
    middle = np.append(displacements.points_mm.mean(axis=0), 0.0)
    return float(np.linalg.norm(rotation @ middle + translation))


def _plane_unknown(problem: str) -> CalibrationError:
    return CalibrationError(
        "ACCURACY_PLANE_UNKNOWN",
        f"the plane of the displacements is not determined: {problem}",
        "Give more points of the plane, spread over it and other than those that are measured.",
        {"plane_problem": problem},
    )
