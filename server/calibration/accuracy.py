"""Accuracy check as JSON-serialisable values, in the form of the paper's Table 2."""

from tracker.camera.accuracy import AccuracyReport

ROW_COLUMNS = ("x1_mm", "y1_mm", "x2_mm", "y2_mm", "u1_px", "v1_px", "u2_px", "v2_px")


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
    """Return the rows of Table 2: X1 Y1 X2 Y2 Rd in mm, X1 Y1 X2 Y2 Pd in px, Pd/Rd, measured, error."""
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
