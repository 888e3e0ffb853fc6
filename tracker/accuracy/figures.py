"""Figures of accuracy after ASTM F2554 from the residuals of a plate fit, each with its interval.

The poses of the plate are nuisance parameters, so figures are of positions relative to each other in the
working volume, as in navigation, where plan and tool are seen by the same camera. One capture is one sample.
Captures of one divot share its error, and all figures account for that.

A capture is the mean of images, but a single tip is that of one image, as it is displayed: its jitter, which
the mean does not have, is added to the error of a single tip and to the certified error.
"""

from collections import defaultdict
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import numpy.typing as npt
import scipy

from tracker.accuracy.marker_geometry import TrackedTool
from tracker.accuracy.plate import DivotPlate
from tracker.accuracy.plate_fit import POSE_PARAMETERS, PlateFit
from tracker.accuracy.statistics import (
    Estimate,
    JackknifeRms,
    VarianceComponents,
    component_estimate,
    effective_dimension,
    jackknife_rms,
    mean_square_estimate,
    quantile_95_mm,
    rms_estimate,
    share_estimate,
    variance_components,
)
from tracker.geometry import Array


class FigureName(StrEnum):
    """A figure; the ending is its unit."""

    POINT_RMS = "point_rms_mm"
    POINT_BIAS = "point_bias_mm"
    POINT_PRECISION = "point_precision_mm"
    DISTANCE_RMS = "distance_rms_mm"
    REPEATABILITY = "repeatability_mm"
    JITTER = "jitter_mm"
    ORIENTATION_RMS = "orientation_rms_deg"
    ORIENTATION_JITTER = "orientation_jitter_deg"
    INSIDE_STATED = "inside_stated_95_ratio"


@dataclass(frozen=True, slots=True, kw_only=True)
class Figure:
    """A figure with its 95 % confidence interval.

    Attributes:
        name: what it is.
        estimate: value and interval.
        samples: number of captures, distances or repetitions that it is made from.
    """

    name: FigureName
    estimate: Estimate
    samples: int


@dataclass(frozen=True, slots=True, kw_only=True)
class DivotError:
    """The error at one divot of one placement.

    Attributes:
        placement, divot: names.
        bias_mm: distance of the mean tip from the divot.
        spread_mm: RMS distance of single captures from the mean tip, 0 for one capture.
        captures: number of captures.
    """

    placement: str
    divot: str
    bias_mm: float
    spread_mm: float
    captures: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Figures:
    """All figures of a test.

    Attributes:
        figures: those that the captures determine.
        error_95_mm: with a confidence of 95 %, at least 95 % of single tips are at most this far from the
            truth, in each placement. Not less than the 95th percentile of the captures.
        max_distance_error_mm: largest error of a distance between two divots of one placement, with sign.
        divots: errors by placement and divot.
    """

    figures: tuple[Figure, ...]
    error_95_mm: float
    max_distance_error_mm: float
    divots: tuple[DivotError, ...]

    def get(self, name: FigureName) -> Figure | None:
        """Return a figure, or None if the captures do not determine it."""
        return next((one for one in self.figures if one.name is name), None)


def figures_of(fit: PlateFit, plate: DivotPlate, tool: TrackedTool) -> Figures:
    """Return the figures of a test. Needs more captures than divots in every placement."""
    residuals, groups = fit.residuals_mm, fit.group_index
    count = len(residuals)
    found = variance_components_of(fit)
    first, second = _pairs(fit)
    distances = _distance_errors(fit, first, second)
    point = _point(fit, found)
    estimates = {
        FigureName.POINT_RMS: (point.estimate, count),
        FigureName.POINT_BIAS: (component_estimate(found), fit.groups),
        FigureName.POINT_PRECISION: (_precision(fit, found), count),
        FigureName.DISTANCE_RMS: (
            jackknife_rms(
                lambda selected: (
                    float((distances[selected[first] & selected[second]] ** 2).mean()) * _fit_correction(fit)
                ),
                groups,
            ).estimate,
            len(distances),
        ),
        FigureName.ORIENTATION_RMS: (_orientation(fit, tool), count),
        FigureName.JITTER: (
            mean_square_estimate(np.array([np.trace(one.jitter_covariance_mm2) for one in fit.captures])),
            count,
        ),
        FigureName.ORIENTATION_JITTER: (
            mean_square_estimate(np.array([one.jitter_deg**2 for one in fit.captures])),
            count,
        ),
    }
    repeated = _repeatability(fit)
    if repeated is not None:
        estimates[FigureName.REPEATABILITY] = repeated
    inside = inside_stated(fit, plate, tool)
    if inside is not None:
        estimates[FigureName.INSIDE_STATED] = (
            share_estimate(inside, _effective_count(found, count)),
            count,
        )
    return Figures(
        figures=tuple(
            Figure(name=name, estimate=estimates[name][0], samples=estimates[name][1])
            for name in FigureName
            if name in estimates
        ),
        error_95_mm=_error_95_mm(fit),
        max_distance_error_mm=float(distances[np.abs(distances).argmax()]),
        divots=_divot_errors(fit),
    )


