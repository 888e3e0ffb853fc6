"""Second-order effect of a rotation error on a point at the end of a lever.

A rotated point moves on an arc, and first-order propagation follows the tangent. The arc deviates from it by
half the squared angle times the lever. For a marker that faces the camera, this is the only lateral effect of
a tilt. The term is not part of `Seen.pose_covariance`, because it grows with the lever: for a tilt of 2
degrees, 0.10 mm at 60 mm and 0.43 mm at 250 mm. It is added where the covariance is propagated to a point.

The moments are those of a normal distribution, also for the mixture of an ambiguous pose: simulated, the
coverage of the tip is that of a term from the mixture itself, for each probability of the other solution.
"""

from typing import TypeVar

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array, Rigid, point_covariance_mm2

To = TypeVar("To")
From = TypeVar("From")


def second_order_variance_mm2(pose_covariance: npt.ArrayLike, lever_mm: float) -> Array:
    """Return the variance (...) in mm^2 of the deviation of a point from the tangent, along each axis.

    For `pose_covariance` (..., 6, 6) [mm, rad] and a normally distributed rotation; `lever_mm` is the
    distance of the point from the origin of the pose. An upper bound: the deviation lies along the lever,
    and its variance is returned for all three axes.
    """
    rotation = np.asarray(pose_covariance, dtype=np.float64)[..., 3:, 3:]
    fourth_moment = np.trace(rotation, axis1=-2, axis2=-1) ** 2 + 2.0 * (rotation * rotation).sum((-2, -1))
    return np.asarray((0.5 * lever_mm) ** 2 * fourth_moment)


def covariance_at_lever(pose_covariance: npt.ArrayLike, lever_mm: float) -> Array:
    """Return the covariance (6, 6) whose first-order propagation to a point at this lever has both orders."""
    covariance = np.array(pose_covariance, dtype=np.float64)
    covariance[:3, :3] += second_order_variance_mm2(covariance, lever_mm) * np.eye(3)
    return covariance


def marker_point_covariance_mm2(
    pose: Rigid[To, From], pose_covariance: npt.ArrayLike, point_mm: npt.ArrayLike
) -> Array:
    """Return the covariance (3, 3) in mm^2 of a point (3,) fixed to a marker, to second order.

    As `point_covariance_mm2`, which is of first order.
    """
    lever_mm = float(np.linalg.norm(np.asarray(point_mm, dtype=np.float64)))
    return point_covariance_mm2(pose, covariance_at_lever(pose_covariance, lever_mm), point_mm)
