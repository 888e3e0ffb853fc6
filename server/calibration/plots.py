"""Plots of a calibration as SVG: residuals, and coverage of the image."""

from collections.abc import Iterator

import numpy as np

from tracker.camera.calibration import CalibrationReport

# Length of the longest usual arrow, relative to the image width.
ARROW_RATIO = 0.03
GRID = (8, 6)
INK, DOT, CELL = "#1d2430", "#c2410c", "#93c5fd"


def residuals_svg(report: CalibrationReport) -> str:
    """Plot the residual of each point as a magnified arrow from the projected to the detected point."""
    used = [view for view in report.views if view.used]
    lengths = np.concatenate([np.linalg.norm(view.residuals_px, axis=1) for view in used])
    usual = max(float(np.percentile(lengths, 95)), 1e-6)
    width = report.camera.size_wh_px[0]
    scale = ARROW_RATIO * width / usual
    title = f"Residuals, {scale:.0f} times enlarged: RMS {report.rms_px:.3f} px in {len(used)} views"

    def arrows() -> Iterator[str]:
        for view in used:
            for (x, y), (dx, dy) in zip(view.image_points_px, view.residuals_px * scale, strict=True):
                yield f'<path d="M{x:.1f} {y:.1f}l{dx:.1f} {dy:.1f}"/>'
                yield f'<circle cx="{x:.1f}" cy="{y:.1f}" r="1.5"/>'

    body = f'<g stroke="{DOT}" stroke-width="{width / 900:.2f}" fill="{INK}">{"".join(arrows())}</g>'
    return _page(report, title, body)


def coverage_svg(report: CalibrationReport) -> str:
    """Plot all points, and the cells of the image that contain any."""
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
    share = 100 * report.coverage.cells_ratio
    body = f'<g fill="{CELL}" fill-opacity="0.5">{filled}</g><g fill="{DOT}">{dots}</g>'
    return _page(report, f"Coverage: points in {share:.0f} % of the cells, {len(used)} views", body)


def _page(report: CalibrationReport, title: str, body: str) -> str:
    width, height = report.camera.size_wh_px
    letter = height / 30
    top, whole = -2 * letter, height + 2 * letter
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 {top:.1f} {width} {whole:.1f}">'
        f'<rect y="{top:.1f}" width="{width}" height="{whole:.1f}" fill="white"/>'
        f'<rect width="{width}" height="{height}" fill="none" stroke="{INK}"/>{body}'
        f'<text y="{-0.6 * letter:.1f}" font-family="sans-serif" font-size="{letter:.1f}">{title}</text>'
        "</svg>\n"
    )
