"""Tool files: tip and axis of a tool from pivot and spin calibration.

A tool file contains the name and the side of its marker, because the tip is only valid in the frame of this
marker at this size. It is not written if the calibration exceeds its limits.
"""

from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any, Literal

import yaml
from pydantic import Field, ValidationError

from server.config import MarkerConfig, Name, Point, Section, ToolConfig
from server.yaml_file import yaml_in
from tracker.errors import CalibrationError, InvalidInput
from tracker.pose import ToolModel
from tracker.pose.tool import PivotCalibration, SpinCalibration

# The side is measured with a ruler or calipers; its relative error equals the relative error of the tip.
SIDE_TOLERANCE_RATIO = 1e-3
REMEDY = "Write one with 'coaxial pivot POSES --marker NAME --side-mm MM --output FILE'."

Row = Annotated[list[float], Field(min_length=3, max_length=3)]
Matrix = Annotated[list[Row], Field(min_length=3, max_length=3)]


# In JSON, and where a program has quoted it, a date is text.
Time = Annotated[datetime, Field(strict=False)]


class PivotPart(Section):
    """Result of a pivot calibration."""

    tip_in_marker_mm: Point
    covariance_mm2: Matrix
    rms_3d_mm: Annotated[float, Field(ge=0.0)]
    used: Annotated[int, Field(ge=1)]
    rejected: Annotated[int, Field(ge=0)]
    tilt_range_deg: float
    made_at: Time


class SpinPart(Section):
    """Result of a spin calibration; the axis points from the marker to the tip."""

    axis_in_marker: Point
    axis_sd_deg: Annotated[float, Field(ge=0.0)]
    spin_range_deg: float
    wobble_deg: float
    used: Annotated[int, Field(ge=1)]
    rejected: Annotated[int, Field(ge=0)]
    made_at: Time


class ToolMarker(Section):
    """The marker of a tool."""

    marker: Name
    side_mm: Annotated[float, Field(gt=0.0, le=1000.0)]


class ToolFile(ToolMarker):
    """Calibration of a tool, valid for one marker of one size."""

    kind: Literal["coaxial tool"] = "coaxial tool"
    pivot: PivotPart
    spin: SpinPart | None = None


def load_tool_file(path: Path) -> ToolFile:
    """Read a tool file.

    Raises:
        InvalidInput: TOOL_FILE_UNREADABLE or TOOL_FILE_INVALID; the message names the file.
    """
    values = yaml_in(path, what="tool file", code="TOOL_FILE_UNREADABLE", remedy=REMEDY)
    try:
        return ToolFile.model_validate(values)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(str(part) for part in first["loc"]) or "it"
        reason = f"{key}: {first['msg'].lower()}"
        raise InvalidInput(
            "TOOL_FILE_INVALID",
            f"the tool file {path} cannot be used: {reason}",
            REMEDY,
            {"file": str(path), "library_error": reason},
        ) from None


def text_of_tool_file(tool: ToolFile) -> str:
    """Return the text of a tool file."""
    values = tool.model_dump(mode="python", exclude_none=True)
    return "# Written by coaxial. Add it to config.yaml as tools: NAME: calibration:.\n" + yaml.safe_dump(
        values, sort_keys=False, default_flow_style=None, width=100
    )


def tool_mistakes(name: str, tool: ToolConfig) -> list[tuple[str, str]]:
    """Return the invalid keys of a tool's settings, each with a message."""
    found = []
    key = f"tools.{name}"
    if tool.calibration is None:
        for part in ("tip_in_marker_mm", "axis_in_marker"):
            if getattr(tool, part) is None:
                sentence = f"'{key}.{part}' is missing, expected: three numbers, or a tool file under "
                found.append((part, f"{sentence}'{key}.calibration'"))
    elif tool.tip_in_marker_mm is not None:
        sentence = f"'{key}.tip_in_marker_mm' is given in addition to its calibration, allowed: one of them"
        found.append(("tip_in_marker_mm", sentence))
    axis = tool.axis_in_marker
    if axis is not None and max(abs(x) for x in axis) < 1e-9:
        sentence = f"'{key}.axis_in_marker' is {axis}, allowed: a direction, not all three numbers 0"
        found.append(("axis_in_marker", sentence))
    return found


