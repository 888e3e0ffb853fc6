"""Camera calibration from views of a board, with a report of its uncertainty."""

from tracker.camera.calibration.board_size import with_board_size_warning
from tracker.camera.calibration.calibrate import CalibrationSettings, calibrate
from tracker.camera.calibration.report import (
    CalibrationReport,
    Coverage,
    ModelChoice,
    ParameterEstimate,
    ViewReport,
)

__all__ = [
    "CalibrationReport",
    "CalibrationSettings",
    "Coverage",
    "ModelChoice",
    "ParameterEstimate",
    "ViewReport",
    "calibrate",
    "with_board_size_warning",
]
