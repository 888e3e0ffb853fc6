"""Registration by surface: points swept over the bone are laid on the CT's surface."""

from collections.abc import Sequence
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
    point_covariance_mm2,
    skew,
    vector_from_rotation,
)
from tracker.plan.remark import Remark
from tracker.registration.points import PairedPoints
from tracker.registration.points.fit import weights_in_fixed
from tracker.registration.points.uncertainty import few_points
from tracker.registration.record import AnchoredTo, Method, Registration
from tracker.registration.surface.fit import Laid, Sweep, equations, laid_on, look, shares_of
from tracker.registration.surface.nearest import NearestOnSurface
from tracker.registration.surface.rejections import (
    checked_sweep,
    reject_disagreement,
    reject_far,
    reject_sliding,
    reject_small,
)
from tracker.registration.surface.rivals import best_of, reject_another_place
from tracker.registration.surface.settings import SurfaceGate, SurfaceSettings
from tracker.registration.surface.sliding import Direction, directions


@dataclass(frozen=True, slots=True, kw_only=True)
class SurfaceRegistration:
    """Where the vertebra is, by a sweep over its surface.

    Attributes:
        fixed_from_moving: takes swept points to the CT.
        covariance: (6, 6) of it [mm, rad], translation first, then a small left-multiplied rotation vector on
            the CT's axes.
        off_mm: (n,) how far each swept point comes to lie outside the surface; negative inside.
        used: (n,) which of them agree.
        used_ratio: their share.
        rms_mm: root mean square of their distances.
        moved_mm, moved_deg: how far the fit lies from its start, at the middle of the sweep.
        weakest: the direction that the sweep alone holds least.
        remarks: what should be known.
    """

    fixed_from_moving: Rigid[Vertebra, Anchor]
    covariance: Array
    off_mm: Array
    used: npt.NDArray[np.bool_]
    used_ratio: float
    rms_mm: float
    moved_mm: float
    moved_deg: float
    weakest: Direction
    remarks: tuple[Remark, ...]

    def target_covariance_mm2(self, target_mm: npt.ArrayLike) -> Array:
        """Covariance (3, 3), on the CT's axes, of where a target (3,) on the CT is thought to be."""
        target_in_moving = self.fixed_from_moving.inverse.move_points(target_mm)
        return point_covariance_mm2(self.fixed_from_moving, self.covariance, target_in_moving)

    def tre_stated_mm(self, target_mm: npt.ArrayLike) -> float:
        """The error (3-D RMS) that is stated for a target (3,) on the CT."""
        return float(np.sqrt(np.trace(self.target_covariance_mm2(target_mm))))

    def registration(self, anchored_to: AnchoredTo) -> Registration:
        """The same as navigation uses it."""
        return Registration(
            method=Method.SURFACE,
            anchored_to=anchored_to,
            anchor_from_vertebra=self.fixed_from_moving.inverse,
            covariance=inverse_covariance(self.fixed_from_moving, self.covariance),
        )

    def failures(
        self, gate: SurfaceGate, targets_mm: Sequence[npt.ArrayLike]
    ) -> tuple[RegistrationError, ...]:
        """What keeps it from being used for these targets on the CT; nothing where it passes."""
        stated = max((self.tre_stated_mm(target) for target in targets_mm), default=0.0)
        asked = (
            ("SURFACE_FIT_TOO_LARGE", "the sweep lies on the bone to", self.rms_mm, gate.max_rms_mm),
            ("SURFACE_TARGET_UNCERTAIN", "at the target it is known to", stated, gate.max_tre_mm),
            ("SURFACE_MOVED_FAR", "the fit moved from its start by", self.moved_mm, gate.max_moved_mm),
        )
        return tuple(
            RegistrationError(
                code,
                f"{words} {value:.2f} mm, allowed {allowed:.2f} mm",
                "Sweep more of the bone, with the tip on bare bone, or touch the landmarks again.",
                {"value_mm": value, "allowed_mm": allowed},
            )
            for code, words, value, allowed in asked
            if not value <= allowed
        )


def register_surface(
    nearest: NearestOnSurface,
    points_mm: npt.ArrayLike,
    start: Rigid[Vertebra, Anchor],
    *,
    targets_mm: Sequence[npt.ArrayLike] = (),
    landmarks: PairedPoints | None = None,
    settings: SurfaceSettings | None = None,
) -> SurfaceRegistration:
    """The motion that lays swept points (n, 3) of the anchor's frame on the bone, from a fit by landmarks.

    Iterated closest points, point to plane (Chen and Medioni 1992), with Tukey's weights; landmarks, where
    given, pull as hard as they are sure. It is tried from other starts too, so that a second place in which
    the sweep fits about as well is found and told instead of being taken by chance. `targets_mm`: on the CT,
    such as entry points; what the sweep leaves open is judged there.

    Raises:
        RegistrationError: SURFACE_SWEEP_INVALID, SURFACE_SWEEP_SMALL, SURFACE_START_FAR, SURFACE_DISAGREES,
            SURFACE_SLIDES or SURFACE_AMBIGUOUS.
    """
    settings = settings or SurfaceSettings()
    points = checked_sweep(np.asarray(points_mm, dtype=np.float64))
    shares = shares_of(points, settings.alike_mm) if len(points) else np.empty(0)
    reject_small(points, shares, settings)
    sweep = _sweep(points, shares, landmarks, start, settings)
    reject_far(look(nearest, sweep, start), settings)
    targets = np.array([start.move_points(points.mean(axis=0)), *targets_mm], dtype=np.float64).reshape(-1, 3)
    first = laid_on(nearest, sweep, start)
    middle = first.fixed_from_moving.move_points(points).mean(axis=0)
    lever = max(float(np.linalg.norm(targets - middle, axis=1).max()), _radius_mm(points))
    alone, held = _directions(nearest, sweep, first, middle, lever)
    reject_disagreement(first, sweep, settings)
    reject_sliding(held, settings)
    best, rivals = best_of(nearest, sweep, start, first, alone.way, lever, settings)
    reject_disagreement(best, sweep, settings)
    reject_another_place(sweep, best, rivals, targets, settings)
    middle = best.fixed_from_moving.move_points(points).mean(axis=0)
    alone, held = _directions(nearest, sweep, best, middle, lever)
    reject_sliding(held, settings)
    return _told(nearest, sweep, best, start, alone, settings)


