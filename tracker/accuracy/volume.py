"""Map of the predicted error of the tip over the field of view, in a plane through the line of sight."""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tracker.accuracy.capture import DivotCapture
from tracker.accuracy.marker_geometry import TrackedTool, corners_mm, tip_sensitivity
from tracker.geometry import Array, Camera, Marker, Rigid

COLUMNS, ROWS = 17, 11
# The map extends beyond the tested distances by this ratio.
BEYOND_RATIO = 0.35
# Orientations of the captures that are tried at each place.
MAX_ORIENTATIONS = 5


@dataclass(frozen=True, slots=True, kw_only=True)
class VolumeMap:
    """Predicted error by place, at the mean height of the captured tips.

    Attributes:
        x_mm, z_mm: (c,) and (r,), places in the camera's frame.
        y_mm: height of the plane.
        error_95_mm: (r, c); NaN where the marker is not in view as a whole.
    """

    x_mm: Array
    z_mm: Array
    y_mm: float
    error_95_mm: Array


def volume_map(captures: Sequence[DivotCapture], tool: TrackedTool, *, error_95_mm: float) -> VolumeMap:
    """Return the map of the error that the geometry of camera and marker predicts.

    The certified error holds for the worst placement; elsewhere it is scaled by the effect of the same corner
    noise on the tip there, for the tool held as in the captures. A prediction, measured only at the captures.
    """
    tips = np.array([one.tip_in_camera_mm for one in captures])
    variances: dict[str, list[float]] = defaultdict(list)
    for one in captures:
        variances[one.placement].append(_variance(tool, one.camera_from_marker))
    here = max(float(np.mean(ones)) for ones in variances.values())
    step = max(1, len(captures) // MAX_ORIENTATIONS)
    rotations = [one.camera_from_marker.rotation for one in captures[::step]][:MAX_ORIENTATIONS]
    low_z, high_z = tips[:, 2].min() * (1.0 - BEYOND_RATIO), tips[:, 2].max() * (1.0 + BEYOND_RATIO)
    half = 0.5 * high_z * tool.camera.size_wh_px[0] / tool.camera.matrix[0, 0]
    x, z, y = np.linspace(-half, half, COLUMNS), np.linspace(low_z, high_z, ROWS), float(tips[:, 1].mean())
    errors = np.full((ROWS, COLUMNS), np.nan)
    for row, column in np.ndindex(ROWS, COLUMNS):
        at = np.array([x[column], y, z[row]])
        poses: list[Rigid[Camera, Marker]] = [
            Rigid(rotation=one, translation_mm=at - one @ tool.tip_in_marker_mm) for one in rotations
        ]
        seen = [_variance(tool, one) for one in poses if _is_in_view(tool, one)]
        if seen:
            errors[row, column] = error_95_mm * np.sqrt(np.mean(seen) / here)
    return VolumeMap(x_mm=x, z_mm=z, y_mm=y, error_95_mm=errors)


def _variance(tool: TrackedTool, pose: Rigid[Camera, Marker]) -> float:
    return float(np.trace(tip_sensitivity(tool, pose).covariance_mm2_per_px2))


def _is_in_view(tool: TrackedTool, pose: Rigid[Camera, Marker]) -> bool:
    """Return whether the printed face is towards the camera, and all its corners are in the image."""
    corners = pose.move_points(corners_mm(tool.side_mm))
    if float(corners[:, 2].min()) <= 0.0 or float(pose.rotation[:, 2] @ pose.translation_mm) >= 0.0:
        return False
    px = tool.camera.px_from_camera(corners)
    return bool((px >= 0.0).all() and (px <= np.array(tool.camera.size_wh_px) - 1.0).all())
