"""Reports of a camera calibration and an accuracy check: values and plots for the command line and cases."""

import math
from collections.abc import Iterator
from fractions import Fraction

import numpy as np

from tracker.camera.accuracy import AccuracyReport
from tracker.camera.calibration import CalibrationReport, ViewReport
from tracker.plan.document import plain

ROW_COLUMNS = ("x1_mm", "y1_mm", "x2_mm", "y2_mm", "u1_px", "v1_px", "u2_px", "v2_px")
# The longest usual arrow, and the longest of the scale, as parts of the image's width.
ARROW_RATIO = 0.03
MAX_SCALE_RATIO = 0.1
# Lengths of the scale in pixels; fractions are written alike in all languages.
SCALES_PX = [*(Fraction(1, parts) for parts in (50, 20, 10, 5, 2)), *map(Fraction, (1, 2, 5, 10, 20, 50))]
GRID = (8, 6)
INK, DOT, CELL = "#1d2430", "#c2410c", "#93c5fd"


def report_values(report: CalibrationReport) -> dict[str, object]:
    """Return the report without its views; unknown values are None."""
    return {
        "rms_px": report.rms_px,
        "matrix": report.camera.matrix.tolist(),
        "distortion": report.camera.distortion.tolist(),
        "size_wh_px": list(report.camera.size_wh_px),
        "noise_px": report.noise_px,
        "noise_is_alike": report.is_noise_correlated,
        "pixel_aspect_ratio": report.pixel_aspect_ratio,
        "parameters": [
            {
                "name": one.name,
                "value": one.value,
                "sd": one.sd,
                "low_95": one.low_95,
                "high_95": one.high_95,
                "degrees_of_freedom": one.degrees_of_freedom,
            }
            for one in report.parameters
        ],
        "covariance": report.covariance.tolist(),
        "coverage": {
            "cells_ratio": report.coverage.cells_ratio,
            "hull_ratio": report.coverage.hull_ratio,
            "corner_reach_ratios": list(report.coverage.corner_reach_ratios),
        },
        "model": {
            "coefficients": report.choice.coefficients,
            "held_out_rms_px": {str(model): rms for model, rms in report.choice.held_out_rms_px},
            "reason": report.choice.reason,
        },
        "warnings": [plain(one) for one in report.warnings],
    }


def view_values(view: ViewReport) -> dict[str, object]:
    """Return the result of one view of the board."""
    return {
        "image": view.name,
        "used": view.used,
        "rms_px": None if math.isnan(view.rms_px) else view.rms_px,
        "reason": view.reason,
        "points": view.points,
        "dropped_points": view.dropped_points,
        "tilt_deg": view.tilt_deg,
        "distance_mm": view.distance_mm,
    }


def accuracy_values(report: AccuracyReport, *, limit_mm: float) -> dict[str, object]:
    """Return the check, and whether it is within its limit."""
    seen = ("pixel_distance_px", "pixels_per_mm", "measured_mm", "error_mm")
    names = (*ROW_COLUMNS[:4], "known_mm", *ROW_COLUMNS[4:], *seen)
    return {
        "passed": report.maximum_error_mm <= limit_mm,
        "limit_mm": limit_mm,
        "maximum_error_mm": report.maximum_error_mm,
        "rms_error_mm": report.rms_error_mm,
        "plane_distance_mm": report.plane_distance_mm,
        "fit_points": report.fit_points,
        "fit_rms_px": report.fit_rms_px,
        "rows": [dict(zip(names, row, strict=True)) for row in accuracy_rows(report)],
    }


def accuracy_rows(report: AccuracyReport) -> list[list[float]]:
    """The rows of the paper's Table 2: X1 Y1 X2 Y2 Rd in mm, X1 Y1 X2 Y2 Pd in px, Pd/Rd, measured, error."""
    of = report.displacements
    return [
        [*first_mm, *second_mm, known, *first_px, *second_px, seen, ratio, measured, error]
        for first_mm, second_mm, known, first_px, second_px, seen, ratio, measured, error in zip(
            of.first_mm.tolist(),
            of.second_mm.tolist(),
            report.known_mm.tolist(),
            of.first_px.tolist(),
            of.second_px.tolist(),
            report.pixel_distances_px.tolist(),
            report.pixels_per_mm.tolist(),
            report.measured_mm.tolist(),
            report.errors_mm.tolist(),
            strict=True,
        )
    ]


def residuals_svg(report: CalibrationReport) -> str:
    """Plot the residual of each point as a magnified arrow from the projected to the detected point.

    A scale shows the magnification. There are no words: the plot is stored, and read in all languages.
    """
    used = [view for view in report.views if view.used]
    lengths = np.concatenate([np.linalg.norm(view.residuals_px, axis=1) for view in used])
    usual = max(float(np.percentile(lengths, 95)), 1e-6)
    width = report.camera.size_wh_px[0]
    scale = ARROW_RATIO * width / usual

    def arrows() -> Iterator[str]:
        for view in used:
            for (x, y), (dx, dy) in zip(view.image_points_px, view.residuals_px * scale, strict=True):
                yield f'<path d="M{x:.1f} {y:.1f}l{dx:.1f} {dy:.1f}"/>'
                yield f'<circle cx="{x:.1f}" cy="{y:.1f}" r="1.5"/>'

    body = f'<g stroke="{DOT}" stroke-width="{width / 900:.2f}" fill="{INK}">{"".join(arrows())}</g>'
    return _page(report, _scale(report, scale) + body)


def _scale(report: CalibrationReport, scale: float) -> str:
    """Arrow of a round length above the image, with its length; nothing if none is short enough."""
    width, height = report.camera.size_wh_px
    fitting = [length for length in SCALES_PX if length * scale <= MAX_SCALE_RATIO * width]
    if not fitting:
        return ""
    length, letter = float(fitting[-1]) * scale, height / 30
    return (
        f'<path d="M0 {-letter:.1f}h{length:.1f}" stroke="{DOT}" stroke-width="{width / 450:.2f}"/>'
        f'<text x="{length + letter / 2:.1f}" y="{-0.6 * letter:.1f}" font-family="sans-serif" '
        f'font-size="{letter:.1f}">{fitting[-1]} px</text>'
    )


def coverage_svg(report: CalibrationReport) -> str:
    """Plot all points, and the cells of the image that contain any; without words."""
    used = [view for view in report.views if view.used]
    points = np.concatenate([view.image_points_px for view in used])
    size = np.array(report.camera.size_wh_px, dtype=np.float64)
    cells = np.unique(np.clip((points / size * GRID).astype(int), 0, np.array(GRID) - 1), axis=0)
    wide, high = size / GRID
    filled = "".join(
        f'<rect x="{x * wide:.1f}" y="{y * high:.1f}" width="{wide:.1f}" height="{high:.1f}"/>'
        for x, y in cells
    )
    dots = "".join(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{size[0] / 400:.1f}"/>' for x, y in points)
    body = f'<g fill="{CELL}" fill-opacity="0.5">{filled}</g><g fill="{DOT}">{dots}</g>'
    return _page(report, body)


def _page(report: CalibrationReport, body: str) -> str:
    width, height = report.camera.size_wh_px
    margin = height / 15
    whole = height + margin
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 {-margin:.1f} {width} {whole:.1f}">'
        f'<rect y="{-margin:.1f}" width="{width}" height="{whole:.1f}" fill="white"/>'
        f'<rect width="{width}" height="{height}" fill="none" stroke="{INK}"/>{body}'
        "</svg>\n"
    )
