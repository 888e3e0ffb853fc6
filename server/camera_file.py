"""A camera file: the camera's matrix and lens as calibration wrote them, and whose they are."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import yaml

from server.yaml_file import yaml_in
from tracker.camera import CameraControl, CameraModel
from tracker.errors import CalibrationError, InvalidInput

REMEDY = (
    "A camera file is YAML or JSON with matrix (3 rows of 3), distortion (4, 5, 8, 12 or 14 numbers) "
    "and size_wh_px (width, height)."
)

LONGEST_READOUT_MS = 200.0


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraFile:
    """What a camera file says.

    Attributes:
        model: the camera.
        camera_name: which camera it is, as `camera.name` in the settings; None where it does not say.
        camera_source: its source, as `camera.source` in the settings; None where it does not say.
        controls: of the camera at the calibration, in its driver's own units; empty where it does not say.
        readout_ms: from when the first row of an image is read to the last one; None where it does not say.
    """

    model: CameraModel
    camera_name: str | None = None
    camera_source: str | None = None
    controls: Mapping[CameraControl, int] = field(default_factory=dict)
    readout_ms: float | None = None


def load_camera_file(path: Path) -> CameraModel:
    """The camera model in a YAML or JSON file; see `read_camera_file`."""
    return read_camera_file(path).model


def read_camera_file(path: Path) -> CameraFile:
    """What a YAML or JSON file says of a camera.

    Raises:
        InvalidInput: CAMERA_FILE_UNREADABLE, CAMERA_FILE_INCOMPLETE, CAMERA_FILE_INVALID or
            CAMERA_MODEL_INVALID; the message names the file.
    """
    context: dict[str, object] = {"file": str(path)}
    values = yaml_in(path, what="camera file", code="CAMERA_FILE_UNREADABLE", remedy=REMEDY)
    if not isinstance(values, dict):
        message = f"the camera file {path} is a {type(values).__name__}, needed keys with values"
        raise InvalidInput("CAMERA_FILE_INVALID", message, REMEDY, context)
    camera = values.get("camera")
    whose = camera if isinstance(camera, dict) else {}
    try:
        model = CameraModel.from_mapping(values)
        controls, readout_ms = controls_in(whose), readout_in(whose)
    except InvalidInput as error:
        raise InvalidInput(
            error.code, f"{path}: {error.message}", error.remedy, {**error.context, **context}
        ) from error
    return CameraFile(
        model=model,
        camera_name=_text(whose.get("name")),
        camera_source=_text(whose.get("source")),
        controls=controls,
        readout_ms=readout_ms,
    )


def controls_in(camera: Mapping[str, object]) -> Mapping[CameraControl, int]:
    """The values of a camera's controls under `controls`; none where there is no such key.

    Raises:
        InvalidInput: CAMERA_FILE_INVALID, a control that is not known, or a value that is no whole number.
    """
    values = camera.get("controls", {})
    known = [control.value for control in CameraControl]
    if isinstance(values, Mapping) and all(
        key in known and isinstance(value, int) and not isinstance(value, bool)
        for key, value in values.items()
    ):
        return {CameraControl(key): value for key, value in values.items()}
    raise InvalidInput(
        "CAMERA_FILE_INVALID",
        f"the controls of a camera are {values!r}, needed are whole numbers by name",
        f"Leave controls out, or name some of these with their values: {', '.join(known)}.",
        {"controls": str(values)},
    )


def readout_in(camera: Mapping[str, object]) -> float | None:
    """The readout time of a camera's rows under `readout_ms`; None where there is no such key.

    Raises:
        InvalidInput: CAMERA_FILE_INVALID, it is no number from 0 to 200.
    """
    value = camera.get("readout_ms")
    if value is None:
        return None
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    if is_number and 0.0 <= float(str(value)) <= LONGEST_READOUT_MS:
        return float(str(value))
    raise InvalidInput(
        "CAMERA_FILE_INVALID",
        f"the readout of a camera is {value!r}, needed is a number of ms from 0 to {LONGEST_READOUT_MS:g}",
        "Leave readout_ms out where it is not known; 0 is a global shutter.",
        {"readout_ms": str(value)},
    )


def reject_other_camera(file: CameraFile, *, path: Path, name: str, source: object) -> None:
    """Refuse a camera file that says it is of another camera; one that does not say is let be.

    Raises:
        CalibrationError: CAMERA_DIFFERS.
    """
    for key, told, here in (("name", file.camera_name, name), ("source", file.camera_source, source)):
        if told is not None and told != str(here):
            raise CalibrationError(
                "CAMERA_DIFFERS",
                f"{path} was calibrated for the camera whose {key} is '{told}', "
                f"and here camera.{key} is '{here}'",
                "Calibrate this camera, or name the file that belongs to it.",
                {"file": str(path), "calibrated": told, "camera": str(here)},
            )


def camera_file_text(file: CameraFile, facts: Mapping[str, object]) -> str:
    """The file's text: what is needed first, then `facts` for people."""
    values: dict[str, object] = {
        "matrix": file.model.matrix.tolist(),
        "distortion": file.model.distortion.tolist(),
        "size_wh_px": list(file.model.size_wh_px),
    }
    whose: dict[str, object] = {
        "name": file.camera_name,
        "source": file.camera_source,
        "readout_ms": file.readout_ms,
    }
    if file.controls:
        whose["controls"] = controls_values(file.controls)
    if any(whose.values()):
        values["camera"] = {key: value for key, value in whose.items() if value is not None}
    text: str = yaml.safe_dump({**values, **facts}, sort_keys=False, default_flow_style=None, width=110)
    return text


def controls_values(controls: Mapping[CameraControl, int]) -> dict[str, int]:
    """Controls as a file or a document has them."""
    return {control.value: value for control, value in controls.items()}


def _text(value: object) -> str | None:
    return None if value is None else str(value)
