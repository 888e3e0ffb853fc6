"""Surface-based registration: fit swept points to the CT's bone surface."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.errors import RegistrationError, Remark
from tracker.geometry import (
    Anchor,
    Array,
    Rigid,
    Vertebra,
    inverse_covariance,
    point_covariance_mm2,
    vector_from_rotation,
)
from tracker.registration.points import PointPairs
from tracker.registration.points.fit import covariance_about_origin, weights_on_ct
from tracker.registration.points.uncertainty import small_sample_factor
from tracker.registration.record import AnchoredTo, Method, Registration
from tracker.registration.surface.closest_points import ClosestPointQuery
from tracker.registration.surface.fit import Sweep, SweepFit, density_weights, equations, evaluate, fit_sweep
from tracker.registration.surface.multi_start import multi_start_fit, reject_ambiguous
from tracker.registration.surface.observability import MotionMode, motion_modes
from tracker.registration.surface.rejections import (
    reject_disagreement,
    reject_far,
    reject_sliding,
    reject_small,
    validate_sweep,
)
from tracker.registration.surface.settings import SurfaceGate, SurfaceSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class SurfaceRegistration:
    """Result of a surface-based registration.

    Attributes:
        fixed_from_moving: from the anchor frame to the CT.
        covariance: (6, 6) of it [mm, rad], translation first, then a small left-multiplied rotation vector on
            the CT axes.
        covariance_expected: (6, 6), the same from the residuals alone, without the lower bound of the noise
            and the inflation for few points.
        off_mm: (n,) signed distance of each swept point from the surface; negative inside.
        used: (n,) inliers.
        used_ratio: ratio of inliers.
        rms_mm: RMS distance of the inliers.
        moved_mm, moved_deg: distance of the fit from its start, at the centroid of the sweep.
        weakest_mode: the motion mode that the sweep alone constrains least.
        remarks: remarks for the user.
    """

    fixed_from_moving: Rigid[Vertebra, Anchor]
    covariance: Array
    covariance_expected: Array
    off_mm: Array
    used: npt.NDArray[np.bool_]
    used_ratio: float
    rms_mm: float
    moved_mm: float
    moved_deg: float
    weakest_mode: MotionMode
    remarks: tuple[Remark, ...]

    def target_covariance_mm2(self, target_mm: npt.ArrayLike) -> Array:
        """Return the covariance (3, 3), on the CT axes, of a target (3,) on the CT."""
        target_in_moving = self.fixed_from_moving.inverse.move_points(target_mm)
        return point_covariance_mm2(self.fixed_from_moving, self.covariance, target_in_moving)

    def tre_expected_mm(self, target_mm: npt.ArrayLike) -> float:
        """Return the expected TRE (3-D RMS) at a target (3,) on the CT, from the residuals alone."""
        at = self.fixed_from_moving.inverse.move_points(target_mm)
        covariance = point_covariance_mm2(self.fixed_from_moving, self.covariance_expected, at)
        return float(np.sqrt(np.trace(covariance)))

    def tre_stated_mm(self, target_mm: npt.ArrayLike) -> float:
        """Return the stated TRE (3-D RMS) at a target (3,) on the CT."""
        return float(np.sqrt(np.trace(self.target_covariance_mm2(target_mm))))

    def registration(self, anchored_to: AnchoredTo) -> Registration:
        """Return the record that navigation uses."""
        return Registration(
            method=Method.SURFACE,
            anchored_to=anchored_to,
            anchor_from_vertebra=self.fixed_from_moving.inverse,
            covariance=inverse_covariance(self.fixed_from_moving, self.covariance),
        )

    def failures(
        self, gate: SurfaceGate, targets_mm: Sequence[npt.ArrayLike]
    ) -> tuple[RegistrationError, ...]:
        """Return the errors that prevent its use for these targets on the CT; empty if it passes."""
        stated = max((self.tre_stated_mm(target) for target in targets_mm), default=0.0)
        checks = (
            ("SURFACE_FIT_TOO_LARGE", "the RMS distance from the bone is", self.rms_mm, gate.max_rms_mm),
            ("SURFACE_TARGET_UNCERTAIN", "the uncertainty at the target is", stated, gate.max_tre_mm),
            ("SURFACE_MOVED_FAR", "the fit moved from its start by", self.moved_mm, gate.max_moved_mm),
        )
        return tuple(
            RegistrationError(
                code,
                f"{words} {value:.2f} mm, allowed {allowed:.2f} mm",
                "Sweep more of the bone, with the tip on bare bone, or touch the landmarks again.",
                {"value_mm": value, "allowed_mm": allowed},
            )
            for code, words, value, allowed in checks
            if not value <= allowed
        )


def register_surface(
    nearest: ClosestPointQuery,
    points_mm: npt.ArrayLike,
    start: Rigid[Vertebra, Anchor],
    *,
    targets_mm: Sequence[npt.ArrayLike] = (),
    landmarks: PointPairs | None = None,
    settings: SurfaceSettings | None = None,
) -> SurfaceRegistration:
    """Fit swept points (n, 3) of the anchor frame to the bone surface, starting from a landmark fit.

    Point-to-plane ICP (Chen and Medioni 1992) with Tukey weights; landmarks, if given, are weighted by their
    covariance. The fit is repeated from other starts, so that a second minimum with a similar cost is
    detected and rejected. `targets_mm`: on the CT, such as entry points; the observability is evaluated
    there.

    Raises:
        RegistrationError: SURFACE_SWEEP_INVALID, SURFACE_SWEEP_SMALL, SURFACE_START_FAR, SURFACE_DISAGREES,
            SURFACE_SLIDES or SURFACE_AMBIGUOUS.
    """
    settings = settings or SurfaceSettings()
    points = validate_sweep(np.asarray(points_mm, dtype=np.float64))
    point_weights = density_weights(points, settings.correlation_length_mm) if len(points) else np.empty(0)
    reject_small(points, point_weights, settings)
    sweep = _sweep(points, point_weights, landmarks, start, settings)
    reject_far(evaluate(nearest, sweep, start), settings)
    targets = np.array([start.move_points(points.mean(axis=0)), *targets_mm], dtype=np.float64).reshape(-1, 3)
    first = fit_sweep(nearest, sweep, start)
    middle = first.fixed_from_moving.move_points(points).mean(axis=0)
    lever = max(float(np.linalg.norm(targets - middle, axis=1).max()), _radius_mm(points))
    alone, with_landmarks = _directions(nearest, sweep, first, middle, lever)
    reject_disagreement(first, sweep, settings)
    reject_sliding(with_landmarks, settings)
    best, alternatives = multi_start_fit(nearest, sweep, start, first, alone.direction, lever, settings)
    reject_disagreement(best, sweep, settings)
    reject_ambiguous(sweep, best, alternatives, targets, settings)
    middle = best.fixed_from_moving.move_points(points).mean(axis=0)
    alone, with_landmarks = _directions(nearest, sweep, best, middle, lever)
    reject_sliding(with_landmarks, settings)
    return _result(nearest, sweep, best, start, alone, settings)


def _sweep(
    points: Array,
    point_weights: Array,
    landmarks: PointPairs | None,
    start: Rigid[Vertebra, Anchor],
    settings: SurfaceSettings,
) -> Sweep:
    fixed, moving, weights = np.empty((0, 3)), np.empty((0, 3)), np.empty((0, 3, 3))
    if landmarks is not None:
        fixed, moving = landmarks.fixed_mm, landmarks.moving_mm
        noise = np.broadcast_to(settings.landmark_sd_mm**2 * np.eye(3), (len(fixed), 3, 3))
        if landmarks.moving_covariances_mm2 is not None:
            noise = landmarks.moving_covariances_mm2 + settings.min_sd_mm**2 * np.eye(3)
        weights = weights_on_ct(start, noise)
    return Sweep(
        points_mm=points,
        point_weights=point_weights,
        landmarks_fixed_mm=fixed,
        landmarks_moving_mm=moving,
        landmark_weights=weights,
        min_sd_mm=settings.min_sd_mm,
        tip_radius_mm=settings.tip_radius_mm,
    )


def _radius_mm(points: Array) -> float:
    return float(np.sqrt(((points - points.mean(axis=0)) ** 2).sum(axis=1).mean()))


def _directions(
    nearest: ClosestPointQuery, sweep: Sweep, laid: SweepFit, middle: Array, lever_mm: float
) -> tuple[MotionMode, MotionMode]:
    """Return the least observable motion mode of the sweep alone, and of sweep and landmarks."""
    smooth = nearest.smooth_normals(laid.nearest_mm)
    alone = equations(sweep, laid, middle, normals=smooth, landmarks=False)[0]
    with_landmarks = equations(sweep, laid, middle, normals=smooth)[0]
    return motion_modes(alone, lever_mm)[0], motion_modes(with_landmarks, lever_mm)[0]


def _result(
    nearest: ClosestPointQuery,
    sweep: Sweep,
    best: SweepFit,
    start: Rigid[Vertebra, Anchor],
    alone: MotionMode,
    settings: SurfaceSettings,
) -> SurfaceRegistration:
    fit, used = best.fixed_from_moving, best.weights > 0.0
    middle_of_sweep = sweep.points_mm.mean(axis=0)
    turned = vector_from_rotation(fit.rotation @ start.rotation.T)
    remarks = []
    if alone.sd_mm > settings.max_slide_sd_mm:
        remarks.append(
            Remark(
                code="SURFACE_CONSTRAINED_BY_LANDMARKS",
                message=f"the sweep can slide {alone.description}; only the landmarks prevent it",
                remedy="Sweep surfaces with other normals too, such as the flanks of the spinous process.",
                context={"direction": alone.description},
            )
        )
    expected, covariance = _covariances(nearest, sweep, best)
    off = np.array(best.off_mm)
    for array in (covariance, expected, off, used):
        array.setflags(write=False)
    weight = sweep.point_weights * used
    moved = fit.move_points(middle_of_sweep) - start.move_points(middle_of_sweep)
    return SurfaceRegistration(
        fixed_from_moving=fit,
        covariance=covariance,
        covariance_expected=expected,
        off_mm=off,
        used=used,
        used_ratio=float(weight.sum() / sweep.point_weights.sum()),
        rms_mm=float(np.sqrt((weight * off**2).sum() / weight.sum())),
        moved_mm=float(np.linalg.norm(moved)),
        moved_deg=float(np.degrees(np.linalg.norm(turned))),
        weakest_mode=alone,
        remarks=tuple(remarks),
    )


def _covariances(nearest: ClosestPointQuery, sweep: Sweep, best: SweepFit) -> tuple[Array, Array]:
    """Return the covariance (6, 6) of the fit from the residuals alone, and the stated one.

    The stated one has a lower bound of the noise, and is inflated for few points.
    """
    fit = best.fixed_from_moving
    middle = fit.move_points(sweep.points_mm).mean(axis=0)
    weight = sweep.point_weights * best.weights
    freedom = max(float(weight.sum()) + 3.0 * len(sweep.landmarks_fixed_mm) - 6.0, 1.0)
    # Lower bound, because points exactly on the mesh have no residual.
    residual_variance = max(float((weight * best.off_mm**2).sum()) / freedom, 1e-12)
    smooth = nearest.smooth_normals(best.nearest_mm)
    by_sweep = equations(sweep, best, middle, normals=smooth, landmarks=False)[0] * best.sd_mm**2
    by_landmarks = equations(sweep, best, middle, normals=smooth)[0] - by_sweep / best.sd_mm**2
    expected = np.linalg.inv(by_sweep / residual_variance + by_landmarks)
    variance = max(residual_variance, sweep.min_sd_mm**2)
    stated = np.linalg.inv(by_sweep / variance + by_landmarks) * small_sample_factor(freedom)
    return (
        covariance_about_origin(fit, middle, np.asarray(expected, dtype=float)),
        covariance_about_origin(fit, middle, np.asarray(stated, dtype=float)),
    )
