"""Reads a camera file: the camera's matrix and lens as calibration wrote them."""

from pathlib import Path

import yaml

from tracker.camera import CameraModel
from tracker.errors import InvalidInput

REMEDY = (
    "A camera file is YAML or JSON with matrix (3 rows of 3), distortion (4, 5, 8, 12 or 14 numbers) "
    "and size_wh_px (width, height)."
)


def load_camera_file(path: Path) -> CameraModel:
    """The camera model in a YAML or JSON file.

    Raises:
        InvalidInput: CAMERA_FILE_UNREADABLE, CAMERA_FILE_INCOMPLETE, CAMERA_FILE_INVALID or
            CAMERA_MODEL_INVALID; the message names the file.
    """
    context: dict[str, object] = {"file": str(path)}
    try:
        # JSON is YAML too.
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        message = f"the camera file {path} cannot be read: {error.strerror}"
        raise InvalidInput("CAMERA_FILE_UNREADABLE", message, REMEDY, context) from error
    except (UnicodeDecodeError, yaml.YAMLError) as error:
        message = f"the camera file {path} is neither YAML nor JSON"
        raise InvalidInput("CAMERA_FILE_UNREADABLE", message, REMEDY, context) from error
    if not isinstance(values, dict):
        message = f"the camera file {path} is a {type(values).__name__}, needed keys with values"
        raise InvalidInput("CAMERA_FILE_INVALID", message, REMEDY, context)
    try:
        return CameraModel.from_mapping(values)
    except InvalidInput as error:
        raise InvalidInput(
            error.code, f"{path}: {error.message}", error.remedy, {**error.context, **context}
        ) from error
