"""Straight objects and their shadows."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array, Rigid, Vertebra
from tracker.rehearsal.anatomy import Needle
from tracker.rehearsal.clutter import BAR_RINGS
from tracker.rehearsal.lamp import rod_shadow
from tracker.rehearsal.placement import Room
from tracker.rehearsal.solids import Solid

Image32 = npt.NDArray[np.float32]
MAX_SHADOW_MM = 60.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Rod:
    """A straight shadow caster, in the room's frame."""

    tip_mm: Array
    along: Array
    length_mm: float
    radius_mm: float

    def shadow(self, points: Image32) -> Image32:
        """Return the shadow, 0..1, at points (n, 3)."""
        profile, radius = np.array([0.0, self.length_mm]), np.full(2, self.radius_mm)
        out = np.zeros(len(points), dtype=np.float32)
        middle = (self.tip_mm + 0.5 * self.length_mm * self.along).astype(np.float32)
        reach = 0.5 * self.length_mm + MAX_SHADOW_MM
        near = np.flatnonzero(
            (np.abs(points[:, 0] - middle[0]) < reach) & (np.abs(points[:, 2] - middle[2]) < reach)
        )
        out[near] = rod_shadow(points[near], self.tip_mm, self.along, profile, radius)
        return out


def rod_between(start_mm: Array, end_mm: Array, radius_mm: float) -> Rod:
    """Return the rod between two points (3,)."""
    line = end_mm - start_mm
    length = float(np.linalg.norm(line))
    return Rod(tip_mm=start_mm, along=line / length, length_mm=length, radius_mm=radius_mm)


def rod_of_needle(needle: Needle, room_from_vertebra: Rigid[Room, Vertebra]) -> Rod:
    """Return the shadow caster of a needle."""
    tip, head = (
        room_from_vertebra.move_points(end) for end in (needle.tip_in_vertebra_mm, needle.head_in_vertebra_mm)
    )
    return rod_between(tip, head, needle.radius_mm)


def rod_of_bar(bar: Solid) -> Rod:
    """Return the shadow caster of a steel bar."""
    centres = bar.vertices_mm.reshape(BAR_RINGS, -1, 3).mean(axis=1)
    return rod_between(centres[0], centres[-1], 1.8)
