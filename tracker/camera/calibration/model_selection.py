"""Select the number of lens coefficients by cross-validation.

Five coefficients are used unless four or eight have a clearly smaller error on held-out views: an omitted
coefficient is assumed to be zero, an unnecessary one only widens the confidence intervals, and eight
extrapolate badly beyond the points. For some lenses this costs a hundredth of a pixel.
"""

from collections.abc import Sequence

import numpy as np

from tracker.camera.calibration.fit import MODELS, board_pose, fit_camera, projected
from tracker.camera.calibration.report import ModelChoice
from tracker.camera.detection.view import BoardView
from tracker.camera.plausibility import implausibility_of
from tracker.errors import CalibrationError
from tracker.geometry import Array

USUAL = 5
MIN_VIEWS = 5
MAX_FOLDS = 5
# Required relative decrease of the held-out error for fewer or more coefficients than usual. The usual model
# contains the simpler one and costs little, while unnecessary coefficients extrapolate badly.
SIMPLER_BY, RICHER_BY = 0.005, 0.02
# A single outlier must not select the model.
MAX_POINT_SDS = 6.0


def choose_model(views: Sequence[BoardView], size_wh_px: tuple[int, int]) -> ModelChoice:
    """Return the choice of 4, 5 or 8 coefficients; 8 only if plausible up to the corners of the image."""
    if len(views) < MIN_VIEWS:
        few = 4 if len(views) < 3 else USUAL
        return ModelChoice(
            coefficients=few,
            held_out_rms_px=(),
            reason=f"{few} without a trial: {len(views)} views, to hold some out takes {MIN_VIEWS}",
        )
    rms = {model: held_out_rms_px(views, size_wh_px, model) for model in MODELS}
    reported = tuple((model, px) for model, px in rms.items() if np.isfinite(px))
    usual = rms[USUAL]
    if rms[8] < (1.0 - RICHER_BY) * min(usual, rms[4]) and _is_plausible(views, size_wh_px):
        return ModelChoice(
            coefficients=8,
            held_out_rms_px=reported,
            reason=f"8 describe views held out to {rms[8]:.3f} px, 5 to {usual:.3f} px",
        )
    if rms[4] < (1.0 - SIMPLER_BY) * usual:
        return ModelChoice(
            coefficients=4,
            held_out_rms_px=reported,
            reason=f"4 describe views held out to {rms[4]:.3f} px, 5 only to {usual:.3f} px",
        )
    return ModelChoice(
        coefficients=USUAL,
        held_out_rms_px=reported,
        reason=f"5 describe views held out to {usual:.3f} px, 4 to {rms[4]:.3f} px, 8 to {rms[8]:.3f} px",
    )


def held_out_rms_px(views: Sequence[BoardView], size_wh_px: tuple[int, int], model: int) -> float:
    """Return the RMS error on held-out views, to which only the board's pose is fitted."""
    folds = min(MAX_FOLDS, len(views))
    squares: list[Array] = []
    for fold in range(folds):
        seen = [view for index, view in enumerate(views) if index % folds != fold]
        try:
            fit = fit_camera(seen, size_wh_px, model)
        except CalibrationError:
            return float("inf")
        for view in views[fold::folds]:
            pose = board_pose(view, fit.matrix, fit.distortion)
            if pose is None:
                return float("inf")
            off = view.image_points_px - projected(view.object_points_mm, *pose, fit.matrix, fit.distortion)
            squares.append((off**2).sum(axis=1))
    together = np.concatenate(squares)
    limit = MAX_POINT_SDS**2 * float(np.median(together)) / (2.0 * np.log(2.0))
    return float(np.sqrt(np.minimum(together, limit).mean()))


def _is_plausible(views: Sequence[BoardView], size_wh_px: tuple[int, int]) -> bool:
    """Return whether a lens can have the 8 coefficients that fit best."""
    try:
        fit = fit_camera(views, size_wh_px, 8)
    except CalibrationError:
        return False
    return implausibility_of(fit.matrix, fit.distortion, size_wh_px) is None
