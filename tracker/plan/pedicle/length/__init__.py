"""Length of a pedicle's axis in bone: from the posterior entry to the anterior wall of the body.

The length ends at outlines of the whole bone. Along the axis, a contrast-filled vessel that touches the body
is separated from it only by the wall, but it lies outside the body's outline. A process is narrower than the
arch, whose posterior surface is where half of the bone around the axis ends.
"""

from tracker.plan.pedicle.length.walls import MIN_FACED_RATIO, WallAhead, back_wall, front_wall

__all__ = ["MIN_FACED_RATIO", "WallAhead", "back_wall", "front_wall"]
