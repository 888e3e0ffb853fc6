"""Poses in JSON, JSON lines (also those of `coaxial track`) and NumPy arrays."""

import json
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from server.pose_file.record import TIME_NAMES, PoseRecord, at_place, unreadable
from server.pose_file.unit import Unit
from tracker.errors import InvalidInput
from tracker.pose.tool import rigid_from_matrix

MATRIX_KEYS = ("camera_from_marker", "matrix", "pose", "transform")
LIST_KEYS = ("poses", "camera_from_marker", "matrices", "transforms")


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseFileContent:
    """Poses of a file, and the number of images without the marker."""

    poses: list[PoseRecord]
    unseen: int = 0


def poses_from_json(text: str, *, name: str, unit: Unit) -> PoseFileContent:
    """Parse all poses in a JSON text or in JSON lines.

    Raises:
        InvalidInput: POSES_UNREADABLE, POSES_NOT_CALIBRATED or POSE_MATRIX_INVALID, with the place.
    """
    try:
        value = json.loads(text)
    except json.JSONDecodeError:
        return _from_values(_lines(text, name), unit=unit)
    except (RecursionError, ValueError) as error:
        why = "it is nested too deeply" if isinstance(error, RecursionError) else "a number is too long"
        raise unreadable(name, why) from None
    if isinstance(value, dict):
        listed = next((value[key] for key in LIST_KEYS if isinstance(value.get(key), list)), None)
        if listed is None or np.shape(_numbers(listed)) in {(4, 4), (3, 4)}:
            return _from_values([(name, value)], unit=unit)
        value = listed
    if isinstance(value, list) and all(isinstance(one, dict) for one in value):
        return _from_values(
            [(f"{name}, pose {number}", one) for number, one in enumerate(value, start=1)], unit=unit
        )
    return PoseFileContent(poses=poses_from_array(_numbers(value), name=name, unit=unit))


def poses_from_array(array: np.ndarray, *, name: str, unit: Unit) -> list[PoseRecord]:
    """Convert an array (4, 4), (n, 4, 4), (n, 3, 4), (n, 16) or (n, 12) to poses.

    Raises:
        InvalidInput: POSES_UNREADABLE or POSE_MATRIX_INVALID, with the place.
    """
    numeric = array.dtype.kind in "fiu"
    if numeric and array.ndim == 2 and array.shape[1] in {12, 16}:
        array = array.reshape(len(array), -1, 4)
    if numeric and array.ndim == 2 and array.shape in {(3, 4), (4, 4)}:
        return [_pose(array, name, unit)]
    if not numeric or array.ndim != 3 or array.shape[1:] not in {(3, 4), (4, 4)}:
        what = f"an array of shape {array.shape}" if numeric and array.ndim else "no array of numbers"
        raise unreadable(name, f"it contains {what}, expected (n, 4, 4)")
    return [_pose(matrix, f"{name}, pose {number}", unit) for number, matrix in enumerate(array, start=1)]


def _lines(text: str, name: str) -> list[tuple[str, Any]]:
    values = []
    for number, line in enumerate(text.splitlines(), start=1):
        if line.strip():
            try:
                values.append((f"{name}, line {number}", json.loads(line)))
            except (ValueError, RecursionError):
                raise unreadable(f"{name}, line {number}", "it is not valid JSON") from None
    if not values:
        raise unreadable(name, "it is empty")
    return values


def _from_values(values: list[tuple[str, Any]], *, unit: Unit) -> PoseFileContent:
    poses: list[PoseRecord] = []
    unseen = 0
    for place, value in values:
        if isinstance(value, dict) and value.get("seen") is False:
            unseen += 1
        else:
            poses.append(_from_value(place, value, unit))
    return PoseFileContent(poses=poses, unseen=unseen)


def _from_value(place: str, value: Any, unit: Unit) -> PoseRecord:  # noqa: ANN401  JSON may be anything
    if not isinstance(value, dict):
        return _pose(_numbers(value), place, unit)
    if value.get("seen") is True and value.get("camera_from_marker") is None:
        raise InvalidInput(
            "POSES_NOT_CALIBRATED",
            f"{place}: the marker was seen, but its pose in mm is unknown without a camera file",
            "Track the video again with --camera FILE.",
            {"place": place},
        )
    inner = next((value[key] for key in MATRIX_KEYS if value.get(key) is not None), value)
    if isinstance(inner, dict):
        translation = inner.get("translation_mm", inner.get("translation"))
        rotation = _numbers(inner.get("rotation"))
        if rotation.shape != (3, 3) or np.shape(_numbers(translation)) != (3,):
            raise unreadable(place, "it has no rotation (3 rows of 3) with translation_mm (3 numbers)")
        matrix = np.hstack([rotation, _numbers(translation).reshape(3, 1)])
    else:
        matrix = _numbers(inner)
        matrix = matrix.reshape(-1, 4) if matrix.shape in {(12,), (16,)} else matrix
    marker = value.get("name", value.get("marker"))
    covariance, side_mm = value.get("pose_covariance"), value.get("side_mm")
    time_s = next((value[key] for key in TIME_NAMES if isinstance(value.get(key), int | float)), None)
    calibration = value.get("calibration_sha256")
    found = _pose(matrix, place, unit)
    return replace(
        found,
        covariance=None if covariance is None else _numbers(covariance),
        marker=None if marker is None else str(marker),
        side_mm=float(side_mm) if isinstance(side_mm, int | float) else None,
        time_s=None if time_s is None else float(time_s),
        calibration_sha256=None if calibration is None else str(calibration)[:64],
    )


def _pose(matrix: np.ndarray, place: str, unit: Unit) -> PoseRecord:
    if matrix.dtype.kind not in "fiu" or matrix.shape not in {(4, 4), (3, 4)}:
        raise unreadable(place, "it contains no 4x4 matrix of numbers")
    try:
        pose = rigid_from_matrix(matrix, unit_mm=unit.in_mm)
    except InvalidInput as error:
        raise at_place(place, error) from None
    return PoseRecord(place=place, pose=pose)


def _numbers(value: Any) -> np.ndarray:  # noqa: ANN401  JSON may be anything
    """Return an array of numbers; empty if the value is not one."""
    try:
        array = np.array(value)
    except ValueError:
        return np.empty(0, dtype=object)
    return array.astype(np.float64) if array.dtype.kind in "fiu" else np.empty(0, dtype=object)
