"""The end of a tool goes along an arc, where a covariance carries the tangent alone."""

import numpy as np

from tracker.geometry import Array

# From a marker to the end of the tool that it is on: what a doubt about its tilt is about.
TOOL_REACH_MM = 120.0


def beyond_first_order(covariance: Array) -> Array:
    """What an unsure turn does to the end of a tool beside what a covariance (6, 6) carries there: (6, 6).

    The end goes along an arc, and is nearer than its tangent says by half the squared turn times its reach;
    a covariance carries tangents alone. Of a marker that faces the camera that is all that tilt does across.
    """
    turn = covariance[3:, 3:]
    squared = float(turn.trace()) ** 2 + 2.0 * float((turn * turn).sum())
    more = np.zeros((6, 6))
    more[0, 0] = more[1, 1] = more[2, 2] = (0.5 * TOOL_REACH_MM) ** 2 * squared
    return more
