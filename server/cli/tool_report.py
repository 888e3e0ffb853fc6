"""Reports of tool calibrations as text and as JSON."""

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import typer

from server.pose_file import PoseFiles
from tracker.errors import CalibrationError
from tracker.pose.tool import (
    PivotCalibration,
    RejectedPose,
    SpinCalibration,
    TipCheck,
    ToolGate,
    ToolMotionRange,
)

MAX_LISTED = 12


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """The output of a calibration command.

    Attributes:
        lines: Printed text.
        values: JSON object.
        failures: Limits that are exceeded.
    """

    lines: Sequence[str]
    values: dict[str, Any]
    failures: Sequence[CalibrationError] = field(default_factory=tuple)


def print_report(report: Report, *, as_json: bool) -> None:
    """Print a report to standard output, and its failures to standard error."""
    passed = not report.failures
    if as_json:
        gate = {
            **report.values["gate"],
            "passed": passed,
            "failures": [_failure(one) for one in report.failures],
        }
        typer.echo(json.dumps({**report.values, "gate": gate}, allow_nan=False))
    else:
        for line in report.lines:
            typer.echo(line)
        typer.echo("Passed." if passed else "FAILED.")
    for failure in report.failures:
        typer.echo(f"Failed: {failure.message}.\n{failure.remedy}", err=True)


def pivot_report(
    found: PivotCalibration,
    failures: Sequence[CalibrationError],
    files: PoseFiles,
    written: Path | None,
    gate: ToolGate,
) -> Report:
    """Return the report of `coaxial pivot`."""
    sd_mm = [float(v) ** 0.5 for v in found.tip_covariance_mm2.diagonal()]
    turning = found.motion_range
    lines = [
        f"Tip in the marker's frame: {_point(found.tip_in_marker_mm)} mm (sd {_point(sd_mm, 3)})",
        f"Pivot in the camera's frame: {_point(found.pivot_in_camera_mm)} mm",
        f"3-D RMS of the tip about the pivot: {found.rms_3d_mm:.3f} mm, allowed {gate.max_rms_3d_mm:g} mm",
        _used_line(int(found.used.sum()), found.rejected, files, "mm from the pivot"),
        _motion_range_line(turning),
        *_written_line(written),
    ]
    values = {
        "tip_in_marker_mm": found.tip_in_marker_mm.tolist(),
        "pivot_mm": found.pivot_in_camera_mm.tolist(),
        "rms_3d_mm": found.rms_3d_mm,
        "covariance_mm2": found.tip_covariance_mm2.tolist(),
        "used": int(found.used.sum()),
        "rejected": len(found.rejected),
        "tilt_range_deg": turning.tilt_range_deg,
        "tilt_range_across_deg": turning.tilt_range_across_deg,
        "spin_range_deg": turning.spin_range_deg,
        "min_rotation_deg": turning.min_rotation_deg,
        "rms_3d_of_all_mm": found.rms_3d_of_all_mm,
        "pivot_covariance_mm2": found.pivot_covariance_mm2.tolist(),
        "tip_sd_mm": found.tip_sd_mm,
        "rejected_poses": _rejected(found.rejected, files, "off_mm"),
        **_files(files),
        "written": None if written is None else str(written),
        "gate": {"max_rms_3d_mm": gate.max_rms_3d_mm, "max_tip_sd_mm": gate.max_tip_sd_mm},
    }
    return Report(lines=lines, values=values, failures=failures)


