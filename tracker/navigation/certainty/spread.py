"""What the uncertainty means for the drill: an ellipsoid at its tip, a cone of its axis."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array, Tool, Vertebra, skew
from tracker.navigation.certainty.placed import Placed
from tracker.navigation.directions import directions_of
from tracker.plan.channel import Channel

# Square root of the 95 % point of chi-square with three degrees of freedom.
ELLIPSOID_95 = 2.7955
# Radius that holds 95 % of a plane's normal distribution, in units of the larger standard deviation, by the
# ratio of both: from a line to a circle.
RATIOS = np.linspace(0.0, 1.0, 11)
RADII_95 = np.array(
    [1.95996, 1.96253, 1.97041, 1.9842, 2.00514, 2.03586, 2.0813, 2.14598, 2.23029, 2.3318, 2.44775]
)
# A drill across the channel (over 84 degrees) meets no plane across it where it matters.
MIN_ALONG = 0.1


@dataclass(frozen=True, slots=True, kw_only=True)
class Spread:
    """How far the true drill may be from the one that is shown; in the vertebra's frame.

    Attributes:
        tip_covariance_mm2: (3, 3).
        tip_ellipsoid_mm: (3, 3), a row for each half axis of the ellipsoid that holds the tip in 95 %, the
            longest first.
        cone_95_deg: half angle of the cone that holds the axis in 95 %.
        tip_sd_mm: of the tip in the least sure direction.
        sd_angle_deg: of the axis in the least sure direction.
        sd_depth_mm: of the tip along the channel.
        sd_at_entry_mm: of where the drill's line meets the entry plane, in the least sure direction;
            infinite where it is across the channel.
    """

    tip_covariance_mm2: Array
    tip_ellipsoid_mm: Array
    cone_95_deg: float
    tip_sd_mm: float
    sd_angle_deg: float
    sd_depth_mm: float
    sd_at_entry_mm: float


def spread_of(tool: Placed[Vertebra, Tool], channel: Channel) -> Spread:
    """The spread of a drill that is placed in the plan's frame."""
    covariance = tool.covariance[:3, :3]
    values, vectors = np.linalg.eigh(covariance)
    sds = np.sqrt(np.maximum(values[::-1], 0.0))
    ellipsoid = ELLIPSOID_95 * sds[:, None] * vectors.T[::-1]
    for array in (covariance, ellipsoid):
        array.setflags(write=False)
    larger, smaller = _plane_sds(axis_covariance_rad2(tool))
    axis = directions_of(channel).axis
    return Spread(
        tip_covariance_mm2=covariance,
        tip_ellipsoid_mm=ellipsoid,
        cone_95_deg=float(np.degrees(radius_95(larger, smaller))),
        tip_sd_mm=float(sds[0]),
        sd_angle_deg=float(np.degrees(larger)),
        sd_depth_mm=float(np.sqrt(max(float(axis @ covariance @ axis), 0.0))),
        sd_at_entry_mm=crossing_sds_mm(tool, channel, depth_mm=0.0)[0],
    )


def axis_covariance_rad2(tool: Placed[Vertebra, Tool]) -> Array:
    """Covariance (2, 2) of the drilling direction, along the tool's own x and y."""
    swing = -tool.pose.rotation[:, :2].T @ skew(tool.pose.rotation[:, 2])
    return np.asarray(swing @ tool.covariance[3:, 3:] @ swing.T)


def crossing_sds_mm(
    tool: Placed[Vertebra, Tool], channel: Channel, *, depth_mm: float
) -> tuple[float, float]:
    """Larger and smaller sd of where the drill's line meets the plane at a depth of the channel."""
    return _plane_sds(crossing_covariance_mm2(tool, channel, depth_mm=depth_mm))


def crossing_covariance_mm2(tool: Placed[Vertebra, Tool], channel: Channel, *, depth_mm: float) -> Array:
    """Covariance (2, 2) of where the drill's line meets the plane at a depth: to the middle, to the head.

    Tip and axis err together: a marker behind the tip swings the tip by its angle. Infinite where the drill
    is across the channel.
    """
    across = directions_of(channel)
    direction = tool.pose.rotation[:, 2]
    along = float(direction @ across.axis)
    if abs(along) < MIN_ALONG:
        return np.diag([np.inf, np.inf])
    tip_depth = float((tool.pose.translation_mm - channel.entry_in_vertebra_mm) @ across.axis)
    ahead = (depth_mm - tip_depth) / along
    onto = np.stack([across.medial, across.cranial])
    # Whatever moves the line along itself moves the crossing not at all.
    onto = onto @ (np.eye(3) - np.outer(direction, across.axis) / along)
    jacobian = onto @ np.hstack([np.eye(3), -ahead * skew(direction)])
    return np.asarray(jacobian @ tool.covariance @ jacobian.T)


def radius_95(larger_sd: float, smaller_sd: float) -> float:
    """The radius around the mean that holds 95 % of a normal distribution in the plane."""
    if not larger_sd > 0.0:
        return 0.0
    if not np.isfinite(larger_sd):
        return np.inf
    return float(larger_sd * np.interp(smaller_sd / larger_sd, RATIOS, RADII_95))


def _plane_sds(covariance: Array) -> tuple[float, float]:
    if not np.isfinite(covariance[0, 0]):
        return np.inf, np.inf
    a, b, c = float(covariance[0, 0]), float(covariance[0, 1]), float(covariance[1, 1])
    middle, half = 0.5 * (a + c), float(np.hypot(0.5 * (a - c), b))
    return float(np.sqrt(max(middle + half, 0.0))), float(np.sqrt(max(middle - half, 0.0)))
