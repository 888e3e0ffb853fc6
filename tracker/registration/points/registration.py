"""Point-based registration: landmarks of the plan against captured tip positions."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from tracker.errors import RegistrationError, Remark
from tracker.geometry import (
    Anchor,
    Array,
    Rigid,
    Vertebra,
    inverse_covariance,
    inverse_jacobian,
    point_covariance_mm2,
)
from tracker.registration.points.correspondence import reject_swapped_or_mirrored
from tracker.registration.points.fit import (
    covariance_about_origin,
    fit_rigid,
    fit_rigid_weighted,
    weights_on_ct,
)
from tracker.registration.points.outliers import (
    LeftOut,
    covariance_spanning,
    covariance_with_outlier,
    outlier_remarks,
    undetected_error_mm,
)
from tracker.registration.points.pairs import PointPairs
from tracker.registration.points.rejections import MIN_POINTS, reject_unfit, scale_ratio
from tracker.registration.points.settings import PointGate, PointSettings
from tracker.registration.points.uncertainty import (
    common_tip_jacobian,
    degrees_of_freedom,
    expected_tre_mm,
    factor_ratio_with_more,
    fle_from_fre_mm,
    normal_matrix,
    variance_factor,
    variance_from_residuals_mm2,
    variance_ratio_with_more,
)
from tracker.registration.record import AnchoredTo, Method, Registration

# Minimum relative difference of scale for a remark.
MIN_SCALE_DIFFERENCE = 0.02
MIN_SCALE_SDS = 4.0
# Each needs its own fit, and with more points a single one has little effect.
MAX_LEAVE_ONE_OUT = 200


@dataclass(frozen=True, slots=True, kw_only=True)
class PointRegistration:
    """Result of a point-based registration.

    Attributes:
        pairs: all points, used or not.
        used: (n,) which of them were fitted.
        fixed_from_moving: from the anchor frame to the CT.
        covariance: (6, 6) of it [mm, rad], translation first, then a small left-multiplied rotation vector on
            the CT axes. It includes each gross error of a single landmark that the others do not exclude.
        covariance_without_outlier: (6, 6), the same if no landmark has a gross error.
        tip_jacobian: (6, 3), derivative with respect to the common tip; 0 if not known.
        residuals_mm: (n, 3) transformed tip minus landmark on the CT, including unused points.
        fre_rms_mm: fiducial registration error: RMS residual length of the used points.
        fle_mm: fiducial localisation error (3-D RMS) estimated from these residuals.
        settings: settings of the fit.
        leave_one_out_mm: by index, the distance of a used point from its landmark when fitted without it.
            Missing for a point without which the others are too few or collinear, and for more than 200
            points.
        fre_without_mm: by index, the FRE of the other used points alone. Missing as above.
        undetected_mm: by index, the largest error of a used point that the others do not exclude; infinite if
            they exclude none. Missing for more than 200 points.
        scale_ratio: size of the points on the CT relative to their size as captured.
        remarks: remarks for the user, such as a swap that would not be detected.
    """

    pairs: PointPairs
    used: npt.NDArray[np.bool_]
    fixed_from_moving: Rigid[Vertebra, Anchor]
    covariance: Array
    covariance_without_outlier: Array
    tip_jacobian: Array
    residuals_mm: Array
    fre_rms_mm: float
    fle_mm: float
    settings: PointSettings
    leave_one_out_mm: Mapping[int, float]
    fre_without_mm: Mapping[int, float]
    undetected_mm: Mapping[int, float]
    scale_ratio: float
    remarks: tuple[Remark, ...]

    @property
    def distances_mm(self) -> Array:
        """Return the distance (n,) of each transformed tip from its landmark."""
        return np.asarray(np.linalg.norm(self.residuals_mm, axis=1))

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

    def tre_without_outlier_mm(self, target_mm: npt.ArrayLike) -> float:
        """Return the stated TRE (3-D RMS) at a target (3,) on the CT if no landmark has a gross error."""
        at = self.fixed_from_moving.inverse.move_points(target_mm)
        covariance = point_covariance_mm2(self.fixed_from_moving, self.covariance_without_outlier, at)
        return float(np.sqrt(np.trace(covariance)))

    def covariance_with_more(self, more: int) -> Array:
        """Return the expected covariance (6, 6) of `fixed_from_moving` with more landmarks.

        The additional landmarks have the same spread and noise as these, and none has a gross error. The
        error of the common tip does not decrease.
        """
        of_tip = np.zeros((6, 6))
        if self.pairs.common is not None:
            of_tip = self.tip_jacobian @ self.pairs.common.covariance_mm2 @ self.tip_jacobian.T
        count = int(self.used.sum())
        if self.pairs.moving_covariances_mm2 is None:
            ratio = variance_ratio_with_more(
                self.fre_rms_mm, count, more, min_fle_mm=self.settings.min_fle_mm
            )
        else:
            noise = _noise(self.pairs.of(np.flatnonzero(self.used).tolist()), self.settings)
            ratio = factor_ratio_with_more(
                self.residuals_mm[self.used], weights_on_ct(self.fixed_from_moving, noise), more
            )
        return np.asarray((self.covariance_without_outlier - of_tip) * ratio + of_tip)

    def outliers(self, gate: PointGate) -> tuple[int, ...]:
        """Return the indices of possible outliers, the most likely first; empty if the fit passes.

        The most likely is the point without which the others fit best. With four points, the largest
        leave-one-out residual is that of another point in half of the cases, because the outlier also biases
        the fits without its neighbours. The points without which the others fit almost as well (Fisher's F,
        95 %) may be outliers instead.
        """
        if self.fre_rms_mm <= gate.max_fre_mm and self._max_left_out_mm <= self.settings.max_left_out_mm:
            return ()
        if not self.fre_without_mm:
            return ()
        order = sorted(self.fre_without_mm, key=lambda index: self.fre_without_mm[index])
        others = int(self.used.sum()) - 1
        freedom = degrees_of_freedom(others)
        # An FRE below the localisation error is chance.
        best_mm2 = max(
            self.fre_without_mm[order[0]] ** 2, freedom * self.settings.min_fle_mm**2 / 3.0 / others
        )
        limit_mm = float(np.sqrt(best_mm2 * scipy.special.fdtri(freedom, freedom, 0.95)))
        return tuple(index for index in order if self.fre_without_mm[index] <= limit_mm)

    @property
    def _max_left_out_mm(self) -> float:
        return max(self.leave_one_out_mm.values(), default=0.0)

    def registration(self, anchored_to: AnchoredTo) -> Registration:
        """Return the record that navigation uses."""
        return Registration(
            method=Method.POINTS,
            anchored_to=anchored_to,
            anchor_from_vertebra=self.fixed_from_moving.inverse,
            covariance=inverse_covariance(self.fixed_from_moving, self.covariance),
            tip_jacobian=inverse_jacobian(self.fixed_from_moving) @ self.tip_jacobian,
            tool="" if self.pairs.common is None else self.pairs.common.tool,
            tracking_covariance_mm2=self._tracking_covariance_mm2,
        )

    @property
    def _tracking_covariance_mm2(self) -> Array:
        """Return the covariance (3, 3) of the best captured tip without its calibration; 0 if unknown."""
        stated = self.pairs.moving_covariances_mm2
        # Without a common tip, its calibration is part of what is stated.
        if stated is None or self.pairs.common is None:
            return np.zeros((3, 3))
        return np.asarray(min(stated[self.used], key=np.trace))

    def failures(self, gate: PointGate, targets_mm: Sequence[npt.ArrayLike]) -> tuple[RegistrationError, ...]:
        """Return the errors that prevent its use for these targets on the CT; empty if it passes."""
        found = []
        labels, allowed_mm = self.pairs.labels, self.settings.max_left_out_mm
        outliers = self.outliers(gate)
        names = [labels[index] for index in outliers]
        misfit = self._outlier_text(outliers)
        worst = self._worst()
        named: dict[str, object] = {
            "landmark": names[0] if names else None,
            "possible_outliers": names,
            "without_mm": [self.fre_without_mm[one] for one in outliers],
            "worst": labels[worst],
            "worst_mm": float(self.distances_mm[worst]),
            "misfit": misfit,
        }
        if not self.fre_rms_mm <= gate.max_fre_mm:
            found.append(
                RegistrationError(
                    "POINTS_FIT_TOO_LARGE",
                    f"landmarks fit to {self.fre_rms_mm:.2f} mm RMS, allowed {gate.max_fre_mm:.2f} mm; "
                    f"{misfit}",
                    _outlier_remedy(names),
                    {"fre_rms_mm": self.fre_rms_mm, "allowed_mm": gate.max_fre_mm, **named},
                )
            )
        if not self._max_left_out_mm <= allowed_mm:
            found.append(
                RegistrationError(
                    "POINT_STRAYS",
                    f"a landmark lies {self._max_left_out_mm:.2f} mm from the fit of all others, allowed "
                    f"{allowed_mm:.2f} mm; {misfit}",
                    _outlier_remedy(names),
                    {"leave_one_out_mm": self._max_left_out_mm, "allowed_mm": allowed_mm, **named},
                )
            )
        worst_target = max(targets_mm, key=self.tre_stated_mm, default=None)
        if worst_target is not None and not self.tre_stated_mm(worst_target) <= gate.max_tre_mm:
            stated, alone = self.tre_stated_mm(worst_target), self.tre_without_outlier_mm(worst_target)
            spans = f", or {alone:.2f} mm if no landmark is an outlier" if stated > alone else ""
            found.append(
                RegistrationError(
                    "POINTS_TARGET_UNCERTAIN",
                    f"at the target the registration has an uncertainty of {stated:.2f} mm (3-D RMS), "
                    f"allowed {gate.max_tre_mm:.2f} mm{spans}",
                    "Add landmarks, farther apart and around the target, then register again.",
                    {
                        "tre_stated_mm": stated,
                        "tre_without_outlier_mm": alone,
                        "allowed_mm": gate.max_tre_mm,
                        "outlier_exception": spans,
                    },
                )
            )
        return tuple(found)

    def _worst(self) -> int:
        """Return the index of the used point with the largest residual."""
        return int(np.argmax(np.where(self.used, self.distances_mm, -1.0)))

    def _outlier_text(self, outliers: Sequence[int]) -> str:
        labels = self.pairs.labels
        if not outliers:
            worst = self._worst()
            return f"point {labels[worst]} is off by {self.distances_mm[worst]:.2f} mm"
        fits = [f"without point {labels[one]} to {self.fre_without_mm[one]:.2f} mm" for one in outliers]
        return f"the others fit {', '.join(fits)}"


def _outlier_remedy(outliers: Sequence[str]) -> str:
    if len(outliers) > 1:
        return (
            f"Touch {outliers[0]} again, which is the likeliest; {' or '.join(outliers[1:])} may be mistaken "
            "instead, which another landmark would show."
        )
    return "Touch that landmark again, or leave it out, then register again."


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
    fit, scale = _fitted(used, settings)
    left_out = _left_out(used, settings)
    undetected = _undetected_mm(used, fit, left_out, settings)
    suspects = [index for index, mm in undetected.items() if mm > settings.max_left_out_mm]
    alone, covariance = _covariances(used, fit, scale, {one: left_out.get(one) for one in suspects}, settings)
    slope = _tip_jacobian(used, fit, settings)
    if used.common is not None:
        common = slope @ used.common.covariance_mm2 @ slope.T
        alone, covariance = alone + common, covariance + common
    residuals = fit.move_points(pairs.moving_mm) - pairs.fixed_mm
    fre = _rms(residuals[chosen])
    fle = fle_from_fre_mm(fre, len(used))
    mask = np.zeros(len(pairs), dtype=np.bool_)
    mask[chosen] = True
    for array in (mask, covariance, alone, residuals, slope):
        array.setflags(write=False)
    return PointRegistration(
        pairs=pairs,
        used=mask,
        fixed_from_moving=fit,
        covariance=covariance,
        covariance_without_outlier=alone,
        tip_jacobian=slope,
        residuals_mm=residuals,
        fre_rms_mm=fre,
        fle_mm=fle,
        settings=settings,
        leave_one_out_mm={chosen[index]: one.distance_mm for index, one in left_out.items()},
        fre_without_mm={chosen[index]: one.others_fre_mm for index, one in left_out.items()},
        undetected_mm={chosen[index]: mm for index, mm in undetected.items()},
        scale_ratio=scale_ratio(used),
        remarks=(
            *remarks,
            *_scale_remarks(used, fle),
            *outlier_remarks(used.labels, undetected, suspects, settings.max_left_out_mm),
        ),
    )


def _fitted(used: PointPairs, settings: PointSettings) -> tuple[Rigid[Vertebra, Anchor], float]:
    """Return the fit, and the scale of `_noise` by its residuals."""
    if used.moving_covariances_mm2 is None:
        fit = fit_rigid(used.fixed_mm, used.moving_mm)
        residuals = fit.move_points(used.moving_mm) - used.fixed_mm
        return fit, variance_from_residuals_mm2(residuals, min_fle_mm=settings.min_fle_mm)
    noise = _noise(used, settings)
    fit = fit_rigid_weighted(used.fixed_mm, used.moving_mm, noise)
    residuals = fit.move_points(used.moving_mm) - used.fixed_mm
    return fit, variance_factor(residuals, weights_on_ct(fit, noise))


def _noise(used: PointPairs, settings: PointSettings) -> Array:
    """Return the covariances (n, 3, 3) of the points in the anchor frame, before they are scaled."""
    if used.moving_covariances_mm2 is None:
        return np.tile(np.eye(3), (len(used), 1, 1))
    return np.asarray(used.moving_covariances_mm2 + settings.min_fle_mm**2 / 3.0 * np.eye(3))


def _left_out(used: PointPairs, settings: PointSettings) -> dict[int, LeftOut]:
    found: dict[int, LeftOut] = {}
    if not MIN_POINTS < len(used) <= MAX_LEAVE_ONE_OUT:
        return found
    for index in range(len(used)):
        others = used.of([one for one in range(len(used)) if one != index])
        try:
            reject_unfit(others, settings)
        except RegistrationError:
            # The others alone determine no transform.
            continue
        fit, scale = _fitted(others, settings)
        off = fit.move_points(used.moving_mm[index]) - used.fixed_mm[index]
        found[index] = LeftOut(
            distance_mm=float(np.linalg.norm(off)),
            others_fre_mm=_rms(fit.move_points(others.moving_mm) - others.fixed_mm),
            noise_scale=scale,
        )
    return found


def _undetected_mm(
    used: PointPairs,
    fit: Rigid[Vertebra, Anchor],
    left_out: Mapping[int, LeftOut],
    settings: PointSettings,
) -> dict[int, float]:
    if len(used) > MAX_LEAVE_ONE_OUT:
        return {}
    noise = _noise(used, settings)
    return {
        index: undetected_error_mm(fit, used.moving_mm, noise, index, left_out.get(index))
        for index in range(len(used))
    }


def _covariances(
    used: PointPairs,
    fit: Rigid[Vertebra, Anchor],
    scale: float,
    suspects: Mapping[int, LeftOut | None],
    settings: PointSettings,
) -> tuple[Array, Array]:
    """Return the covariance (6, 6) without a gross error, and the one with those of possible outliers."""
    noise = _noise(used, settings)
    moved = fit.move_points(used.moving_mm)
    middle = moved.mean(axis=0)
    alone = np.asarray(
        np.linalg.inv(normal_matrix(moved - middle, weights_on_ct(fit, scale * noise))), dtype=float
    )
    spanned = [alone]
    for index, one in suspects.items():
        own_scale = scale if one is None else one.noise_scale
        spanned.append(
            covariance_with_outlier(
                fit,
                used.fixed_mm,
                used.moving_mm,
                own_scale * noise,
                index,
                settings.max_left_out_mm,
            )
        )
    return (
        covariance_about_origin(fit, middle, alone),
        covariance_about_origin(fit, middle, covariance_spanning(spanned)),
    )


def _tip_jacobian(used: PointPairs, fit: Rigid[Vertebra, Anchor], settings: PointSettings) -> Array:
    if used.common is None:
        return np.zeros((6, 3))
    return common_tip_jacobian(fit, used.moving_mm, _noise(used, settings), used.common.anchor_from_marker)


def _scale_remarks(used: PointPairs, fle_mm: float) -> tuple[Remark, ...]:
    ratio = scale_ratio(used)
    spread = float(np.sqrt(((used.fixed_mm - used.fixed_mm.mean(axis=0)) ** 2).sum()))
    # The scale error is removed from the residuals, because it would increase its own tolerance.
    noise = np.sqrt(
        max(fle_mm**2 * (len(used) - 2) - ((ratio - 1.0) * spread) ** 2, 0.0) / (3 * len(used) - 6)
    )
    if abs(ratio - 1.0) <= max(MIN_SCALE_DIFFERENCE, MIN_SCALE_SDS * noise / spread):
        return ()
    larger = "larger" if ratio < 1.0 else "smaller"
    difference = abs(1.0 / ratio - 1.0)
    return (
        Remark(
            code="POINTS_SCALE_DIFFERS",
            message=f"as touched the points are {difference:.1%} {larger} than on the CT",
            remedy="Measure the printed marker's side again and check the camera with 'coaxial accuracy'.",
            context={"scale_ratio": ratio, "difference_ratio": difference, "size_comparison": larger},
        ),
    )


def _rms(residuals: Array) -> float:
    return float(np.sqrt((residuals**2).sum(axis=1).mean()))
