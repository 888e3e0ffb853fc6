"""Robust point-to-plane ICP of swept points to the surface, from one start."""

from dataclasses import dataclass

import numpy as np
import scipy

from tracker.geometry import Anchor, Array, Rigid, Vertebra, rotation_from_vector
from tracker.registration.points.fit import jacobians
from tracker.registration.surface.closest_points import ClosestPointQuery

MAX_ROUNDS = 60
TOLERANCE_MM = 1e-4  # at the lever of the sweep
# Tukey's biweight with 95 % efficiency under Gaussian noise.
TUKEY = 4.685
SD_FROM_MEDIAN = 1.4826


@dataclass(frozen=True, slots=True, kw_only=True)
class Sweep:
    """Data of the fit: swept points and landmarks.

    Attributes:
        points_mm: (n, 3) in the anchor's frame.
        point_weights: (n,) weight of each point against the density of points; 1 for an isolated one.
        landmarks_fixed_mm, landmarks_moving_mm: (m, 3) on the CT and as touched; m may be 0.
        landmark_weights: (m, 3, 3) the inverse covariance of each, on the CT's axes.
        min_sd_mm, tip_radius_mm: see `SurfaceSettings`.
    """

    points_mm: Array
    point_weights: Array
    landmarks_fixed_mm: Array
    landmarks_moving_mm: Array
    landmark_weights: Array
    min_sd_mm: float
    tip_radius_mm: float


@dataclass(frozen=True, slots=True, kw_only=True)
class SweepFit:
    """A fit from one start.

    Attributes:
        fixed_from_moving: from the anchor frame to the CT.
        off_mm: (n,) signed distances from the surface minus the tip's radius, positive outside.
        normals: (n, 3) of the surface at the closest points.
        nearest_mm: (n, 3) the closest points.
        weights: (n,) robust weights, 0..1.
        sd_mm: standard deviation of one point about the surface.
    """

    fixed_from_moving: Rigid[Vertebra, Anchor]
    off_mm: Array
    normals: Array
    nearest_mm: Array
    weights: Array
    sd_mm: float


def density_weights(points_mm: Array, correlation_length_mm: float) -> Array:
    """Return the inverse (n,) of the number of points within a radius, so that a long rest counts once."""
    near = scipy.spatial.KDTree(points_mm).query_ball_point(
        points_mm, correlation_length_mm, return_length=True
    )
    return np.asarray(1.0 / np.asarray(near, dtype=np.float64))


def fit_sweep(
    nearest: ClosestPointQuery,
    sweep: Sweep,
    start: Rigid[Vertebra, Anchor],
    *,
    tolerance_mm: float = TOLERANCE_MM,
) -> SweepFit:
    """Run ICP from this start until a step is smaller than a tolerance."""
    fit = start
    lever = float(np.sqrt(((sweep.points_mm - sweep.points_mm.mean(axis=0)) ** 2).sum(axis=1).mean()))
    for _ in range(MAX_ROUNDS):
        laid = evaluate(nearest, sweep, fit)
        moved = fit.move_points(sweep.points_mm)
        middle = moved.mean(axis=0)
        normal, right = equations(sweep, laid, middle)
        ridge = 1e-9 * np.trace(normal[:3, :3]) * np.diag([1.0] * 3 + [lever**2] * 3)
        step = np.linalg.solve(normal + ridge, right)
        # Limit the step, because the point-to-plane linearisation is valid only within a few mm.
        size = max(float(np.abs(step[:3]).max()), lever * float(np.abs(step[3:]).max()))
        step *= min(1.0, 5.0 / max(size, 1e-12))
        turn = rotation_from_vector(step[3:])
        fit = Rigid(
            rotation=turn @ fit.rotation,
            translation_mm=turn @ (fit.translation_mm - middle) + middle + step[:3],
        )
        if size < tolerance_mm:
            break
    return evaluate(nearest, sweep, fit)


def evaluate(nearest: ClosestPointQuery, sweep: Sweep, fit: Rigid[Vertebra, Anchor]) -> SweepFit:
    """Return closest points, residuals and robust weights at this transform."""
    moved = fit.move_points(sweep.points_mm)
    at = nearest.at(moved)
    off = ((moved - at.points_mm) * at.normals).sum(axis=1)
    # Near an edge of the mesh the direction to the surface is not the triangle's normal.
    offset = moved - at.points_mm
    length = np.linalg.norm(offset, axis=1)
    aslant = (length > 1e-6) & (np.abs(off) < 0.999 * length)
    sign = np.where(off >= 0.0, 1.0, -1.0)
    normals = np.where(aslant[:, None], offset * (sign / np.maximum(length, 1e-12))[:, None], at.normals)
    off = np.where(aslant, sign * length, off) - sweep.tip_radius_mm
    order = np.argsort(np.abs(off))
    middle = np.searchsorted(np.cumsum(sweep.point_weights[order]), 0.5 * sweep.point_weights.sum())
    median = float(np.abs(off)[order[min(int(middle), len(order) - 1)]])
    sd = max(SD_FROM_MEDIAN * median, sweep.min_sd_mm)
    weights = np.clip(1.0 - (off / (TUKEY * sd)) ** 2, 0.0, None) ** 2
    return SweepFit(
        fixed_from_moving=fit, off_mm=off, normals=normals, nearest_mm=at.points_mm, weights=weights, sd_mm=sd
    )


def equations(
    sweep: Sweep, laid: SweepFit, about_mm: Array, *, normals: Array | None = None, landmarks: bool = True
) -> tuple[Array, Array]:
    """Return normal matrix (6, 6) and right side (6,) of a step: a shift, and a rotation about this point."""
    fit = laid.fixed_from_moving
    rows = np.einsum(
        "ni,nik->nk",
        laid.normals if normals is None else normals,
        jacobians(fit.move_points(sweep.points_mm) - about_mm),
    )
    weight = laid.weights * sweep.point_weights / laid.sd_mm**2
    normal, right = (rows * weight[:, None]).T @ rows, -rows.T @ (weight * laid.off_mm)
    if landmarks and len(sweep.landmarks_fixed_mm):
        moved = fit.move_points(sweep.landmarks_moving_mm)
        arms = jacobians(moved - about_mm)
        weighed = np.einsum("nik,nij->nkj", arms, sweep.landmark_weights)
        normal = normal + np.einsum("nkj,njl->kl", weighed, arms)
        right = right - np.einsum("nkj,nj->k", weighed, moved - sweep.landmarks_fixed_mm)
    return normal, right


def cost(sweep: Sweep, laid: SweepFit, sd_mm: float) -> float:
    """Return the truncated sum of squares of sweep and landmarks, in standard deviations."""
    squares = np.minimum((laid.off_mm / sd_mm) ** 2, TUKEY**2)
    total = float((sweep.point_weights * squares).sum())
    if len(sweep.landmarks_fixed_mm):
        off = laid.fixed_from_moving.move_points(sweep.landmarks_moving_mm) - sweep.landmarks_fixed_mm
        total += float(np.einsum("ni,nij,nj->", off, sweep.landmark_weights, off))
    return total
