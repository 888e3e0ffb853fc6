"""Gross errors of single landmarks: test for outliers, and a covariance that bounds undetected ones.

Residuals reveal an outlier only as far as the other landmarks determine its position. With four landmarks
each may have an error of a centimetre along some direction that the fit absorbs. This is the reliability of a
least- squares fit (Baarda 1968), or solution separation in satellite navigation (Blanch et al. 2012). For
each landmark whose gross error is not excluded, the fit is repeated with that error added to the landmark's
noise, and the covariance then includes the difference of the two fits.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from tracker.errors import Remark
from tracker.geometry import Anchor, Array, Rigid, Vertebra, vector_from_rotation
from tracker.registration.points.fit import fit_rigid_weighted, jacobians, weights_on_ct
from tracker.registration.points.uncertainty import normal_matrix

# A gross error is excluded if it lies farther than this from the estimated error of the landmark.
EXCLUDED_SDS = 2.0
# Below this ratio to a landmark's own weight, the other landmarks do not determine its error.
MIN_INFORMATION_RATIO = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class LeftOut:
    """A landmark against the fit of all others.

    Attributes:
        distance_mm: leave-one-out residual: distance of the landmark from its position by the fit of the
            others.
        others_fre_mm: FRE of the fit of the others.
        noise_scale: scale of the noise by the residuals of the others.
    """

    distance_mm: float
    others_fre_mm: float
    noise_scale: float


def undetected_error_mm(
    fit: Rigid[Vertebra, Anchor], moving_mm: Array, noise_mm2: Array, index: int, left_out: LeftOut | None
) -> float:
    """Return the largest error of a landmark that the others do not exclude; infinity if they exclude none.

    Its estimate by the others, plus two standard deviations along the least determined direction.
    `noise_mm2`: (n, 3, 3) in the anchor frame, before scaling.
    """
    if left_out is None:
        return np.inf
    weights = weights_on_ct(fit, noise_mm2) / left_out.noise_scale
    moved = fit.move_points(moving_mm)
    arms = moved - moved.mean(axis=0)
    row, own = jacobians(arms[index : index + 1])[0], weights[index]
    # The normal matrix of pose and error of this landmark, reduced to the error.
    information = own - own @ row @ np.linalg.solve(normal_matrix(arms, weights), row.T) @ own
    weakest = float(np.linalg.eigvalsh(information)[0])
    if weakest <= MIN_INFORMATION_RATIO * float(np.linalg.eigvalsh(own)[0]):
        return np.inf
    return left_out.distance_mm + EXCLUDED_SDS / float(np.sqrt(weakest))


def covariance_with_outlier(
    fit: Rigid[Vertebra, Anchor],
    fixed_mm: Array,
    moving_mm: Array,
    noise_mm2: Array,
    index: int,
    gross_error_mm: float,
) -> Array:
    """Return the second moment (6, 6) of the error of `fit` if one landmark has a gross error.

    Of a shift and a rotation about the moved centroid. `noise_mm2`: (n, 3, 3) in the anchor frame, of
    landmarks without a gross error.
    """
    noise = np.array(noise_mm2)
    noise[index] += gross_error_mm**2 / 3.0 * np.eye(3)
    robust = fit_rigid_weighted(fixed_mm, moving_mm, noise)
    middle_in_moving = moving_mm.mean(axis=0)
    moved = robust.move_points(moving_mm)
    separation = np.concatenate(
        [
            fit.move_points(middle_in_moving) - robust.move_points(middle_in_moving),
            vector_from_rotation(fit.rotation @ robust.rotation.T),
        ]
    )
    normal = normal_matrix(moved - moved.mean(axis=0), weights_on_ct(robust, noise))
    return np.asarray(np.linalg.inv(normal) + np.outer(separation, separation))


def covariance_spanning(covariances: Sequence[Array]) -> Array:
    """Return an upper bound of these covariances in the Loewner order.

    In the basis that makes two covariances diagonal, it has the larger of their variances on each axis.
    """
    spanning = np.asarray(covariances[0])
    for other in covariances[1:]:
        ratios, basis = scipy.linalg.eigh(other, spanning)
        back = np.linalg.inv(basis)
        wider = back.T @ np.diag(np.maximum(ratios, 1.0)) @ back
        spanning = 0.5 * (wider + wider.T)
    return spanning


def outlier_remarks(
    labels: Sequence[str],
    undetected_mm: Mapping[int, float],
    suspects: Collection[int],
    gross_error_mm: float,
) -> tuple[Remark, ...]:
    """Return the remark on landmarks whose gross error is not excluded; empty if there are none."""
    if not suspects:
        return ()
    count = len(undetected_mm)
    names = [labels[index] for index in suspects]
    which = "each of them" if len(names) == count else ", ".join(names)
    worst = max(undetected_mm[index] for index in suspects)
    extent = "of any size" if np.isinf(worst) else f"of up to {worst:.1f} mm"
    return (
        Remark(
            code="POINTS_OUTLIER_NOT_EXCLUDED",
            message=f"{count} landmarks do not exclude an error {extent} in {which}; the stated error "
            f"includes one landmark with an error of {gross_error_mm:g} mm (3-D RMS)",
            remedy="Add a landmark far from the others, and check on one that was not used.",
            context={
                "count": count,
                "named": names,
                "doubtful_landmarks": which,
                "doubtful_names": ", ".join(names),
                "error_extent": extent,
                "undetected_mm": None if np.isinf(worst) else worst,
                "gross_error_mm": gross_error_mm,
            },
        ),
    )
