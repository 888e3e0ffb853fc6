"""What a calibration of the camera is told as, values and pictures: on the command line and in cases."""

from server.calibration.accuracy import ROW_COLUMNS, accuracy_rows, accuracy_values
from server.calibration.plots import coverage_svg, residuals_svg
from server.calibration.report import report_values, view_values

__all__ = [
    "ROW_COLUMNS",
    "accuracy_rows",
    "accuracy_values",
    "coverage_svg",
    "report_values",
    "residuals_svg",
    "view_values",
]