def variance_components_of(fit: PlateFit) -> VarianceComponents:
    """Return the variance components between divots and within them."""
    from_fit = POSE_PARAMETERS * len(fit.poses)
    return variance_components(fit.residuals_mm, fit.group_index, fitted_parameters=from_fit)


def inside_stated(fit: PlateFit, plate: DivotPlate, tool: TrackedTool) -> npt.NDArray[np.bool_] | None:
    """Return which tips (n,) are inside their stated 95 % ellipsoid; None without stated covariances.

    The first image of each capture is tested, because the stated covariance is that of one image. The
    covariance of a residual includes that of the fitted pose of the plate, which all captures share, and that
    of the calibrated tip, which turns with the tool.
    """
    stated = [one.covariance_mm2 for one in fit.captures if one.covariance_mm2 is not None]
    count = len(fit.captures)
    if len(stated) < count:
        return None
    errors = np.zeros((3 * count, 3 * count))
    for number, covariance in enumerate(stated):
        rows = slice(3 * number, 3 * number + 3)
        errors[rows, rows] = covariance + plate.sd_mm**2 * np.eye(3)
    turned = np.vstack([one.camera_from_marker.rotation for one in fit.captures])
    errors += turned @ tool.tip_covariance_mm2 @ turned.T
    maker = fit.residual_maker
    of_residuals = maker @ errors @ maker.T
    residuals = [
        residual + one.image_tip_in_camera_mm - one.tip_in_camera_mm
        for one, residual in zip(fit.captures, fit.residuals_mm, strict=True)
    ]
    squares = [
        float(residual @ np.linalg.pinv(of_residuals[3 * n : 3 * n + 3, 3 * n : 3 * n + 3]) @ residual)
        for n, residual in enumerate(residuals)
    ]
    return np.asarray(np.array(squares) <= float(scipy.stats.chi2.ppf(0.95, 3)))


def _point(fit: PlateFit, found: VarianceComponents) -> JackknifeRms:
    """Return the RMS distance of a single tip from the truth.

    The sum of the variance components is too small where all divots have the same postures, and the corrected
    mean of the squared residuals where errors of divots are large: the larger of both is returned.
    """
    jitter = np.array([np.trace(one.averaged_covariance_mm2) for one in fit.captures])
    of_captures = (fit.residuals_mm**2).sum(axis=1)
    squares = of_captures + jitter
    between, within = float(np.trace(found.between_mm2)), float(np.trace(found.within_mm2))
    of_capture = max(
        within + (between - within) / found.size, float(of_captures.mean()) * _fit_correction(fit)
    )
    return jackknife_rms(
        lambda selected: float(squares[selected].mean()),
        fit.group_index,
        value=of_capture + float(jitter.mean()),
        freedom=len(squares) / _fit_correction(fit) * effective_dimension(found.total_mm2),
    )


def _precision(fit: PlateFit, found: VarianceComponents) -> Estimate:
    """Return the pooled RMS distance of single tips from the mean tip of their divot."""
    means = np.array([fit.residuals_mm[fit.group_index == one].mean(axis=0) for one in range(fit.groups)])
    squares = ((fit.residuals_mm - means[fit.group_index]) ** 2).sum(axis=1)

    def mean_square(selected: npt.NDArray[np.bool_]) -> float:
        freedom = int(selected.sum()) - len(np.unique(fit.group_index[selected]))
        return float(squares[selected].sum()) / max(freedom, 1)

    return jackknife_rms(mean_square, fit.group_index, freedom=found.within_freedom).estimate


def _error_95_mm(fit: PlateFit) -> float:
    """Return the tolerance bound of the worst placement.

    Errors grow with the distance from the camera. A bound of all placements together would be exceeded by
    more than 5 % of the tips at the far one.
    """
    return max(_error_95_at_mm(fit, number) for number in range(len(fit.poses)))


