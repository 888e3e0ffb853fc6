"""Second-order effect of a rotation error on a point at the end of a lever."""

import numpy as np

from tracker.geometry import Array

# Lever from a marker to the tip of its tool, at which an error of the tilt acts.
TOOL_REACH_MM = 120.0


def second_order_covariance(covariance: Array) -> Array:
    """Return the second-order term (6, 6) of the propagation of `covariance` (6, 6) to the tip.

    A rotated tip moves on an arc, and first-order propagation follows the tangent. The arc deviates from it
    by half the squared angle times the lever. For a marker that faces the camera, this is the only lateral
    effect of a tilt.
    """
    rotation = covariance[3:, 3:]
    squared = float(rotation.trace()) ** 2 + 2.0 * float((rotation * rotation).sum())
    added = np.zeros((6, 6))
    added[0, 0] = added[1, 1] = added[2, 2] = (0.5 * TOOL_REACH_MM) ** 2 * squared
    return added
