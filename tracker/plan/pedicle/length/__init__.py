"""How far a pedicle's axis runs in bone: from the entry behind to the front wall of the body."""

from tracker.plan.pedicle.length.walls import WallAhead, back_wall, front_wall

__all__ = ["WallAhead", "back_wall", "front_wall"]
