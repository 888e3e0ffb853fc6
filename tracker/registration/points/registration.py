"""Point-based registration: landmarks of the plan against captured tip positions."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.errors import RegistrationError
from tracker.geometry import (
    Anchor,
    Array,
    Rigid,
    Vertebra,
    inverse_covariance,
    inverse_jacobian,
    point_covariance_mm2,
)
from tracker.plan.remark import Remark
from tracker.registration.points.correspondence import reject_swapped_or_mirrored
from tracker.registration.points.fit import fit_rigid, fit_rigid_weighted
from tracker.registration.points.pairs import PointPairs
from tracker.registration.points.rejections import MIN_POINTS, reject_unfit, scale_ratio
from tracker.registration.points.settings import PointGate, PointSettings
from tracker.registration.points.uncertainty import (
    common_tip_jacobian,
    covariance_from_noise,
    covariance_from_residuals,
    expected_tre_mm,
    fle_from_fre_mm,
)
from tracker.registration.record import AnchoredTo, Method, Registration

# A scale that differs by less is no news to anybody, whatever the noise.
MIN_SCALE_DIFFERENCE = 0.02
MIN_SCALE_SDS = 4.0
# Each asks for a fit of its own; of hundreds, a single one decides nothing.
MAX_LEAVE_ONE_OUT = 200


@dataclass(frozen=True, slots=True, kw_only=True)
class PointRegistration:
    """Result of a point-based registration.

    Attributes:
        pairs: all points, used or not.
        used: (n,) which of them were fitted.
        fixed_from_moving: from the anchor frame to the CT.
        covariance: (6, 6) of it [mm, rad], translation first, then a small left-multiplied rotation vector on
            the CT axes.
        tip_jacobian: (6, 3), derivative with respect to the common tip; 0 if not known.
        residuals_mm: (n, 3) transformed tip minus landmark on the CT, including unused points.
        fre_rms_mm: fiducial registration error: RMS residual length of the used points.
        fle_mm: fiducial localisation error (3-D RMS) estimated from these residuals.
        settings: of the fit.
        scale_ratio: size of the points on the CT relative to their size as captured.
        remarks: such as a swap that would not be detected.
    """

    pairs: PointPairs
    used: npt.NDArray[np.bool_]
    fixed_from_moving: Rigid[Vertebra, Anchor]
    covariance: Array
    tip_jacobian: Array
    residuals_mm: Array
    fre_rms_mm: float
    fle_mm: float
    settings: PointSettings
    scale_ratio: float
    remarks: tuple[Remark, ...]

    @property
    def distances_mm(self) -> Array:
        """(n,) distance of each transformed tip from its landmark."""
        return np.asarray(np.linalg.norm(self.residuals_mm, axis=1))

    @property
    def leave_one_out_mm(self) -> Mapping[int, float]:
        """By index, the distance of a used point from its landmark when fitted without it.

        Missing for a point without which the others are too few or collinear, and for more than 200 points.
        Fits again for each point.
        """
        chosen = [int(index) for index in np.flatnonzero(self.used)]
        return _leave_one_out_mm(self.pairs, chosen, self.settings)

    def tre_expected_mm(self, target_mm: npt.ArrayLike) -> float:
        """Return the expected TRE (3-D RMS) at a target (3,) on the CT, by Fitzpatrick's formula."""
        target = np.asarray(target_mm, dtype=np.float64)
        return expected_tre_mm(self.pairs.fixed_mm[self.used], self.fle_mm, target)

    def target_covariance_mm2(self, target_mm: npt.ArrayLike) -> Array:
        """Return the covariance (3, 3), on the CT axes, of a target (3,) on the CT."""
        target_in_moving = self.fixed_from_moving.inverse.move_points(target_mm)
        return point_covariance_mm2(self.fixed_from_moving, self.covariance, target_in_moving)

    def tre_stated_mm(self, target_mm: npt.ArrayLike) -> float:
        """Return the stated TRE (3-D RMS) at a target (3,) on the CT; larger than expected for few points."""
        return float(np.sqrt(np.trace(self.target_covariance_mm2(target_mm))))

    def registration(self, anchored_to: AnchoredTo) -> Registration:
        """Return the record that navigation uses."""
        return Registration(
            method=Method.POINTS,
            anchored_to=anchored_to,
            anchor_from_vertebra=self.fixed_from_moving.inverse,
            covariance=inverse_covariance(self.fixed_from_moving, self.covariance),
            tip_jacobian=inverse_jacobian(self.fixed_from_moving) @ self.tip_jacobian,
            tool="" if self.pairs.common is None else self.pairs.common.tool,
        )

    def failures(self, gate: PointGate, targets_mm: Sequence[npt.ArrayLike]) -> tuple[RegistrationError, ...]:
        """Return the errors that prevent its use for these targets on the CT; empty if it passes."""
        found = []
        if not self.fre_rms_mm <= gate.max_fre_mm:
            worst = int(np.argmax(np.where(self.used, self.distances_mm, -1.0)))
            found.append(
                RegistrationError(
                    "POINTS_FIT_TOO_LARGE",
                    f"landmarks fit to {self.fre_rms_mm:.2f} mm RMS, allowed {gate.max_fre_mm:.2f} mm; "
                    f"point {self.pairs.labels[worst]} is off by {self.distances_mm[worst]:.2f} mm",
                    "Touch that landmark again, or leave it out, then register again.",
                    {"fre_rms_mm": self.fre_rms_mm, "allowed_mm": gate.max_fre_mm},
                )
            )
        stated = max((self.tre_stated_mm(target) for target in targets_mm), default=0.0)
        if not stated <= gate.max_tre_mm:
            found.append(
                RegistrationError(
                    "POINTS_TARGET_UNCERTAIN",
                    f"at the target the registration is known to {stated:.2f} mm (3-D RMS), "
                    f"allowed {gate.max_tre_mm:.2f} mm",
                    "Add landmarks, farther apart and around the target, then register again.",
                    {"tre_stated_mm": stated, "allowed_mm": gate.max_tre_mm},
                )
            )
        return tuple(found)


