"""Calibrate a camera from views of a board, with a report."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tracker.camera.calibration.blocks import blocks_of
from tracker.camera.calibration.coverage import coverage_of, warnings_of, widest_tilt_deg
from tracker.camera.calibration.fit import MODELS, NAMES, Fit, board_pose, projected
from tracker.camera.calibration.model_selection import choose_model
from tracker.camera.calibration.one_camera import two_camera_warnings
from tracker.camera.calibration.outliers import InlierViews, reject_outlier_points, reject_outlier_views
from tracker.camera.calibration.report import (
    CalibrationReport,
    ModelChoice,
    ParameterEstimate,
    ViewReport,
    rms,
)
from tracker.camera.calibration.uncertainty import Uncertainty, noise_is_correlated, uncertainty
from tracker.camera.calibration.view_checks import PARALLEL_DEG, fault_of, reject_one_pose
from tracker.camera.detection.view import BoardView
from tracker.camera.model import CameraModel
from tracker.camera.plausibility import implausibility_of
from tracker.errors import CalibrationError, InvalidInput, Remark
from tracker.geometry import Array, Camera, Pattern, Rigid

MIN_VIEWS = 3
FIRST_MODEL = 5
MAX_OUT_RATIO = 0.5
MAX_FOCAL_SD_RATIO = 0.1


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationSettings:
    """Settings of a camera calibration.

    Attributes:
        coefficients: 4, 5 or 8 distortion coefficients; None selects the number by cross-validation.
    """

    coefficients: int | None = None


def calibrate(
    views: Sequence[BoardView],
    *,
    size_wh_px: tuple[int, int],
    names: Sequence[str] | None = None,
    settings: CalibrationSettings | None = None,
) -> CalibrationReport:
    """Return the camera calibrated from views of a board, with its uncertainty.

    Views are rejected if their points are in a wrong order or are outliers: beyond three times the median
    error of the views.

    Args:
        views: of one board or of several; each has its own pose.
        size_wh_px: of all images.
        names: of the views, for the report; numbers from 1 if left out.
        settings: None takes the usual ones.

    Raises:
        CalibrationError: TOO_FEW_VIEWS, VIEWS_FROM_ONE_PLACE, VIEWS_ALL_PARALLEL, VIEWS_DISAGREE or
            CALIBRATION_DIVERGED.
        InvalidInput: COEFFICIENTS_INVALID.
    """
    settings = settings or CalibrationSettings()
    _reject_model(settings)
    names = tuple(names) if names is not None else tuple(str(n + 1) for n in range(len(views)))
    faults = [fault_of(view, size_wh_px) for view in views]
    sound = [index for index, fault in enumerate(faults) if not fault]
    _reject_few(len(sound), views, faults)
    usable = [views[index] for index in sound]
    reject_one_pose(usable, size_wh_px)
    first = reject_outlier_views(usable, size_wh_px, FIRST_MODEL)
    choice = _choice(settings, first, size_wh_px)
    retained = reject_outlier_points(usable, first, size_wh_px, choice.coefficients)
    out = {index: fault for index, fault in enumerate(faults) if fault}
    out |= {sound[index]: reason for index, reason in retained.out.items()}
    _reject_disagreement(retained, len(usable))
    blocks = blocks_of(retained.fit, retained.views)
    is_correlated = noise_is_correlated(retained.views, retained.fit.residuals_px, blocks)
    sure = uncertainty(blocks, is_noise_correlated=is_correlated)
    parameters = _parameters(retained.fit, sure)
    camera = CameraModel(
        matrix=retained.fit.matrix, distortion=retained.fit.distortion, size_wh_px=size_wh_px, is_fit=True
    )
    reports = _view_reports(views, names, retained, sound, out)
    _reject_undetermined(reports, parameters)
    coverage = coverage_of(np.concatenate([view.image_points_px for view in retained.views]), size_wh_px)
    return CalibrationReport(
        camera=camera,
        rms_px=rms(np.concatenate(retained.fit.residuals_px)),
        noise_px=sure.noise_px,
        is_noise_correlated=is_correlated,
        parameters=parameters,
        covariance=_read_only(sure.covariance),
        views=reports,
        coverage=coverage,
        choice=choice,
        warnings=two_camera_warnings(retained.fit, blocks, [view.name for view in reports if view.used])
        + warnings_of(reports, parameters, coverage, choice, size_wh_px)
        + _implausible(camera),
    )


def _implausible(camera: CameraModel) -> tuple[Remark, ...]:
    found = implausibility_of(camera.matrix, camera.distortion, camera.size_wh_px)
    if found is None:
        return ()
    return (
        Remark(
            code="LENS_IMPLAUSIBLE",
            message=f"the lens is implausible: {found.message}",
            remedy=found.remedy,
            context={"camera_problem": found.message},
        ),
    )


def _read_only(array: Array) -> Array:
    copied = array.copy()
    copied.setflags(write=False)
    return copied


def _choice(settings: CalibrationSettings, retained: InlierViews, size_wh_px: tuple[int, int]) -> ModelChoice:
    if settings.coefficients is not None:
        return ModelChoice(
            coefficients=settings.coefficients,
            held_out_rms_px=(),
            reason=f"{settings.coefficients} were requested",
        )
    return choose_model(retained.views, size_wh_px)


def _parameters(fit: Fit, sure: Uncertainty) -> tuple[ParameterEstimate, ...]:
    sds = np.sqrt(np.diag(sure.covariance))
    return tuple(
        ParameterEstimate(
            name=name,
            value=float(value),
            sd=float(sd),
            low_95=float(value - reach),
            high_95=float(value + reach),
            degrees_of_freedom=sure.degrees_of_freedom,
        )
        for name, value, sd, reach in zip(
            NAMES[: fit.shared.size], fit.shared, sds, sure.reach_95, strict=True
        )
    )


def _view_reports(
    views: Sequence[BoardView],
    names: Sequence[str],
    retained: InlierViews,
    sound: Sequence[int],
    out: dict[int, str],
) -> tuple[ViewReport, ...]:
    at_of = {sound[index]: at for at, index in enumerate(retained.indexes)}
    sound_at = {index: at for at, index in enumerate(sound)}
    reports = []
    for index, (view, name) in enumerate(zip(views, names, strict=True)):
        at = at_of.get(index)
        if at is not None:
            pose = retained.fit.rotations_rad[at], retained.fit.translations_mm[at]
            shown, residuals = retained.views[at], retained.fit.residuals_px[at]
            dropped = int((~retained.points[sound_at[index]]).sum())
        else:
            found = (
                board_pose(view, retained.fit.matrix, retained.fit.distortion) if index in sound_at else None
            )
            pose = found or (np.zeros(3), np.zeros(3))
            shown, dropped = view, 0
            residuals = np.full((view.ids.size, 2), np.nan)
            if found is not None:
                fit = retained.fit
                residuals = view.image_points_px - projected(
                    view.object_points_mm, *pose, fit.matrix, fit.distortion
                )
        reports.append(_view_report(view, shown, name, out.get(index, ""), pose, residuals, dropped))
    return tuple(reports)


def _view_report(
    view: BoardView,
    shown: BoardView,
    name: str,
    reason: str,
    pose: tuple[Array, Array],
    residuals: Array,
    dropped: int,
) -> ViewReport:
    placed: Rigid[Camera, Pattern] = Rigid.from_vector(*pose)
    middle = placed.rotation @ view.object_points_mm.mean(axis=0) + placed.translation_mm
    return ViewReport(
        name=name,
        used=not reason,
        reason=reason,
        rms_px=rms(residuals),
        points=view.ids.size,
        dropped_points=dropped,
        tilt_deg=float(np.degrees(np.arccos(np.clip(abs(placed.rotation[2, 2]), 0.0, 1.0)))),
        distance_mm=float(np.linalg.norm(middle)),
        camera_from_pattern=placed,
        image_points_px=shown.image_points_px,
        residuals_px=residuals,
    )


def _reject_model(settings: CalibrationSettings) -> None:
    if settings.coefficients not in (None, *MODELS):
        raise InvalidInput(
            "COEFFICIENTS_INVALID",
            f"a lens with {settings.coefficients} coefficients, allowed {', '.join(map(str, MODELS))}",
            "Leave it out to select the number by cross-validation.",
            {"coefficients": settings.coefficients, "allowed": ", ".join(map(str, MODELS))},
        )


def _reject_few(sound: int, views: Sequence[BoardView], faults: Sequence[str]) -> None:
    if sound >= MIN_VIEWS:
        return
    fault = next((fault for fault in faults if fault), "")
    hint = f" (the first that cannot: {fault})" if fault else ""
    raise CalibrationError(
        "TOO_FEW_VIEWS",
        f"{sound} of {len(views)} views of the board can be used, at least {MIN_VIEWS} are needed{hint}",
        "Take 10 to 20 images with the whole board in view, tilted by 20 to 45 deg to different sides.",
        {"views": len(views), "usable": sound, "needed": MIN_VIEWS, "fault_hint": hint},
    )


def _reject_undetermined(reports: Sequence[ViewReport], parameters: Sequence[ParameterEstimate]) -> None:
    """Reject parallel views again with the lens known: lens distortion can look like a tilt before."""
    widest = widest_tilt_deg([view for view in reports if view.used])
    unsure = max(one.sd / one.value for one in parameters if one.name in ("fx", "fy"))
    if widest >= PARALLEL_DEG and unsure <= MAX_FOCAL_SD_RATIO:
        return
    raise CalibrationError(
        "VIEWS_ALL_PARALLEL",
        f"the board's directions differ by {widest:.1f} deg, needed {PARALLEL_DEG:g} deg, and the focal "
        f"length has a standard deviation of {100 * unsure:.1f} %, allowed {100 * MAX_FOCAL_SD_RATIO:.0f} %",
        "Take 10 to 20 views with the board tilted by 20 to 45 deg to different sides, near and far.",
        {
            "tilt_range_deg": widest,
            "focal_sd_ratio": unsure,
            "needed_deg": PARALLEL_DEG,
            "focal_sd_percent": float(100 * unsure),
            "allowed_percent": 100 * MAX_FOCAL_SD_RATIO,
        },
    )


def _reject_disagreement(retained: InlierViews, usable: int) -> None:
    left = len(retained.indexes)
    if left >= MIN_VIEWS and usable - left <= MAX_OUT_RATIO * usable:
        return
    raise CalibrationError(
        "VIEWS_DISAGREE",
        f"{usable - left} of {usable} views do not fit the camera of the others, allowed is half of them",
        "Check columns, rows and layout of the board; zoom and focus must stay the same in all images.",
        {"usable": usable, "used": left, "disagreeing": usable - left},
    )