def _error_95_at_mm(fit: PlateFit, placement: int) -> float:
    here = fit.placement_index == placement
    residuals = fit.residuals_mm[here]
    _, groups = np.unique(fit.group_index[here], return_inverse=True)
    found = variance_components(residuals, groups, fitted_parameters=POSE_PARAMETERS)
    averaged_mm2 = np.array([fit.captures[n].averaged_covariance_mm2 for n in np.flatnonzero(here)])
    total_mm2 = found.total_mm2 + averaged_mm2.mean(axis=0)
    correction = 3 * len(residuals) / (3 * len(residuals) - POSE_PARAMETERS)
    squares = (residuals**2).sum(axis=1) * correction + np.trace(averaged_mm2, axis1=1, axis2=2)
    rms = jackknife_rms(
        lambda selected: float(squares[selected].mean()),
        groups,
        freedom=len(squares) / correction * effective_dimension(total_mm2),
    )
    if rms.mean_square == 0.0:
        return 0.0
    bound = quantile_95_mm(total_mm2) * rms.upper_95 / rms.estimate.value
    return max(bound, float(np.sqrt(np.quantile(squares, 0.95))))


def _effective_count(found: VarianceComponents, count: int) -> float:
    """Return the number of independent captures with the information of `count` correlated ones."""
    total = float(np.trace(found.total_mm2))
    shared = max(1.0 - float(np.trace(found.within_mm2)) / total, 0.0) if total > 0.0 else 0.0
    return count / (1.0 + (found.size - 1.0) * shared)


def _fit_correction(fit: PlateFit) -> float:
    """Return the factor that corrects squared residuals for the fitted poses."""
    equations = 3 * len(fit.captures)
    return equations / (equations - POSE_PARAMETERS * len(fit.poses))


def _pairs(fit: PlateFit) -> tuple[npt.NDArray[np.int_], npt.NDArray[np.int_]]:
    """Return the index pairs of captures of different divots of the same placement."""
    first, second = np.triu_indices(len(fit.captures), 1)
    chosen = (fit.placement_index[first] == fit.placement_index[second]) & (
        fit.group_index[first] != fit.group_index[second]
    )
    return first[chosen], second[chosen]


def _distance_errors(fit: PlateFit, first: npt.NDArray[np.int_], second: npt.NDArray[np.int_]) -> Array:
    """Return measured minus stated distances (m,) of pairs of captures."""
    tips = np.array([one.tip_in_camera_mm for one in fit.captures])
    divots = tips - fit.residuals_mm
    measured = np.linalg.norm(tips[first] - tips[second], axis=1)
    return np.asarray(measured - np.linalg.norm(divots[first] - divots[second], axis=1))


def _orientation(fit: PlateFit, tool: TrackedTool) -> Estimate:
    """Return the RMS error of the direction from tip to marker, about both axes across it.

    The plate does not show orientations. Residuals across the lever are attributed to the orientation
    entirely, so this is an upper bound; the rotation about the lever is not measured.
    """
    levers = np.array([one.camera_from_marker.rotation @ tool.tip_in_marker_mm for one in fit.captures])
    length = float(np.linalg.norm(tool.tip_in_marker_mm))
    along = (fit.residuals_mm * levers).sum(axis=1) / length
    across = ((fit.residuals_mm**2).sum(axis=1) - along**2) * _fit_correction(fit) / length**2
    across_deg2 = np.maximum(across, 0.0) * np.degrees(1.0) ** 2
    return jackknife_rms(lambda selected: float(across_deg2[selected].mean()), fit.group_index).estimate


def _repeatability(fit: PlateFit) -> tuple[Estimate, int] | None:
    """Return the pooled RMS distance of repeated captures from their mean; None without repetitions."""
    repeated: dict[tuple[str, str, str], list[Array]] = defaultdict(list)
    for capture, residual in zip(fit.captures, fit.residuals_mm, strict=True):
        repeated[*capture.group, capture.posture].append(residual)
    inside = [np.array(one) - np.mean(one, axis=0) for one in repeated.values() if len(one) > 1]
    vectors = sum(len(one) - 1 for one in inside)
    if vectors < 2:
        return None
    stacked = np.vstack(inside)
    covariance = stacked.T @ stacked / vectors
    freedom = vectors * effective_dimension(covariance)
    return rms_estimate(float(np.trace(covariance)), freedom), len(stacked)


def _divot_errors(fit: PlateFit) -> tuple[DivotError, ...]:
    errors = []
    for group in range(fit.groups):
        chosen = fit.group_index == group
        residuals = fit.residuals_mm[chosen]
        mean = residuals.mean(axis=0)
        capture = fit.captures[int(chosen.argmax())]
        errors.append(
            DivotError(
                placement=capture.placement,
                divot=capture.divot,
                bias_mm=float(np.linalg.norm(mean)),
                spread_mm=float(np.sqrt(((residuals - mean) ** 2).sum() / max(len(residuals) - 1, 1))),
                captures=len(residuals),
            )
        )
    return tuple(errors)
