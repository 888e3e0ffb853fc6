"""Calibration report as JSON-serialisable values."""

import math

from tracker.camera.calibration import CalibrationReport, ViewReport


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
        "warnings": [
            {"code": one.code, "message": one.message, "remedy": one.remedy} for one in report.warnings
        ],
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
