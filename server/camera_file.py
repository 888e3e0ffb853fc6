"""Camera files: camera matrix and distortion of a calibration, and the identity of the camera."""

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

MAX_READOUT_MS = 200.0


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraFile:
    """Content of a camera file.

    Attributes:
        model: The camera model.
        camera_name: `camera.name` of the calibrated camera; None if not stated.
        camera_source: `camera.source` of the calibrated camera; None if not stated.
        controls: Camera controls at the calibration, in driver units; empty if not stated.
        device: `CameraStatus.device` at the calibration; empty if not stated.
        readout_ms: Readout time from the first to the last row; None if not stated.
        report: Results of the calibration (rms_px, sd, warnings); see `server.camera_remarks`.
    """

    model: CameraModel
    camera_name: str | None = None
    camera_source: str | None = None
    controls: Mapping[CameraControl, int] = field(default_factory=dict)
    device: str = ""
    readout_ms: float | None = None
    report: Mapping[str, object] = field(default_factory=dict)


def load_camera_file(path: Path) -> CameraModel:
    """Read the camera model of a YAML or JSON file; see `read_camera_file`."""
    return read_camera_file(path).model


def read_camera_file(path: Path) -> CameraFile:
    """Read a camera file (YAML or JSON).

    Raises:
        InvalidInput: CAMERA_FILE_UNREADABLE, CAMERA_FILE_INCOMPLETE, CAMERA_FILE_INVALID or
            CAMERA_MODEL_INVALID; the message names the file.
    """
    context: dict[str, object] = {"file": str(path)}
    values = yaml_in(path, what="camera file", code="CAMERA_FILE_UNREADABLE", remedy=REMEDY)
    if not isinstance(values, dict):
        given = type(values).__name__
        raise InvalidInput(
            "CAMERA_FILE_INVALID",
            f"the camera file {path} is a {given}, expected keys with values",
            REMEDY,
            {"file": str(path), "given": given},
        )
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
        device=_text(whose.get("device")) or "",
        readout_ms=readout_ms,
        report=values,
    )


def controls_in(camera: Mapping[str, object]) -> Mapping[CameraControl, int]:
    """Return the camera controls under `controls`; empty without this key.

    Raises:
        InvalidInput: CAMERA_FILE_INVALID, a control is unknown, or a value is not an integer.
    """
    values = camera.get("controls", {})
    known = [control.value for control in CameraControl]
    if isinstance(values, Mapping) and all(
        key in known and isinstance(value, int) and not isinstance(value, bool)
        for key, value in values.items()
    ):
        return {CameraControl(key): value for key, value in values.items()}
    stated, names = str(values), ", ".join(known)
    raise InvalidInput(
        "CAMERA_FILE_INVALID",
        f"the controls of a camera are {stated}, expected integers by name",
        f"Omit controls, or give values for some of: {names}.",
        {"controls": stated, "names": names},
    )


def readout_in(camera: Mapping[str, object]) -> float | None:
    """Return the readout time under `readout_ms`; None without this key.

    Raises:
        InvalidInput: CAMERA_FILE_INVALID, the value is not a number from 0 to 200.
    """
    value = camera.get("readout_ms")
    if value is None:
        return None
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    if is_number and 0.0 <= float(str(value)) <= MAX_READOUT_MS:
        return float(str(value))
    raise InvalidInput(
        "CAMERA_FILE_INVALID",
        f"the readout of a camera is {value}, expected a number of ms from 0 to {MAX_READOUT_MS:g}",
        "Omit readout_ms if it is unknown; 0 is a global shutter.",
        {"readout_ms": str(value), "max_readout_ms": MAX_READOUT_MS},
    )


def reject_other_camera(file: CameraFile, *, path: Path, name: str, source: object) -> None:
    """Reject a camera file of another camera; a file without this information is accepted.

    Raises:
        CalibrationError: CAMERA_DIFFERS.
    """
    for key, stated, here in (("name", file.camera_name, name), ("source", file.camera_source, source)):
        if stated is not None and stated != str(here):
            raise CalibrationError(
                "CAMERA_DIFFERS",
                f"{path} was calibrated for the camera whose {key} is '{stated}', "
                f"but camera.{key} is '{here}'",
                "Calibrate this camera, or give its own camera file.",
                {"file": str(path), "calibrated": stated, "camera": str(here), "key": key},
            )


def camera_file_text(file: CameraFile, facts: Mapping[str, object]) -> str:
    """Return the text of a camera file: required values, then `facts` for information."""
    values: dict[str, object] = {
        "matrix": file.model.matrix.tolist(),
        "distortion": file.model.distortion.tolist(),
        "size_wh_px": list(file.model.size_wh_px),
    }
    whose: dict[str, object] = {
        "name": file.camera_name,
        "source": file.camera_source,
        "device": file.device or None,
        "readout_ms": file.readout_ms,
    }
    if file.controls:
        whose["controls"] = controls_values(file.controls)
    if any(whose.values()):
        values["camera"] = {key: value for key, value in whose.items() if value is not None}
    text: str = yaml.safe_dump({**values, **facts}, sort_keys=False, default_flow_style=None, width=110)
    return text


def controls_values(controls: Mapping[CameraControl, int]) -> dict[str, int]:
    """Return controls by name, as stored in files and documents."""
    return {control.value: value for control, value in controls.items()}


def _text(value: object) -> str | None:
    return None if value is None else str(value)
