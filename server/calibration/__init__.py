"""Reports of a camera calibration as values and plots, for the command line and for cases."""

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
