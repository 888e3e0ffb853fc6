"""Plate and captures files: the divots, and which poses were recorded with the tip in which of them."""

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, ValidationError

from server.certificate import calibration_sha256
from server.certificate.plate_file import REMEDY as PLATE_REMEDY
from server.certificate.plate_file import DivotName, PlateFile, plate_file_from
from server.config import Section
from server.pose_file import Unit, read_poses
from server.tool_file import ToolFile
from server.yaml_file import yaml_in
from tracker.accuracy import DivotCapture, TrackedTool, capture_at_rest
from tracker.errors import InvalidInput

REMEDY = (
    "A captures file is YAML or JSON with captures: a list of divot, placement, posture and poses, the path "
    "of the poses beside this file."
)
Label = Annotated[str, Field(min_length=1, max_length=20)]
# Printed sides are given to a hundredth of a millimetre.
SAME_SIDE_MM = 0.005


class CaptureEntry(Section):
    """One capture: the tip at rest in a divot."""

    divot: DivotName
    placement: Label = "1"
    """The same for all captures between which neither plate nor camera moved."""
    posture: Label
    """How the tool was held: upright, tilted, turned, or any other word."""
    poses: Annotated[str, Field(min_length=1, max_length=400)]
    """Path of the poses, relative to the captures file, in a form that `coaxial pivot` reads."""


class CapturesFile(Section):
    """The captures of an accuracy test."""

    kind: Literal["coaxial accuracy captures"] = "coaxial accuracy captures"
    captures: Annotated[list[CaptureEntry], Field(min_length=1, max_length=1000)]


def load_plate_file(path: Path) -> PlateFile:
    """Read a plate file (YAML or JSON).

    Raises:
        InvalidInput: PLATE_FILE_UNREADABLE or PLATE_FILE_INVALID; the message names the file.
    """
    values = yaml_in(path, what="plate file", code="PLATE_FILE_UNREADABLE", remedy=PLATE_REMEDY)
    try:
        return plate_file_from(values)
    except InvalidInput as error:
        raise InvalidInput(
            error.code, f"{path}: {error.message}", error.remedy, {**error.context, "file": str(path)}
        ) from error


def load_captures(path: Path, tool_file: ToolFile, tool: TrackedTool, *, unit: Unit) -> list[DivotCapture]:
    """Read all captures of a file.

    Raises:
        InvalidInput: CAPTURES_FILE_UNREADABLE, CAPTURES_FILE_INVALID, TOOL_SIDE_DIFFERS,
            POSES_OF_ANOTHER_CAMERA, or as `read_poses`.
        CalibrationError: as `capture_at_rest`.
    """
    values = yaml_in(path, what="captures file", code="CAPTURES_FILE_UNREADABLE", remedy=REMEDY)
    try:
        file = CapturesFile.model_validate(_with_texts(values))
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(str(part)[:40] for part in first["loc"]) or "it"
        raise InvalidInput(
            "CAPTURES_FILE_INVALID",
            f"the captures file {path} cannot be used: {key}: {first['msg'].lower()[:200]}",
            REMEDY,
            {"file": str(path)},
        ) from None
    return [_capture(path.parent, one, tool_file, tool, unit) for one in file.captures]


def _capture(
    folder: Path, entry: CaptureEntry, tool_file: ToolFile, tool: TrackedTool, unit: Unit
) -> DivotCapture:
    files = read_poses(folder / entry.poses, unit=unit, marker=tool_file.marker)
    other = next(
        (
            one.side_mm
            for one in files.records
            if one.side_mm is not None and abs(one.side_mm - tool_file.side_mm) > SAME_SIDE_MM
        ),
        None,
    )
    if other is not None:
        raise InvalidInput(
            "TOOL_SIDE_DIFFERS",
            f"poses in {folder / entry.poses} were tracked with a side of {other:g} mm, but the side is "
            f"{tool_file.side_mm:g} mm",
            "Measure the printed black square, and track again if its side differs.",
            {"tracked_mm": [other], "side_mm": tool_file.side_mm},
        )
    # A certificate is of the camera file, so that its poses must be, too.
    here = calibration_sha256(tool.camera)
    if any(one.calibration_sha256 not in (None, here) for one in files.records):
        raise InvalidInput(
            "POSES_OF_ANOTHER_CAMERA",
            f"poses in {folder / entry.poses} were tracked with another calibration than that of --camera",
            "Give the camera file of 'coaxial track --camera', or track the captures again with this one.",
        )
    return capture_at_rest(
        files.poses,
        tool.tip_in_marker_mm,
        divot=entry.divot,
        placement=entry.placement,
        posture=entry.posture,
    )


def _with_texts(values: object) -> object:
    """Return the values with names of digits, which YAML reads as integers, as texts."""
    if not isinstance(values, dict) or not isinstance(captures := values.get("captures"), list):
        return values
    texts = [
        {key: str(value) if isinstance(value, int) else value for key, value in one.items()}
        if isinstance(one, dict)
        else one
        for one in captures
    ]
    return {**values, "captures": texts}
