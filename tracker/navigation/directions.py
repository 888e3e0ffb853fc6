"""The patient's directions across a channel: to the middle, to the head, and the wall that lies there."""

from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache

import numpy as np

from tracker.geometry import Array
from tracker.plan.channel import Channel
from tracker.plan.pedicle import Side

# Nearer than this (10 degrees) to the patient's long axis, "to the head" says nothing across a channel.
MIN_ACROSS = 0.17
# A wall that is met within 45 degrees of the channel's axis is the one in front.
AHEAD = float(np.cos(np.radians(45.0)))


class Wall(StrEnum):
    """The walls around a channel, as a surgeon calls them."""

    MEDIAL = "medial"
    LATERAL = "lateral"
    CRANIAL = "cranial"
    CAUDAL = "caudal"
    ANTERIOR = "anterior"


@dataclass(frozen=True, slots=True, kw_only=True)
class Directions:
    """Three unit directions (3,) at right angles, in the vertebra's frame (LPS).

    Attributes:
        axis: of drilling.
        medial: across the axis, to the patient's middle.
        cranial: across the axis, to the head.
        side: the side of the patient on which the channel lies.
        basis: (3, 3), the three as rows, in this order.
        entry_mm: (3,), the channel's entry.
    """

    axis: Array
    medial: Array
    cranial: Array
    side: Side
    basis: Array
    entry_mm: Array

    def wall_towards(self, direction: Array) -> Wall:
        """The wall that lies in a direction (3,) of any length."""
        parts = np.array([direction @ self.axis, direction @ self.medial, direction @ self.cranial])
        length = float(np.linalg.norm(parts))
        if length < 1e-12 or parts[0] > AHEAD * length:
            return Wall.ANTERIOR
        if abs(parts[1]) >= abs(parts[2]):
            return Wall.MEDIAL if parts[1] > 0.0 else Wall.LATERAL
        return Wall.CRANIAL if parts[2] > 0.0 else Wall.CAUDAL


def side_of(channel: Channel) -> Side:
    """The side on which a channel lies, where nobody said it: channels run to the middle.

    Not sure where a channel runs nearly straight forwards, as at the lower thoracic levels.
    """
    return _side_along(channel.axis_in_vertebra)


def _side_along(axis: Array) -> Side:
    return "left" if axis[0] <= 0.0 else "right"


def directions_of(channel: Channel, side: Side | None = None) -> Directions:
    """The directions across a channel; its side as the plan says it, or else as `side_of`."""
    return _directions(channel.entry_in_vertebra_mm.tobytes(), channel.target_in_vertebra_mm.tobytes(), side)


@lru_cache(maxsize=16)
def _directions(entry: bytes, target: bytes, side: Side | None) -> Directions:
    start = np.frombuffer(entry)
    way = np.frombuffer(target) - start
    axis = way / np.linalg.norm(way)
    side = side or _side_along(axis)
    up = np.array([0.0, 0.0, 1.0])
    if np.linalg.norm(np.cross(axis, up)) < MIN_ACROSS:
        up = np.array([0.0, 1.0, 0.0])
    cranial = up - (up @ axis) * axis
    cranial /= np.linalg.norm(cranial)
    left = np.cross(axis, cranial)
    left *= 1.0 if left[0] >= 0.0 else -1.0
    medial = -left if side == "left" else left
    basis = np.stack([axis, medial, cranial])
    basis.setflags(write=False)
    return Directions(
        axis=basis[0], medial=basis[1], cranial=basis[2], side=side, basis=basis, entry_mm=start
    )