def register_points(
    pairs: PointPairs, *, excluded: Collection[int] = (), settings: PointSettings | None = None
) -> PointRegistration:
    """Fit the rigid transform from captured tips to landmarks on the CT, with its covariance.

    If the tips state covariances, the fit is weighted by them and the minimum localisation error; otherwise
    unweighted. `excluded`: indices of points to ignore.

    Raises:
        RegistrationError: POINTS_TOO_FEW, POINTS_UNIT_SUSPECT, POINTS_COINCIDENT, POINTS_COLLINEAR,
            POINTS_SWAPPED, POINTS_MIRRORED, POINTS_AMBIGUOUS.
    """
    settings = settings or PointSettings()
    chosen = [index for index in range(len(pairs)) if index not in set(excluded)]
    used = pairs.of(chosen)
    reject_unfit(used, settings)
    plain = fit_rigid(used.fixed_mm, used.moving_mm)
    plain_fre = _rms(plain.move_points(used.moving_mm) - used.fixed_mm)
    remarks = reject_swapped_or_mirrored(used, plain_fre, settings)
    fit, covariance = _fitted(used, settings)
    slope = _tip_jacobian(used, fit, settings)
    if used.common is not None:
        covariance = covariance + slope @ used.common.covariance_mm2 @ slope.T
    residuals = fit.move_points(pairs.moving_mm) - pairs.fixed_mm
    fre = _rms(residuals[chosen])
    fle = fle_from_fre_mm(fre, len(used))
    mask = np.zeros(len(pairs), dtype=np.bool_)
    mask[chosen] = True
    for array in (mask, covariance, residuals, slope):
        array.setflags(write=False)
    return PointRegistration(
        pairs=pairs,
        used=mask,
        fixed_from_moving=fit,
        covariance=covariance,
        tip_jacobian=slope,
        residuals_mm=residuals,
        fre_rms_mm=fre,
        fle_mm=fle,
        settings=settings,
        scale_ratio=scale_ratio(used),
        remarks=(*remarks, *_scale_remarks(used, fle)),
    )


def _fitted(used: PointPairs, settings: PointSettings) -> tuple[Rigid[Vertebra, Anchor], Array]:
    if used.moving_covariances_mm2 is None:
        fit = fit_rigid(used.fixed_mm, used.moving_mm)
        covariance = covariance_from_residuals(
            fit, used.fixed_mm, used.moving_mm, min_fle_mm=settings.min_fle_mm
        )
        return fit, covariance
    noise = _noise(used.moving_covariances_mm2, settings)
    fit = fit_rigid_weighted(used.fixed_mm, used.moving_mm, noise)
    return fit, covariance_from_noise(fit, used.fixed_mm, used.moving_mm, noise)


def _noise(stated_mm2: Array, settings: PointSettings) -> Array:
    return np.asarray(stated_mm2 + settings.min_fle_mm**2 / 3.0 * np.eye(3))


def _tip_jacobian(used: PointPairs, fit: Rigid[Vertebra, Anchor], settings: PointSettings) -> Array:
    if used.common is None:
        return np.zeros((6, 3))
    stated = used.moving_covariances_mm2
    # As in the fit: unweighted without covariances.
    noise = np.tile(np.eye(3), (len(used), 1, 1)) if stated is None else _noise(stated, settings)
    return common_tip_jacobian(fit, used.moving_mm, noise, used.common.anchor_from_marker)


def _leave_one_out_mm(pairs: PointPairs, chosen: Sequence[int], settings: PointSettings) -> dict[int, float]:
    found: dict[int, float] = {}
    if not MIN_POINTS < len(chosen) <= MAX_LEAVE_ONE_OUT:
        return found
    for index in chosen:
        others = pairs.of([one for one in chosen if one != index])
        try:
            reject_unfit(others, settings)
        except RegistrationError:
            # The others alone determine no transform.
            continue
        fit = _fitted(others, settings)[0]
        off = fit.move_points(pairs.moving_mm[index]) - pairs.fixed_mm[index]
        found[index] = float(np.linalg.norm(off))
    return found


def _scale_remarks(used: PointPairs, fle_mm: float) -> tuple[Remark, ...]:
    ratio = scale_ratio(used)
    spread = float(np.sqrt(((used.fixed_mm - used.fixed_mm.mean(axis=0)) ** 2).sum()))
    # The scale's share of the residuals is taken out, or it would excuse itself.
    noise = np.sqrt(
        max(fle_mm**2 * (len(used) - 2) - ((ratio - 1.0) * spread) ** 2, 0.0) / (3 * len(used) - 6)
    )
    if abs(ratio - 1.0) <= max(MIN_SCALE_DIFFERENCE, MIN_SCALE_SDS * noise / spread):
        return ()
    larger = "larger" if ratio < 1.0 else "smaller"
    return (
        Remark(
            code="POINTS_SCALE_DIFFERS",
            message=f"as touched the points are {abs(1.0 / ratio - 1.0):.1%} {larger} than on the CT",
            remedy="Measure the printed marker's side again and check the camera with 'coaxial accuracy'.",
            context={"scale_ratio": ratio},
        ),
    )


def _rms(residuals: Array) -> float:
    return float(np.sqrt((residuals**2).sum(axis=1).mean()))
