"""How far a pedicle's axis runs in bone: from the entry behind to the front wall of the body.

The length ends at outlines of the whole bone. A contrast-filled vessel that touches the body is only a
wall's thickness away along the axis, but lies outside the body's outline; a process is more slender than the
arch, whose back is where half of the bone around the axis ends.
"""

from tracker.plan.pedicle.length.walls import WallAhead, back_wall, front_wall

__all__ = ["WallAhead", "back_wall", "front_wall"]
