"""`coaxial time-offset`: estimate the offset between the clocks of two pose files."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from server.cli.tool_report import Report, print_report
from server.pose_file import PoseFiles, Unit, read_poses
from tracker.errors import CalibrationError
from tracker.pose.temporal_calibration import (
    Motion,
    TimeOffset,
    TimeOffsetLimits,
    calibrate_time_offset,
)

FAILED = 1
UNIT = {Motion.ROTATION: "deg/s", Motion.TRANSLATION: "mm/s"}
VARIATION_KEY = {Motion.ROTATION: "variation_deg_s", Motion.TRANSLATION: "variation_mm_s"}


@dataclass(frozen=True, slots=True, kw_only=True)
class TimeOffsetOptions:
    """Options of `coaxial time-offset`; pairs are (first, second)."""

    files: tuple[Path, Path]
    markers: tuple[str | None, str | None]
    units: tuple[str, str]
    motion: str
    max_offset_s: float


def calibrate(options: TimeOffsetOptions, *, as_json: bool) -> int:
    """Estimate and print the offset. Return the exit status: 0, or 1 if the recordings do not determine it.

    Raises:
        InvalidInput: a file cannot be read or contains no times.
    """
    limits = TimeOffsetLimits(max_offset_s=options.max_offset_s)
    motion = Motion(options.motion)
    first, second = (
        read_poses(path, unit=Unit(unit), marker=marker)
        for path, unit, marker in zip(options.files, options.units, options.markers, strict=True)
    )
    try:
        found = calibrate_time_offset(
            first.series(str(options.files[0])),
            second.series(str(options.files[1])),
            motion=motion,
            limits=limits,
        )
    except CalibrationError as error:
        report = _report(options, (first, second), limits, None, error)
    else:
        report = _report(options, (first, second), limits, found, None)
    print_report(report, as_json=as_json)
    return FAILED if report.failures else 0


def _report(
    options: TimeOffsetOptions,
    files: tuple[PoseFiles, PoseFiles],
    limits: TimeOffsetLimits,
    found: TimeOffset | None,
    error: CalibrationError | None,
) -> Report:
    sources: list[dict[str, Any]] = [
        {"file": str(path), "poses": len(one.records), "unseen_images": one.unseen}
        for path, one in zip(options.files, files, strict=True)
    ]
    lines = []
    if found is not None:
        for at, source in enumerate(sources):
            source |= {
                "used": found.samples[at],
                "segments": found.segments[at],
                "rate_hz": found.rates_hz[at],
                VARIATION_KEY[found.motion]: found.variation[at],
            }
        lines = _lines(found, sources)
    values = {
        "offset_s": None if found is None else found.offset_s,
        "sd_s": None if found is None else found.sd_s,
        "correlation_ratio": None if found is None else found.correlation_ratio,
        "second_peak_ratio": None if found is None else found.second_peak_ratio,
        "change_s": None if found is None else found.change_s,
        "overlap_s": None if found is None else found.overlap_s,
        "motion": options.motion,
        "first": sources[0],
        "second": sources[1],
        "gate": asdict(limits),
    }
    return Report(lines=lines, values=values, failures=() if error is None else (error,))


def _lines(found: TimeOffset, sources: list[dict[str, Any]]) -> list[str]:
    first, second = (source["file"] for source in sources)
    later, earlier = (first, second) if found.offset_s >= 0.0 else (second, first)
    unit = UNIT[found.motion]
    return [
        f"Offset: {found.offset_s * 1000.0:+.2f} ms (sd {found.sd_s * 1000.0:.2f} ms): "
        f"time stamps of {later} are later than those of {earlier}",
        f"Add {found.offset_s:+.5f} s to the times of {second} to convert them to those of {first}",
        f"Correlation of the {found.motion.value} rates: {found.correlation_ratio:.3f}, at the next peak "
        f"{found.second_peak_ratio:.2f} of it; the second half of the recording differs by "
        f"{found.change_s * 1000.0:+.2f} ms",
        f"Overlap of the recordings: {found.overlap_s:.1f} s",
        *(
            f"Used {source['used']} of {source['poses']} poses of {source['file']} at "
            f"{source['rate_hz']:.1f} Hz, segments without gaps: {source['segments']}, "
            f"varying by {variation:.0f} {unit} (RMS)"
            for source, variation in zip(sources, found.variation, strict=True)
        ),
    ]
