"""Warnings about cameras whose calibration report has poor results."""

import math
from collections.abc import Mapping

import structlog

from server.camera_file import CameraFile, read_camera_file
from server.config import Config
from tracker.camera.calibration.coverage import MAX_FOCAL_SD_WARNING_RATIO, MAX_MIDDLE_SD_WARNING_RATIO
from tracker.photometric import MAX_FOCAL_LENGTH_ERROR_RATIO, FocalLengthError

log = structlog.get_logger(__name__)

REMEDY = (
    "Calibrate the camera again with 10 to 20 sharp views of a flat board, up to the corners of the image."
)

FOCAL_LENGTH_REMEDY = "Check that the prints are flat and the lens as calibrated. Calibrate the camera again."


def warn_of_doubtful_camera(file: CameraFile, *, title: str, max_rms_px: float) -> None:
    """Log a warning if the calibration report of a camera has poor results."""
    doubts = doubts_of(file, max_rms_px=max_rms_px)
    if doubts:
        message = f"the calibration report of {title} has poor results: {'; '.join(doubts)}"
        log.warning(message, code="CAMERA_DOUBTFUL", remedy=REMEDY)


def warn_of_configured_camera(config: Config) -> None:
    """Log the warning for the camera file of the settings, if there is one.

    Raises:
        InvalidInput: as `read_camera_file`.
    """
    path = config.camera.calibration
    if path is not None:
        warn_of_doubtful_camera(
            read_camera_file(path), title=str(path), max_rms_px=config.calibration.max_rms_px
        )


def warn_of_doubtful_focal_length(error: FocalLengthError) -> None:
    """Log a warning if the perspective of the tracked markers contradicts the focal length of the camera."""
    if error.is_doubtful:
        side = "long" if error.ratio > 0.0 else "short"
        message = (
            f"the focal length of the camera file is {abs(error.ratio):.1%} too {side} for the perspective "
            f"of the markers (sd {error.sd:.1%}, allowed {MAX_FOCAL_LENGTH_ERROR_RATIO:.0%}); "
            "all depths are wrong by this share"
        )
        log.warning(message, code="CAMERA_DOUBTFUL", remedy=FOCAL_LENGTH_REMEDY)


def doubts_of(file: CameraFile, *, max_rms_px: float) -> list[str]:
    """Return the poor results in the report of a camera: RMS, standard deviations, warnings."""
    report, doubts = file.report, []
    if "rms_px" in report:
        rms_px = _number(report["rms_px"])
        # An RMS of 0 is implausible, because real points never fit exactly.
        if not 0.0 < rms_px <= max_rms_px:
            doubts.append(f"rms_px is {report['rms_px']}, allowed: above 0 to {max_rms_px:g} px")
    matrix = file.model.matrix
    middle_px = MAX_MIDDLE_SD_WARNING_RATIO * max(file.model.size_wh_px)
    limits = {
        "fx": MAX_FOCAL_SD_WARNING_RATIO * matrix[0, 0],
        "fy": MAX_FOCAL_SD_WARNING_RATIO * matrix[1, 1],
        "cx": middle_px,
        "cy": middle_px,
    }
    for name, sd in _standard_deviations(report).items():
        if name in limits and not 0.0 <= _number(sd) <= limits[name]:
            doubts.append(
                f"the standard deviation of {name} is {sd} px, recommended up to {limits[name]:.1f} px"
            )
    warned = report.get("warnings")
    if isinstance(warned, list) and warned:
        codes = [one.get("code") if isinstance(one, Mapping) else one for one in warned]
        doubts.append(f"it has the warnings {', '.join(map(str, codes))}")
    return doubts


def _standard_deviations(report: Mapping[str, object]) -> Mapping[str, object]:
    """Return the standard deviations by name: `sd` of a camera file, or `parameters` of a case's report."""
    sd, parameters = report.get("sd"), report.get("parameters")
    if isinstance(sd, Mapping):
        return sd
    if not isinstance(parameters, list):
        return {}
    return {str(one.get("name")): one.get("sd") for one in parameters if isinstance(one, Mapping)}


def _number(value: object) -> float:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return float(str(value)) if is_number else math.nan
