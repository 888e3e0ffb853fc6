"""The job functions that fit a camera and its readout time.

Apart from the steps that start them, which load the database: that takes a second of each job.
"""

from dataclasses import asdict

from server.calibration import coverage_svg, report_values, residuals_svg, view_values
from server.jobs import Report
from tracker.camera import Board, CameraModel
from tracker.camera.calibration import calibrate, with_board_size_warning
from tracker.camera.detection import BoardView
from tracker.camera.readout_time import TimedView, estimate_readout


def calibrate_views(
    report: Report,
    *,
    views: tuple[BoardView, ...],
    names: tuple[str, ...],
    size_wh_px: tuple[int, int],
    board: Board,
) -> dict[str, object]:
    """Job: calibrate the camera; return its parameters with the report, and the plots."""
    report(0.1, f"fitting the camera to {len(views)} views")
    fitted = calibrate(views, size_wh_px=size_wh_px, names=names)
    found = with_board_size_warning(fitted, views, board)
    return {
        "report": {**report_values(found), "views": [view_values(view) for view in found.views]},
        "plots": {"residuals": residuals_svg(found), "coverage": coverage_svg(found)},
    }


def fit_readout(report: Report, *, views: tuple[TimedView, ...], camera: CameraModel) -> dict[str, object]:
    """Job: estimate the readout time."""
    report(0.1, f"fitting the readout to {len(views)} images")
    found = estimate_readout(views, camera)
    return {**asdict(found), "used_ms": found.used_ms}