def _sweep(
    points: Array,
    shares: Array,
    landmarks: PairedPoints | None,
    start: Rigid[Vertebra, Anchor],
    settings: SurfaceSettings,
) -> Sweep:
    fixed, moving, weights = np.empty((0, 3)), np.empty((0, 3)), np.empty((0, 3, 3))
    if landmarks is not None:
        fixed, moving = landmarks.fixed_mm, landmarks.moving_mm
        noise = np.broadcast_to(settings.landmark_sd_mm**2 * np.eye(3), (len(fixed), 3, 3))
        if landmarks.moving_covariances_mm2 is not None:
            noise = landmarks.moving_covariances_mm2 + settings.min_sd_mm**2 * np.eye(3)
        weights = weights_in_fixed(start, noise)
    return Sweep(
        points_mm=points,
        shares=shares,
        landmarks_fixed_mm=fixed,
        landmarks_moving_mm=moving,
        landmark_weights=weights,
        min_sd_mm=settings.min_sd_mm,
        tip_radius_mm=settings.tip_radius_mm,
    )


def _radius_mm(points: Array) -> float:
    return float(np.sqrt(((points - points.mean(axis=0)) ** 2).sum(axis=1).mean()))


def _directions(
    nearest: NearestOnSurface, sweep: Sweep, laid: Laid, middle: Array, lever_mm: float
) -> tuple[Direction, Direction]:
    """What is least sure by the sweep alone, and with the landmarks."""
    smooth = nearest.smooth_normals(laid.nearest_mm)
    alone = equations(sweep, laid, middle, normals=smooth, landmarks=False)[0]
    held = equations(sweep, laid, middle, normals=smooth)[0]
    return directions(alone, lever_mm)[0], directions(held, lever_mm)[0]


def _told(
    nearest: NearestOnSurface,
    sweep: Sweep,
    best: Laid,
    start: Rigid[Vertebra, Anchor],
    alone: Direction,
    settings: SurfaceSettings,
) -> SurfaceRegistration:
    fit, used = best.fixed_from_moving, best.weights > 0.0
    middle_of_sweep = sweep.points_mm.mean(axis=0)
    turned = vector_from_rotation(fit.rotation @ start.rotation.T)
    remarks = []
    if alone.sd_mm > settings.max_slide_sd_mm:
        remarks.append(
            Remark(
                code="SURFACE_HELD_BY_LANDMARKS",
                message=f"{alone.in_words} the sweep alone would slide; there the landmarks hold it",
                remedy="Sweep surfaces that face other ways too, such as the flanks of the spinous process.",
                context={"direction": alone.in_words},
            )
        )
    covariance = _covariance(nearest, sweep, best)
    off = np.array(best.off_mm)
    for array in (covariance, off, used):
        array.setflags(write=False)
    say = sweep.shares * used
    moved = fit.move_points(middle_of_sweep) - start.move_points(middle_of_sweep)
    return SurfaceRegistration(
        fixed_from_moving=fit,
        covariance=covariance,
        off_mm=off,
        used=used,
        used_ratio=float(say.sum() / sweep.shares.sum()),
        rms_mm=float(np.sqrt((say * off**2).sum() / say.sum())),
        moved_mm=float(np.linalg.norm(moved)),
        moved_deg=float(np.degrees(np.linalg.norm(turned))),
        weakest=alone,
        remarks=tuple(remarks),
    )


def _covariance(nearest: NearestOnSurface, sweep: Sweep, best: Laid) -> Array:
    """Covariance (6, 6) of the fit, from what its residuals and its least error say, for few points wider."""
    fit = best.fixed_from_moving
    middle = fit.move_points(sweep.points_mm).mean(axis=0)
    say = sweep.shares * best.weights
    freedom = max(float(say.sum()) + 3.0 * len(sweep.landmarks_fixed_mm) - 6.0, 1.0)
    variance = max(float((say * best.off_mm**2).sum()) / freedom, sweep.min_sd_mm**2)
    smooth = nearest.smooth_normals(best.nearest_mm)
    by_sweep = equations(sweep, best, middle, normals=smooth, landmarks=False)[0]
    by_landmarks = equations(sweep, best, middle, normals=smooth)[0] - by_sweep
    about_middle = np.linalg.inv(by_sweep * best.sd_mm**2 / variance + by_landmarks) * few_points(freedom)
    # From a turn about the sweep's middle to one about the anchor's origin, which the record is of.
    carried = np.eye(6)
    carried[:3, 3:] = -skew(fit.translation_mm - middle)
    return np.asarray(carried @ about_middle @ carried.T)
