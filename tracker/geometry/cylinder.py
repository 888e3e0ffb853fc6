"""Visible contours of a cylinder: its rings and its silhouette lines."""

import numpy as np
import numpy.typing as npt

from tracker.geometry.rotations import Array


def cylinder_ring_mm(
    centre_mm: npt.ArrayLike, axis: npt.ArrayLike, radius_mm: float, *, count: int = 49
) -> Array:
    """Return points (count, 3) of the closed circle around `centre_mm` in the plane normal to `axis`."""
    direction = np.asarray(axis, dtype=np.float64)
    across = np.cross(direction, np.eye(3)[int(np.argmin(np.abs(direction)))])
    across /= np.linalg.norm(across)
    angle = np.linspace(0.0, 2.0 * np.pi, count)[:, None]
    ring = np.cos(angle) * across + np.sin(angle) * np.cross(direction, across)
    return np.asarray(np.asarray(centre_mm, dtype=np.float64) + radius_mm * ring, dtype=np.float64)


def cylinder_silhouette_mm(
    start_mm: npt.ArrayLike, end_mm: npt.ArrayLike, radius_mm: float
) -> tuple[tuple[Array, Array], ...]:
    """Return the two silhouette lines (start, end) of a cylinder seen from the frame's origin.

    There the surface normal n is perpendicular to the line of sight: n . (start + radius n) = 0, with n
    across the axis. Empty when the eye is inside the cylinder (or its extension), where no outline exists.
    """
    start, end = np.asarray(start_mm, dtype=np.float64), np.asarray(end_mm, dtype=np.float64)
    axis = (end - start) / np.linalg.norm(end - start)
    to_axis = start - (start @ axis) * axis
    distance = float(np.linalg.norm(to_axis))
    if distance <= radius_mm * (1.0 + 1e-9):
        return ()
    towards_eye = -to_axis / distance
    sideways = np.cross(axis, towards_eye)
    cosine = radius_mm / distance
    sine = float(np.sqrt(1.0 - cosine * cosine))
    lines = []
    for side in (sine, -sine):
        offset = radius_mm * (cosine * towards_eye + side * sideways)
        lines.append((start + offset, end + offset))
    return tuple(lines)
