"""`coaxial pivot`, `coaxial spin`, `coaxial tip-check`: from files of poses to a tool's tip and axis."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from pydantic import ValidationError

from server.cli.output import write_whole
from server.cli.tool_report import Report, check_report, pivot_report, spin_report, told
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
# As printed sides are told, to a hundredth.
SAME_SIDE_MM = 0.005


@dataclass(frozen=True, slots=True, kw_only=True)
class PivotOrder:
    """What was typed; see the options of `coaxial pivot`."""

    poses: Path
    unit: str
    marker: str | None
    side_mm: float | None
    output: Path | None
    config: Path | None


@dataclass(frozen=True, slots=True, kw_only=True)
class TipOrder:
    """What was typed; see the options of `coaxial spin` and `coaxial tip-check`."""

    poses: Path
    unit: str
    marker: str | None
    tool: Path | None
    tip_mm: str | None
    output: Path | None
    config: Path | None


def calibrate_tip(order: PivotOrder, *, as_json: bool) -> int:
    """Find the tip, tell it, and give the exit status: 0, or 1 if it fails its gate.

    Raises:
        NavigationError: the poses say no tip, or a file cannot be read or written.
    """
    config = load_config(order.config)
    files = read_poses(order.poses, unit=Unit(order.unit), marker=order.marker)
    # Asked before the work, so that nobody pivots for a file that cannot be written.
    marker = None if order.output is None else _marker_of(order, files, config)
    if marker is None:
        _reject_another_side(files, order.side_mm, order.poses)
    gate = _gate(config)
    found = pivot_calibration(files.poses, gate)
    failures = found.failures(gate)
    written = None
    if order.output is not None and marker is not None and not failures:
        tool = ToolFile(**marker.model_dump(), pivot=pivot_part(found))
        write_whole(order.output, text_of_tool_file(tool).encode())
        written = order.output
    return _answered(pivot_report(found, failures, files, written, gate), as_json=as_json)


def calibrate_axis(order: TipOrder, *, as_json: bool) -> int:
    """Find the axis, tell it, and give the exit status: 0, or 1 if it fails its gate.

    Raises:
        NavigationError: the poses say no axis, or a file cannot be read or written.
    """
    config = load_config(order.config)
    tool = None if order.tool is None else load_tool_file(order.tool)
    if order.output is not None and tool is None:
        raise InvalidInput(
            "TOOL_FILE_NEEDED",
            f"{order.output} would have an axis and no tip",
            "Find the tip first with 'coaxial pivot --output FILE', then give that file with --tool.",
        )
    files = _poses_of(order, tool)
    gate = _gate(config)
    found = spin_calibration(files.poses, tip_in_marker_mm=_tip(order, tool), gate=gate)
    failures = found.failures(gate)
    written = None
    if order.output is not None and tool is not None and not failures:
        whole = tool.model_copy(update={"spin": spin_part(found)})
        write_whole(order.output, text_of_tool_file(whole).encode())
        written = order.output
    return _answered(spin_report(found, failures, files, written, gate), as_json=as_json)


def check_tool_tip(order: TipOrder, *, as_json: bool) -> int:
    """Tell how far the tip wanders, and give the exit status: 0, or 1 if it fails its gate.

    Raises:
        NavigationError: the poses or the tip cannot be used.
    """
    config = load_config(order.config)
    tool = None if order.tool is None else load_tool_file(order.tool)
    tip = _tip(order, tool)
    if tip is None:
        raise InvalidInput(
            "TOOL_TIP_MISSING",
            "there is no tip to check",
            "Give the tool's file with --tool FILE, or its tip with --tip-mm X,Y,Z.",
        )
    files = _poses_of(order, tool)
    gate = _gate(config)
    found = check_tip(files.poses, tip, gate)
    return _answered(check_report(found, found.failures(gate), files, gate), as_json=as_json)


def _answered(report: Report, *, as_json: bool) -> int:
    told(report, as_json=as_json)
    return FAILED if report.failures else 0


def _gate(config: Config) -> ToolGate:
    return ToolGate(**config.tool_calibration.model_dump())


def _marker_of(order: PivotOrder, files: PoseFiles, config: Config) -> ToolMarker:
    """The marker that a tool file belongs to."""
    names = {record.marker for record in files.records if record.marker is not None}
    name = order.marker or (names.pop() if names else None)
    side_mm = order.side_mm
    if side_mm is None and name is not None and name in config.markers:
        side_mm = config.markers[name].side_mm
    if side_mm is None:
        side_mm = next((one.side_mm for one in files.records if one.side_mm is not None), None)
    if name is None or side_mm is None:
        missing = "the name" if name is None else f"the side of '{name}'"
        raise InvalidInput(
            "TOOL_MARKER_UNKNOWN",
            f"a tool file belongs to one marker, and {missing} is not known",
            "Give --marker NAME and --side-mm MM, or the settings in which the marker stands with --config.",
        )
    _reject_another_side(files, side_mm, order.poses)
    try:
        return ToolMarker(marker=name, side_mm=side_mm)
    except ValidationError:
        raise InvalidInput(
            "TOOL_MARKER_UNKNOWN",
            f"a marker '{name}' of {side_mm:g} mm cannot be used",
            "Names are letters, digits, - and _, at most 40; sides are over 0 and at most 1000 mm.",
        ) from None


def _poses_of(order: TipOrder, tool: ToolFile | None) -> PoseFiles:
    """The poses of the tool's marker, tracked with its side."""
    files = read_poses(order.poses, unit=Unit(order.unit), marker=_marker_name(order, tool))
    _reject_another_side(files, None if tool is None else tool.side_mm, order.poses)
    return files


def _reject_another_side(files: PoseFiles, side_mm: float | None, path: Path) -> None:
    """A pose's millimetres are in proportion to the side that it was tracked with: it must be this one."""
    told = sorted({one.side_mm for one in files.records if one.side_mm is not None})
    wanted = told[0] if side_mm is None and told else side_mm
    other = next((one for one in told if wanted is not None and abs(one - wanted) > SAME_SIDE_MM), None)
    if other is not None:
        raise InvalidInput(
            "TOOL_SIDE_DIFFERS",
            f"poses in {path} were tracked with a side of {other:g} mm, and the marker's is {wanted:g} mm",
            "Measure the printed black square, and track again if that side is another one.",
            {"tracked_mm": told, "side_mm": side_mm},
        )


def _marker_name(order: TipOrder, tool: ToolFile | None) -> str | None:
    if order.marker is not None and tool is not None and order.marker != tool.marker:
        raise InvalidInput(
            "TOOL_FILE_OF_ANOTHER_MARKER",
            f"{order.tool} was made with marker '{tool.marker}', asked for is '{order.marker}'",
            "Give the file of the tool that carries this marker.",
        )
    return order.marker if tool is None else tool.marker


def _tip(order: TipOrder, tool: ToolFile | None) -> Array | None:
    if order.tip_mm is None:
        return None if tool is None else np.array(tool.pivot.tip_in_marker_mm)
    try:
        tip = np.array([float(word) for word in order.tip_mm.replace(",", " ").split()])
    except ValueError:
        tip = np.empty(0)
    if tool is not None or tip.shape != (3,) or not np.isfinite(tip).all():
        raise InvalidInput(
            "TOOL_TIP_INVALID",
            f"--tip-mm is '{order.tip_mm}'" + (", and --tool says a tip too" if tool is not None else ""),
            "Give one of them; --tip-mm takes three numbers in mm, as 0,-120,0.",
        )
    return tip
