"""Uncertainty of the drill: ellipsoid of its tip and cone of its axis."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array, Tool, Vertebra, skew
from tracker.navigation.directions import channel_directions
from tracker.navigation.uncertainty.uncertain_pose import UncertainPose
from tracker.plan.channel import Channel

# Square root of the 95 % point of chi-square with three degrees of freedom.
ELLIPSOID_95 = 2.7955
# Radius that contains 95 % of a bivariate normal distribution, in units of the larger standard deviation, by
# the ratio of both: from a line to a circle.
RATIOS = np.linspace(0.0, 1.0, 11)
RADII_95 = np.array(
    [1.95996, 1.96253, 1.97041, 1.9842, 2.00514, 2.03586, 2.0813, 2.14598, 2.23029, 2.3318, 2.44775]
)
# The axis of a drill across the channel (over 84 degrees) intersects the planes far away.
MIN_ALONG = 0.1


@dataclass(frozen=True, slots=True, kw_only=True)
class DrillUncertainty:
    """Uncertainty of a drill in the vertebra frame.

    Attributes:
        tip_covariance_mm2: (3, 3).
        tip_ellipsoid_mm: (3, 3), rows are the half axes of the 95 % ellipsoid of the tip, the longest first.
        cone_95_deg: half angle of the 95 % cone of the axis.
        tip_sd_mm: of the tip in its least certain direction.
        sd_angle_deg: of the axis in its least certain direction.
        sd_depth_mm: of the tip along the channel.
        sd_at_entry_mm: of the intersection of the drill's axis with the entry plane, in its least certain
            direction; infinite if the drill lies across the channel.
    """

    tip_covariance_mm2: Array
    tip_ellipsoid_mm: Array
    cone_95_deg: float
    tip_sd_mm: float
    sd_angle_deg: float
    sd_depth_mm: float
    sd_at_entry_mm: float


def propagate_uncertainty(tool: UncertainPose[Vertebra, Tool], channel: Channel) -> DrillUncertainty:
    """Return the uncertainty of a drill in the vertebra frame."""
    covariance = tool.covariance[:3, :3]
    values, vectors = np.linalg.eigh(covariance)
    sds = np.sqrt(np.maximum(values[::-1], 0.0))
    ellipsoid = ELLIPSOID_95 * sds[:, None] * vectors.T[::-1]
    for array in (covariance, ellipsoid):
        array.setflags(write=False)
    larger, smaller = _plane_sds(axis_covariance_rad2(tool))
    axis = channel_directions(channel).axis
    return DrillUncertainty(
        tip_covariance_mm2=covariance,
        tip_ellipsoid_mm=ellipsoid,
        cone_95_deg=float(np.degrees(radius_95(larger, smaller))),
        tip_sd_mm=float(sds[0]),
        sd_angle_deg=float(np.degrees(larger)),
        sd_depth_mm=float(np.sqrt(max(float(axis @ covariance @ axis), 0.0))),
        sd_at_entry_mm=crossing_sds_mm(tool, channel, depth_mm=0.0)[0],
    )


def axis_covariance_rad2(tool: UncertainPose[Vertebra, Tool]) -> Array:
    """Return the covariance (2, 2) of the drilling direction, along the tool's x and y."""
    swing = -tool.pose.rotation[:, :2].T @ skew(tool.pose.rotation[:, 2])
    return np.asarray(swing @ tool.covariance[3:, 3:] @ swing.T)


def crossing_sds_mm(
    tool: UncertainPose[Vertebra, Tool], channel: Channel, *, depth_mm: float
) -> tuple[float, float]:
    """Return the larger and smaller sd of the axis's intersection with the plane at a depth."""
    return _plane_sds(crossing_covariance_mm2(tool, channel, depth_mm=depth_mm))


def crossing_covariance_mm2(
    tool: UncertainPose[Vertebra, Tool], channel: Channel, *, depth_mm: float
) -> Array:
    """Return the covariance (2, 2) of the axis's intersection with the plane at a depth: medial, cranial.

    Errors of tip and axis are correlated: a rotation of the marker also displaces the tip. Infinite if the
    drill lies across the channel.
    """
    across = channel_directions(channel)
    direction = tool.pose.rotation[:, 2]
    along = float(direction @ across.axis)
    if abs(along) < MIN_ALONG:
        return np.diag([np.inf, np.inf])
    tip_depth = float((tool.pose.translation_mm - channel.entry_in_vertebra_mm) @ across.axis)
    ahead = (depth_mm - tip_depth) / along
    onto = np.stack([across.medial, across.cranial])
    # A motion of the line along itself does not move the intersection.
    onto = onto @ (np.eye(3) - np.outer(direction, across.axis) / along)
    jacobian = onto @ np.hstack([np.eye(3), -ahead * skew(direction)])
    return np.asarray(jacobian @ tool.covariance @ jacobian.T)


def radius_95(larger_sd: float, smaller_sd: float) -> float:
    """Return the radius of the circle that contains 95 % of a bivariate normal distribution.

    Infinite where a standard deviation is not finite.
    """
    if not (np.isfinite(larger_sd) and np.isfinite(smaller_sd)):
        return np.inf
    if larger_sd <= 0.0:
        return 0.0
    return float(larger_sd * np.interp(smaller_sd / larger_sd, RATIOS, RADII_95))


def _plane_sds(covariance: Array) -> tuple[float, float]:
    if not np.isfinite(covariance).all():
        return np.inf, np.inf
    a, b, c = float(covariance[0, 0]), float(covariance[0, 1]), float(covariance[1, 1])
    middle, half = 0.5 * (a + c), float(np.hypot(0.5 * (a - c), b))
    return float(np.sqrt(max(middle + half, 0.0))), float(np.sqrt(max(middle - half, 0.0)))
