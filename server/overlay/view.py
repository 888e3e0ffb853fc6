"""Projection of points and polylines, limited to the part of the lens model that is valid."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.geometry import Array

MIN_DEPTH_MM = 1.0
# The lens polynomial is valid only inside the image; far outside it folds back and would draw false lines.
FIELD_OF_VIEW_MARGIN = 1.1


@dataclass(frozen=True, slots=True)
class View:
    """The camera of one image, with the largest x/z at which its lens model is valid."""

    camera: CameraModel
    max_tangent: float

    @classmethod
    def of(cls, camera: CameraModel) -> "View":
        """Return the view of this camera."""
        w, h = (float(size - 1) for size in camera.size_wh_px)
        border: list[list[float]] = [
            [0, 0],
            [w / 2, 0],
            [w, 0],
            [w, h / 2],
            [w, h],
            [w / 2, h],
            [0, h],
            [0, h / 2],
        ]
        max_tangent = float(np.linalg.norm(camera.normalised_from_px(border), axis=1).max())
        return cls(camera, max_tangent * FIELD_OF_VIEW_MARGIN if np.isfinite(max_tangent) else 1.0)

    def project(self, points_mm: npt.ArrayLike) -> tuple[Array, npt.NDArray[np.bool_]]:
        """Return pixels (n, 2) of points (n, 3) in the camera frame, and which of them (n,) are valid."""
        points = np.asarray(points_mm, dtype=np.float64).reshape(-1, 3)
        shown = np.isfinite(points).all(axis=1) & (points[:, 2] > MIN_DEPTH_MM)
        safe = np.where(shown[:, None], points, [0.0, 0.0, 1.0])
        shown &= np.hypot(safe[:, 0], safe[:, 1]) <= self.max_tangent * safe[:, 2]
        px = self.camera.px_from_camera(np.where(shown[:, None], safe, [0.0, 0.0, 1.0]))
        shown &= np.isfinite(px).all(axis=1)
        return px, shown

    def runs(self, points_mm: npt.ArrayLike) -> list[Array]:
        """Return the valid parts (m, 2), m >= 2, of a polyline of points (n, 3)."""
        return _stretches(*self.project(points_mm))

    def runs_of(self, polylines_mm: Iterable[Array]) -> list[Array]:
        """Return the valid parts of many polylines; one projection for all of them is faster."""
        listed = list(polylines_mm)
        if not listed:
            return []
        px, shown = self.project(np.concatenate(listed))
        ends = np.cumsum([len(polyline) for polyline in listed])[:-1]
        parts = zip(np.split(px, ends), np.split(shown, ends), strict=True)
        return [run for part_px, part_shown in parts for run in _stretches(part_px, part_shown)]


def _stretches(px: Array, shown: npt.NDArray[np.bool_]) -> list[Array]:
    if shown.all():
        return [px] if len(px) > 1 else []
    breaks = np.flatnonzero(np.diff(shown.astype(np.int8))) + 1
    return [px[part] for part in np.split(np.arange(len(px)), breaks) if shown[part[0]] and len(part) > 1]


def straight(start_mm: npt.ArrayLike, end_mm: npt.ArrayLike, *, count: int = 33) -> Array:
    """Return points (count, 3) from start to end; many, because lens distortion bends straight lines."""
    return np.linspace(np.asarray(start_mm, np.float64), np.asarray(end_mm, np.float64), count)


def dashes(start_mm: npt.ArrayLike, end_mm: npt.ArrayLike, *, dash_mm: float, points_each: int = 4) -> Array:
    """Return dashes (k, points_each, 3) from start to end, with gaps of the same length."""
    start, end = np.asarray(start_mm, np.float64), np.asarray(end_mm, np.float64)
    length = float(np.linalg.norm(end - start))
    count = int(np.clip(round(length / (2.0 * dash_mm)), 1, 60))
    at = (np.arange(count)[:, None] + np.linspace(0.0, 0.5, points_each)[None, :]) / count
    return start + at[:, :, None] * (end - start)
