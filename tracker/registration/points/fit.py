"""Rigid least-squares fit of captured points to marked ones."""

import numpy as np

from tracker.geometry import Anchor, Array, Rigid, Vertebra, rotation_from_vector, skew

MAX_ROUNDS = 30
TOLERANCE = 1e-9  # mm and rad


def fit_rigid(fixed_mm: Array, moving_mm: Array) -> Rigid[Vertebra, Anchor]:
    """Fit (n, 3) points with equal weights (Arun 1987, with the sign correction of Umeyama 1991)."""
    to, since = fixed_mm.mean(axis=0), moving_mm.mean(axis=0)
    left, _, right = np.linalg.svd((fixed_mm - to).T @ (moving_mm - since))
    mirror = np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    rotation = left @ mirror @ right
    return Rigid(rotation=rotation, translation_mm=to - rotation @ since)


def fit_rigid_weighted(fixed_mm: Array, moving_mm: Array, noise_mm2: Array) -> Rigid[Vertebra, Anchor]:
    """Fit points with an individual covariance (n, 3, 3) each, in the anchor frame.

    Gauss-Newton iteration from the unweighted fit. The weights are rotated with the points.
    """
    fit = fit_rigid(fixed_mm, moving_mm)
    for _ in range(MAX_ROUNDS):
        middle = fit.move_points(moving_mm).mean(axis=0)
        residuals = fit.move_points(moving_mm) - fixed_mm
        weights = weights_on_ct(fit, noise_mm2)
        rows = jacobians(fit.move_points(moving_mm) - middle)
        normal = np.einsum("nik,nij,njl->kl", rows, weights, rows)
        step = np.linalg.solve(normal, -np.einsum("nik,nij,nj->k", rows, weights, residuals))
        turn = rotation_from_vector(step[3:])
        fit = Rigid(
            rotation=turn @ fit.rotation,
            translation_mm=turn @ (fit.translation_mm - middle) + middle + step[:3],
        )
        if float(np.abs(step).max()) < TOLERANCE:
            break
    return fit


def weights_on_ct(fit: Rigid[Vertebra, Anchor], noise_mm2: Array) -> Array:
    """Return the inverses (n, 3, 3) of covariances in the anchor frame, rotated to the CT axes."""
    return np.asarray(np.linalg.inv(fit.rotation @ noise_mm2 @ fit.rotation.T), dtype=float)


def jacobians(arms_mm: Array) -> Array:
    """Return the Jacobian (n, 3, 6) of points at these arms (n, 3) for a small shift and rotation."""
    rows = np.zeros((len(arms_mm), 3, 6))
    rows[:, :, :3] = np.eye(3)
    x, y, z = arms_mm.T
    rows[:, 0, 4], rows[:, 0, 5] = z, -y
    rows[:, 1, 3], rows[:, 1, 5] = -z, x
    rows[:, 2, 3], rows[:, 2, 4] = y, -x
    return rows


def covariance_about_origin(fit: Rigid[Vertebra, Anchor], about_mm: Array, covariance: Array) -> Array:
    """Return the covariance (6, 6) of a fit, given that of a shift and a rotation about a point on the CT.

    The result is of the translation and of a small left-multiplied rotation, which is about the anchor's
    origin.
    """
    carried = np.eye(6)
    carried[:3, 3:] = -skew(fit.translation_mm - about_mm)
    return np.asarray(carried @ covariance @ carried.T)
