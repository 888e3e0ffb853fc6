"""Report of a camera calibration as tables and as JSON."""

import json
import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from rich.console import Console
from rich.table import Table

from server.calibration import report_values
from server.cli.calibration.images import Unusable
from server.cli.output import remark_text
from tracker.camera.calibration import CalibrationReport, ViewReport
from tracker.camera.detection import BoardNotFound, BoardView

# For each board its view in one image, or why there is none.
Sight: TypeAlias = tuple[BoardView | BoardNotFound | Unusable, ...]
WIDTH_WITHOUT_TERMINAL = 110


@dataclass(frozen=True, slots=True, kw_only=True)
class ImageEntry:
    """Result of one image.

    Attributes:
        image: Name of the image.
        used: Whether the calibration uses at least one board in the image.
        rms_px: RMS over the used points; over all points at the best pose if none is used; NaN without a
            board.
        reason: Why the image, or a part of it, is not used; empty if all of it is used.
        views: Views of the boards in the image.
    """

    image: str
    used: bool
    rms_px: float
    reason: str
    views: tuple[ViewReport, ...]


def entries_of(
    names: Sequence[str],
    seen: Sequence[Sight],
    report: CalibrationReport,
) -> list[ImageEntry]:
    """Return the views of the report grouped by image."""
    reports = iter(report.views)
    entries = []
    for name, found in zip(names, seen, strict=True):
        views = tuple(next(reports) for one in found if isinstance(one, BoardView))
        reasons = [one.reason for one in views if one.reason]
        if not views:
            reasons = [one.sentence for one in found if not isinstance(one, BoardView)]
        counted = [one for one in views if one.used] or list(views)
        entries.append(
            ImageEntry(
                image=name,
                used=any(one.used for one in views),
                rms_px=_together([one.rms_px for one in counted], [len(one.residuals_px) for one in counted]),
                reason="; ".join(reasons),
                views=views,
            )
        )
    return entries


def json_of(
    report: CalibrationReport,
    entries: Sequence[ImageEntry],
    *,
    boards: Sequence[Mapping[str, object]],
    more: Mapping[str, object],
) -> str:
    """Return the report as a JSON object; unknown values are null."""
    whole = {
        **report_values(report),
        "views": [_entry(entry) for entry in entries],
        "views_used": sum(entry.used for entry in entries),
        "boards": list(boards),
        **more,
    }
    return json.dumps(whole, allow_nan=False)


def print_report(report: CalibrationReport, entries: Sequence[ImageEntry], *, max_rms_px: float) -> None:
    """Print the report."""
    console = Console(file=sys.stdout, width=None if sys.stdout.isatty() else WIDTH_WITHOUT_TERMINAL)
    used = sum(entry.used for entry in entries)
    views = Table(title=f"{used} of {len(entries)} images used", title_justify="left")
    for heading in ("image", "RMS px", "points", "dropped", "tilt deg", "distance mm"):
        views.add_column(heading, justify="left" if heading == "image" else "right")
    views.add_column("reason if not used")
    for entry in entries:
        shown = [one for one in entry.views if one.used] or list(entry.views)
        views.add_row(
            entry.image,
            "-" if math.isnan(entry.rms_px) else f"{entry.rms_px:.3f}",
            f"{sum(one.points for one in shown)}" if shown else "-",
            f"{sum(one.dropped_points for one in shown)}" if shown else "-",
            f"{shown[0].tilt_deg:.0f}" if shown else "-",
            f"{shown[0].distance_mm:.0f}" if shown else "-",
            entry.reason,
        )
    console.print(views, markup=False)
    numbers = Table(title="camera parameters", title_justify="left")
    for heading in ("", "value", "sd", "95 % from", "to"):
        numbers.add_column(heading, justify="right")
    for one in report.parameters:
        digits = 2 if one.name[0] in "fc" else 5
        numbers.add_row(
            one.name, *(f"{value:.{digits}f}" for value in (one.value, one.sd, one.low_95, one.high_95))
        )
    console.print(numbers, markup=False)
    for sentence in _sentences(report, max_rms_px):
        console.print(sentence, highlight=False, markup=False)


def _sentences(report: CalibrationReport, max_rms_px: float) -> list[str]:
    coverage = report.coverage
    width, height = report.camera.size_wh_px
    lines = [
        f"RMS {report.rms_px:.3f} px (limit {max_rms_px:g} px), {width}x{height} px, "
        f"fy/fx {report.pixel_aspect_ratio:.4f}.",
        f"Points cover {100 * coverage.cells_ratio:.0f} % of the image cells, and this share of the way to "
        "the corners: "
        + ", ".join(f"{100 * reach:.0f} %" for reach in coverage.corner_reach_ratios)
        + " (clockwise from the top left).",
        f"Lens: {report.choice.coefficients} coefficients; {report.choice.reason}.",
    ]
    if report.is_noise_correlated:
        lines.append(
            "Errors of neighbouring points are correlated; the standard deviations are therefore computed "
            "from the differences between views."
        )
    return lines + [f"Warning: {remark_text(one)}" for one in report.warnings]


def _entry(entry: ImageEntry) -> dict[str, object]:
    return {
        "image": entry.image,
        "used": entry.used,
        "rms_px": None if math.isnan(entry.rms_px) else entry.rms_px,
        "reason": entry.reason,
        "points": sum(one.points for one in entry.views),
        "dropped_points": sum(one.dropped_points for one in entry.views),
        "tilt_deg": entry.views[0].tilt_deg if entry.views else None,
        "distance_mm": entry.views[0].distance_mm if entry.views else None,
    }


def _together(rms_px: Sequence[float], points: Sequence[int]) -> float:
    if not rms_px:
        return math.nan
    return float(np.sqrt(np.average(np.square(rms_px), weights=np.maximum(points, 1))))