def spin_report(
    found: SpinCalibration,
    failures: Sequence[CalibrationError],
    files: PoseFiles,
    written: Path | None,
    gate: ToolGate,
) -> Report:
    """Return the report of `coaxial spin`."""
    sign = "towards the tip" if found.points_to_tip else "sign unknown: give --tool or --tip-mm"
    lines = [
        f"Axis in the marker's frame: {_point(found.axis_in_marker, 4)} ({sign}), "
        f"sd {found.axis_sd_deg:.3f} deg, allowed {gate.max_axis_sd_deg:g} deg",
        f"Spun by {found.spin_range_deg:.0f} deg, wobble of the axis {found.wobble_deg:.2f} deg (RMS)",
        _used_line(int(found.used.sum()), found.rejected, files, "deg off the axis"),
        *_written_line(written),
    ]
    values = {
        "axis_in_marker": found.axis_in_marker.tolist(),
        "points_to_tip": found.points_to_tip,
        "axis_sd_deg": found.axis_sd_deg,
        "covariance_rad2": found.axis_covariance_rad2.tolist(),
        "spin_range_deg": found.spin_range_deg,
        "wobble_deg": found.wobble_deg,
        "used": int(found.used.sum()),
        "rejected": len(found.rejected),
        "rejected_poses": _rejected(found.rejected, files, "off_deg"),
        **_files(files),
        "written": None if written is None else str(written),
        "gate": {"max_axis_sd_deg": gate.max_axis_sd_deg},
    }
    return Report(lines=lines, values=values, failures=failures)


def check_report(
    found: TipCheck, failures: Sequence[CalibrationError], files: PoseFiles, gate: ToolGate
) -> Report:
    """Return the report of `coaxial tip-check`."""
    lines = [
        f"The tip moves by {found.rms_3d_mm:.3f} mm (3-D RMS, allowed {gate.max_rms_3d_mm:g}), "
        f"{found.max_mm:.3f} mm at most, by axis {_point(found.rms_by_axis_mm, 3)} mm, "
        f"in {found.poses} poses",
        _motion_range_line(found.motion_range),
    ]
    values = {
        "rms_3d_mm": found.rms_3d_mm,
        "max_mm": found.max_mm,
        "rms_by_axis_mm": found.rms_by_axis_mm.tolist(),
        "pivot_mm": found.pivot_in_camera_mm.tolist(),
        "used": found.poses,
        "tilt_range_deg": found.motion_range.tilt_range_deg,
        "tilt_range_across_deg": found.motion_range.tilt_range_across_deg,
        "spin_range_deg": found.motion_range.spin_range_deg,
        **_files(files),
        "gate": {"max_rms_3d_mm": gate.max_rms_3d_mm},
    }
    return Report(lines=lines, values=values, failures=failures)


def _failure(error: CalibrationError) -> dict[str, str]:
    return {"code": error.code, "message": error.message, "remedy": error.remedy}


def _rejected(rejected: Sequence[RejectedPose], files: PoseFiles, off: str) -> list[dict[str, Any]]:
    return [
        {"pose": files.records[one.index].place, "reason": one.reason.value, off: one.off} for one in rejected
    ]


def _files(files: PoseFiles) -> dict[str, Any]:
    return {
        "poses": len(files.records),
        "unseen_images": files.unseen,
        "ignored_files": list(files.ignored),
    }


def _used_line(used: int, rejected: Sequence[RejectedPose], files: PoseFiles, off: str) -> str:
    line = f"Used {used} of {len(files.records)} poses"
    if rejected:
        named = [
            f"{files.records[one.index].place} ({one.reason.value}, {one.off:.2f} {off})"
            for one in rejected[:MAX_LISTED]
        ]
        more = f" and {len(rejected) - MAX_LISTED} more" if len(rejected) > MAX_LISTED else ""
        line += "; rejected: " + ", ".join(named) + more
    return line


def _motion_range_line(turning: ToolMotionRange) -> str:
    return (
        f"Tilted by {turning.tilt_range_deg:.0f} deg and by {turning.tilt_range_across_deg:.0f} deg across, "
        f"spun by {turning.spin_range_deg:.0f} deg"
    )


def _written_line(written: Path | None) -> list[str]:
    return [] if written is None else [f"Wrote {written}. Add it to the settings as tools.NAME.calibration."]


def _point(numbers: Any, digits: int = 2) -> str:  # noqa: ANN401  any three numbers
    return ", ".join(f"{number:.{digits}f}" for number in numbers)
