"""Diagnosis of systematic faults: print scale, tip offset, focal length.

Each fault moves the measured tips in its own way. A plate that is printed too small scales the distances in
its plane. An offset of the tip follows the orientation of the tool. A wrong focal length scales depths, and
tilts markers away from the centre of the image, so that it shows where plate or tool extend in depth. All
are estimated together with the pose of the plate at each placement, by generalised least squares, and the
variance of the residuals is estimated from the residuals. What the captures do not tell apart has a large
standard deviation in this joint estimate, however well one fault alone would fit.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import scipy

from tracker.accuracy.marker_geometry import TipSensitivity, TrackedTool, tip_sensitivity
from tracker.accuracy.plate import DivotPlate
from tracker.accuracy.plate_fit import PlateFit
from tracker.geometry import Array

# A false alarm in 1 of 1000 tests for each fault.
FALSE_ALARM = 1e-3
# Lower bound of the noise of a capture: a tip is not a point, and a divot has play.
MIN_SD_MM = 0.05


class Fault(StrEnum):
    """A systematic fault."""

    SCALE = "scale"
    TIP_OFFSET = "tip_offset"
    FOCAL_LENGTH = "focal_length"


COLUMNS = {Fault.SCALE: (0,), Fault.TIP_OFFSET: (1, 2, 3), Fault.FOCAL_LENGTH: (4,)}


@dataclass(frozen=True, slots=True, kw_only=True)
class FaultEstimate:
    """Size of one fault, estimated together with the others.

    Attributes:
        fault: the fault.
        value: (1,) or (3,). Scale: measured by stated distances of the plate, minus 1. Focal length: stated
            by true focal length, minus 1. Tip offset: stated minus true tip in the marker's frame, in mm.
        sd: standard deviation of `size`; that of the least certain direction for a tip.
        alone_sd: the same if the other faults were known to be absent.
        p: probability of a value as large as this one without the fault.
    """

    fault: Fault
    value: tuple[float, ...]
    sd: float
    alone_sd: float
    p: float

    @property
    def size(self) -> float:
        """Return the absolute value, or the length of the offset in mm."""
        return float(np.linalg.norm(self.value))

    @property
    def max_size(self) -> float:
        """Return the upper 95 % limit of the size."""
        return self.size + float(scipy.stats.norm.ppf(0.95)) * self.sd

    @property
    def is_found(self) -> bool:
        """Return whether the fault is significant."""
        return self.p < FALSE_ALARM


@dataclass(frozen=True, slots=True, kw_only=True)
class Diagnosis:
    """Estimates of all faults.

    Attributes:
        estimates: one per fault.
        indistinct: faults of which one is present, but the captures do not tell which; empty otherwise.
        noise_ratio: standard deviation of the residuals by the stated one.
    """

    estimates: tuple[FaultEstimate, ...]
    indistinct: tuple[Fault, ...]
    noise_ratio: float

    def of(self, fault: Fault) -> FaultEstimate:
        """Return the estimate of one fault."""
        return next(one for one in self.estimates if one.fault is fault)

    @property
    def found(self) -> tuple[FaultEstimate, ...]:
        """Return the faults that are present, the most significant first."""
        return tuple(sorted((one for one in self.estimates if one.is_found), key=lambda one: one.p))


@dataclass(frozen=True, slots=True)
class _Fitted:
    value: Array
    covariance: Array
    chi2: float
    freedom: int


def diagnose(
    fit: PlateFit, plate: DivotPlate, tool: TrackedTool, *, plate_scale_sd_ratio: float = 0.0
) -> Diagnosis:
    """Return the estimated faults of a test.

    Args:
        fit: the captures and the poses of the plate.
        plate: the plate.
        tool: camera, marker and tip.
        plate_scale_sd_ratio: standard deviation of the true scale of the plate, as far as it was measured.
    """
    sensitivities = [tip_sensitivity(tool, one.camera_from_marker) for one in fit.captures]
    whitening = _whitening(fit, plate, sensitivities)
    columns = _fault_columns(fit, sensitivities)
    none, joint = (_fitted(fit, columns, whitening, chosen) for chosen in ((), tuple(range(5))))
    # A t or F test with the variance of the joint residuals, which no fault inflates.
    variance = joint.chi2 / joint.freedom
    estimates, adequate = [], []
    for fault, chosen in COLUMNS.items():
        alone = _fitted(fit, columns, whitening, chosen)
        value = joint.value[list(chosen)]
        covariance = variance * joint.covariance[np.ix_(chosen, chosen)]
        alone_covariance = variance * alone.covariance
        if fault is Fault.SCALE:
            covariance = covariance + plate_scale_sd_ratio**2
            alone_covariance = alone_covariance + plate_scale_sd_ratio**2
        statistic = float(value @ np.linalg.solve(covariance, value)) / len(chosen)
        estimates.append(
            FaultEstimate(
                fault=fault,
                value=tuple(map(float, value)),
                sd=float(np.sqrt(np.linalg.eigvalsh(covariance)[-1])),
                alone_sd=float(np.sqrt(np.linalg.eigvalsh(alone_covariance)[-1])),
                p=float(scipy.stats.f.sf(statistic, len(chosen), joint.freedom)),
            )
        )
        rest = (alone.chi2 - joint.chi2) / (5 - len(chosen)) / variance
        if float(scipy.stats.f.sf(rest, 5 - len(chosen), joint.freedom)) >= FALSE_ALARM:
            adequate.append(fault)
    together = float(scipy.stats.f.sf((none.chi2 - joint.chi2) / 5.0 / variance, 5, joint.freedom))
    is_open = together < FALSE_ALARM and not any(one.is_found for one in estimates)
    return Diagnosis(
        estimates=tuple(estimates),
        indistinct=tuple(adequate or COLUMNS) if is_open else (),
        noise_ratio=variance**0.5,
    )


def _fault_columns(fit: PlateFit, sensitivities: Sequence[TipSensitivity]) -> Array:
    """Return the displacements (n, 3, 5) of the tips per unit of each parameter."""
    rotations = np.array([one.camera_from_marker.rotation for one in fit.captures])
    focal = np.array([one.focal_mm for one in sensitivities])
    return np.concatenate([fit.arms_mm[:, :, None], rotations, focal[:, :, None]], axis=2)


def _whitening(fit: PlateFit, plate: DivotPlate, sensitivities: Sequence[TipSensitivity]) -> Array:
    """Return the inverse square roots (n, 3, 3) of the noise of the captures, up to a common factor.

    Without stated covariances they are those of corner noise that gives the observed residuals.
    """
    shapes = np.array([one.covariance_mm2_per_px2 for one in sensitivities])
    stated = [one.covariance_mm2 for one in fit.captures]
    known = np.array([one for one in stated if one is not None])
    if len(known) == len(stated):
        noise = known
    else:
        noise = shapes * float((fit.residuals_mm**2).sum() / np.trace(shapes, axis1=1, axis2=2).sum())
    noise = noise + (MIN_SD_MM**2 + plate.sd_mm**2) * np.eye(3)
    return np.asarray(np.linalg.inv(np.linalg.cholesky(noise)), dtype=float)


def _fitted(fit: PlateFit, columns: Array, whitening: Array, chosen: tuple[int, ...]) -> _Fitted:
    """Fit poses and some of the fault parameters; return the values of the latter."""
    design = np.concatenate([columns[:, :, list(chosen)], fit.pose_jacobian], axis=2)
    flat = (whitening @ design).reshape(-1, design.shape[2])
    target = np.einsum("nij,nj->ni", whitening, fit.residuals_mm).ravel()
    # Columns differ by orders of magnitude (mm per ratio, mm per mm).
    scale = np.linalg.norm(flat, axis=0)
    scale[scale == 0.0] = 1.0
    # A ridge far below the information of a capture keeps what the captures do not determine finite: its
    # standard deviation is then huge, and not zero as with a pseudo-inverse.
    inverse = np.linalg.inv((flat / scale).T @ (flat / scale) + 1e-10 * np.eye(len(scale)))
    x = inverse @ (flat / scale).T @ target / scale
    residual = target - flat @ x
    count = len(chosen)
    covariance = inverse / np.outer(scale, scale)
    return _Fitted(x[:count], covariance[:count, :count], float(residual @ residual), len(target) - len(x))