def tool_from_config(name: str, tool: ToolConfig, marker: MarkerConfig | None) -> ToolModel:
    """Return the tool of these settings, from its drawing or its tool file.

    Raises:
        InvalidInput: TOOL_FILE_UNREADABLE or TOOL_FILE_INVALID.
        CalibrationError: TOOL_FILE_OF_ANOTHER_MARKER, TOOL_AXIS_UNKNOWN, or TOOL_TIP_UNKNOWN.
    """
    tip, axis = tool.tip_in_marker_mm, tool.axis_in_marker
    covariance_mm2: Matrix | None = None
    axis_sd_deg = 0.0
    if tool.calibration is not None:
        file = load_tool_file(tool.calibration)
        _reject_another_marker(file, tool, marker)
        tip, axis = file.pivot.tip_in_marker_mm, _one_axis(name, tool, file)
        covariance_mm2 = file.pivot.covariance_mm2
        axis_sd_deg = 0.0 if file.spin is None else file.spin.axis_sd_deg
    if tip is None or axis is None:
        raise CalibrationError(
            "TOOL_TIP_UNKNOWN",
            f"tip and axis of '{name}' are not defined",
            f"Give tools.{name}.calibration, or tip_in_marker_mm and axis_in_marker.",
            {"tool": name},
        )
    return ToolModel.from_tip_and_axis(
        name=name,
        marker=tool.marker,
        tip_in_marker_mm=tip,
        axis_in_marker=axis,
        radius_mm=tool.radius_mm,
        length_mm=tool.length_mm,
        tip_covariance_mm2=covariance_mm2,
        axis_sd_deg=axis_sd_deg,
    )


def _reject_another_marker(file: ToolFile, tool: ToolConfig, marker: MarkerConfig | None) -> None:
    side_mm = file.side_mm if marker is None else marker.side_mm
    if file.marker == tool.marker and abs(side_mm - file.side_mm) <= SIDE_TOLERANCE_RATIO * file.side_mm:
        return
    raise CalibrationError(
        "TOOL_FILE_OF_ANOTHER_MARKER",
        f"{tool.calibration} was made with marker '{file.marker}' of {file.side_mm:g} mm, "
        f"but the tool has '{tool.marker}' of {side_mm:g} mm",
        "Calibrate the tool with its present marker; a tip is never scaled.",
        {
            "file": str(tool.calibration),
            "marker": file.marker,
            "side_mm": file.side_mm,
            "tool_marker": tool.marker,
            "tool_side_mm": side_mm,
        },
    )


def _one_axis(name: str, tool: ToolConfig, file: ToolFile) -> list[float]:
    axes = [tool.axis_in_marker, None if file.spin is None else file.spin.axis_in_marker]
    known = [axis for axis in axes if axis is not None]
    if len(known) == 1:
        return known[0]
    place = f"defined in the settings and in {tool.calibration}" if known else "not defined"
    raise CalibrationError(
        "TOOL_AXIS_UNKNOWN",
        f"the axis of '{name}' is {place}, expected in one place",
        f"Add the axis with 'coaxial spin', or set tools.{name}.axis_in_marker.",
        {"tool": name, "axis_place": place},
    )


def pivot_part(found: PivotCalibration) -> PivotPart:
    """Return the part of a tool file for a pivot calibration."""
    return PivotPart(
        tip_in_marker_mm=_rounded(found.tip_in_marker_mm),
        covariance_mm2=[_rounded(row) for row in found.tip_covariance_mm2],
        rms_3d_mm=round(found.rms_3d_mm, 4),
        used=int(found.used.sum()),
        rejected=len(found.rejected),
        tilt_range_deg=round(found.motion_range.tilt_range_deg, 2),
        made_at=_now(),
    )


def spin_part(found: SpinCalibration) -> SpinPart:
    """Return the part of a tool file for a spin calibration."""
    return SpinPart(
        axis_in_marker=_rounded(found.axis_in_marker),
        axis_sd_deg=round(found.axis_sd_deg, 4),
        spin_range_deg=round(found.spin_range_deg, 2),
        wobble_deg=round(found.wobble_deg, 3),
        used=int(found.used.sum()),
        rejected=len(found.rejected),
        made_at=_now(),
    )


def _rounded(numbers: Any) -> list[float]:  # noqa: ANN401  an array of any length
    return [float(f"{number:.8g}") for number in numbers]


def _now() -> datetime:
    return datetime.now(UTC).replace(microsecond=0)
