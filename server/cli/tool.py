"""`coaxial pivot`, `coaxial spin`, `coaxial tip-check`: calibrate tip and axis of a tool from pose files."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from pydantic import ValidationError

from server.cli.output import write_atomically
from server.cli.tool_report import Report, check_report, pivot_report, print_report, spin_report
from server.config import Config
from server.config_file import load_config
from server.pose_file import PoseFiles, Unit, read_poses
from server.tool_file import ToolFile, ToolMarker, load_tool_file, pivot_part, spin_part, text_of_tool_file
from tracker.errors import InvalidInput
from tracker.geometry import Array
from tracker.pose.tool import (
    ToolGate,
    check_tip,
    pivot_calibration,
    spin_calibration,
)

FAILED = 1
# Printed sides are given to a hundredth of a millimetre.
SAME_SIDE_MM = 0.005


@dataclass(frozen=True, slots=True, kw_only=True)
class PivotOptions:
    """Options of `coaxial pivot`."""

    poses: Path
    unit: str
    marker: str | None
    side_mm: float | None
    output: Path | None
    config: Path | None


@dataclass(frozen=True, slots=True, kw_only=True)
class TipOptions:
    """Options of `coaxial spin` and `coaxial tip-check`."""

    poses: Path
    unit: str
    marker: str | None
    tool: Path | None
    tip_mm: str | None
    output: Path | None
    config: Path | None


def calibrate_tip(options: PivotOptions, *, as_json: bool) -> int:
    """Estimate the tip and print it. Return the exit status: 0, or 1 if it exceeds its limits.

    Raises:
        NavigationError: the poses do not determine a tip, or a file cannot be read or written.
    """
    config = load_config(options.config)
    files = read_poses(options.poses, unit=Unit(options.unit), marker=options.marker)
    # Determined first, so that a missing marker is reported before the computation.
    marker = None if options.output is None else _marker_of(options, files, config)
    if marker is None:
        _reject_another_side(files, options.side_mm, options.poses)
    gate = _gate(config)
    found = pivot_calibration(files.poses, gate)
    failures = found.failures(gate)
    written = None
    if options.output is not None and marker is not None and not failures:
        tool = ToolFile(**marker.model_dump(), pivot=pivot_part(found))
        write_atomically(options.output, text_of_tool_file(tool).encode())
        written = options.output
    return _print_and_status(pivot_report(found, failures, files, written, gate), as_json=as_json)


def calibrate_axis(options: TipOptions, *, as_json: bool) -> int:
    """Estimate the axis and print it. Return the exit status: 0, or 1 if it exceeds its limits.

    Raises:
        NavigationError: the poses do not determine an axis, or a file cannot be read or written.
    """
    config = load_config(options.config)
    tool = None if options.tool is None else load_tool_file(options.tool)
    if options.output is not None and tool is None:
        raise InvalidInput(
            "TOOL_FILE_NEEDED",
            f"{options.output} would contain an axis without a tip",
            "Calibrate the tip first with 'coaxial pivot --output FILE', then give that file with --tool.",
        )
    files = _poses_of(options, tool)
    gate = _gate(config)
    found = spin_calibration(files.poses, tip_in_marker_mm=_tip(options, tool), gate=gate)
    failures = found.failures(gate)
    written = None
    if options.output is not None and tool is not None and not failures:
        updated = tool.model_copy(update={"spin": spin_part(found)})
        write_atomically(options.output, text_of_tool_file(updated).encode())
        written = options.output
    return _print_and_status(spin_report(found, failures, files, written, gate), as_json=as_json)


def check_tool_tip(options: TipOptions, *, as_json: bool) -> int:
    """Print the motion of the tip. Return the exit status: 0, or 1 if it exceeds its limit.

    Raises:
        NavigationError: the poses or the tip cannot be used.
    """
    config = load_config(options.config)
    tool = None if options.tool is None else load_tool_file(options.tool)
    tip = _tip(options, tool)
    if tip is None:
        raise InvalidInput(
            "TOOL_TIP_MISSING",
            "no tip is given",
            "Give the tool's file with --tool FILE, or its tip with --tip-mm X,Y,Z.",
        )
    files = _poses_of(options, tool)
    gate = _gate(config)
    found = check_tip(files.poses, tip, gate)
    return _print_and_status(check_report(found, found.failures(gate), files, gate), as_json=as_json)


def _print_and_status(report: Report, *, as_json: bool) -> int:
    print_report(report, as_json=as_json)
    return FAILED if report.failures else 0


def _gate(config: Config) -> ToolGate:
    return ToolGate(**config.tool_calibration.model_dump())


def _marker_of(options: PivotOptions, files: PoseFiles, config: Config) -> ToolMarker:
    """Return the marker that the tool file refers to."""
    names = {record.marker for record in files.records if record.marker is not None}
    name = options.marker or (names.pop() if names else None)
    side_mm = options.side_mm
    if side_mm is None and name is not None and name in config.markers:
        side_mm = config.markers[name].side_mm
    if side_mm is None:
        side_mm = next((one.side_mm for one in files.records if one.side_mm is not None), None)
    if name is None or side_mm is None:
        missing = "the name" if name is None else f"the side of '{name}'"
        raise InvalidInput(
            "TOOL_MARKER_UNKNOWN",
            f"a tool file refers to one marker, and {missing} is not known",
            "Give --marker NAME and --side-mm MM, or the settings with this marker with --config.",
        )
    _reject_another_side(files, side_mm, options.poses)
    try:
        return ToolMarker(marker=name, side_mm=side_mm)
    except ValidationError:
        raise InvalidInput(
            "TOOL_MARKER_UNKNOWN",
            f"a marker '{name}' of {side_mm:g} mm cannot be used",
            "Names are letters, digits, - and _, at most 40; sides are over 0 and at most 1000 mm.",
        ) from None


def _poses_of(options: TipOptions, tool: ToolFile | None) -> PoseFiles:
    """Read the poses of the marker of the tool."""
    files = read_poses(options.poses, unit=Unit(options.unit), marker=_marker_name(options, tool))
    _reject_another_side(files, None if tool is None else tool.side_mm, options.poses)
    return files


def _reject_another_side(files: PoseFiles, side_mm: float | None, path: Path) -> None:
    """Reject poses tracked with another marker side, because their translations scale with the side."""
    sides_mm = sorted({one.side_mm for one in files.records if one.side_mm is not None})
    expected = sides_mm[0] if side_mm is None and sides_mm else side_mm
    other = next(
        (one for one in sides_mm if expected is not None and abs(one - expected) > SAME_SIDE_MM), None
    )
    if other is not None:
        raise InvalidInput(
            "TOOL_SIDE_DIFFERS",
            f"poses in {path} were tracked with a side of {other:g} mm, but the side is {expected:g} mm",
            "Measure the printed black square, and track again if its side differs.",
            {"tracked_mm": sides_mm, "side_mm": side_mm},
        )


def _marker_name(options: TipOptions, tool: ToolFile | None) -> str | None:
    if options.marker is not None and tool is not None and options.marker != tool.marker:
        raise InvalidInput(
            "TOOL_FILE_OF_ANOTHER_MARKER",
            f"{options.tool} was made with marker '{tool.marker}', but --marker is '{options.marker}'",
            "Give the tool file of the tool with this marker.",
        )
    return options.marker if tool is None else tool.marker


def _tip(options: TipOptions, tool: ToolFile | None) -> Array | None:
    if options.tip_mm is None:
        return None if tool is None else np.array(tool.pivot.tip_in_marker_mm)
    try:
        tip = np.array([float(word) for word in options.tip_mm.replace(",", " ").split()])
    except ValueError:
        tip = np.empty(0)
    if tool is not None or tip.shape != (3,) or not np.isfinite(tip).all():
        raise InvalidInput(
            "TOOL_TIP_INVALID",
            f"--tip-mm is '{options.tip_mm}'"
            + (", and --tool contains a tip as well" if tool is not None else ""),
            "Give only one of them; --tip-mm takes three numbers in mm, as 0,-120,0.",
        )
    return tip
