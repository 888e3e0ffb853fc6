"""Anatomical directions across a channel (medial, cranial), and the wall in each direction."""

from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache

import numpy as np

from tracker.geometry import Array
from tracker.plan.channel import Channel
from tracker.plan.pedicle import Side

# Within 10 degrees of the patient's long axis, the cranial direction across a channel is undefined.
MIN_AXIS_SINE = 0.17
# A wall within 45 degrees of the channel's axis is the anterior wall.
AHEAD = float(np.cos(np.radians(45.0)))


class Wall(StrEnum):
    """The walls around a channel, by anatomical direction."""

    MEDIAL = "medial"
    LATERAL = "lateral"
    CRANIAL = "cranial"
    CAUDAL = "caudal"
    ANTERIOR = "anterior"


@dataclass(frozen=True, slots=True, kw_only=True)
class Directions:
    """Orthonormal directions (3,) of a channel in the vertebra frame (LPS).

    Attributes:
        axis: drilling direction.
        medial: perpendicular to the axis, towards the patient's midline.
        cranial: perpendicular to the axis, towards the head.
        side: of the patient on which the channel lies.
        basis: (3, 3), rows are axis, medial and cranial.
        entry_mm: (3,), entry point of the channel.
    """

    axis: Array
    medial: Array
    cranial: Array
    side: Side
    basis: Array
    entry_mm: Array

    def wall_towards(self, direction: Array) -> Wall:
        """Return the wall in a direction (3,) of any length."""
        parts = np.array([direction @ self.axis, direction @ self.medial, direction @ self.cranial])
        length = float(np.linalg.norm(parts))
        if length < 1e-12 or parts[0] > AHEAD * length:
            return Wall.ANTERIOR
        if abs(parts[1]) >= abs(parts[2]):
            return Wall.MEDIAL if parts[1] > 0.0 else Wall.LATERAL
        return Wall.CRANIAL if parts[2] > 0.0 else Wall.CAUDAL


def side_of(channel: Channel) -> Side:
    """Return the side of a channel from its direction, because channels converge towards the midline.

    Unreliable where a channel runs nearly straight forwards, as at the lower thoracic levels.
    """
    return _side_along(channel.axis_in_vertebra)


def _side_along(axis: Array) -> Side:
    return "left" if axis[0] <= 0.0 else "right"


def channel_directions(channel: Channel, side: Side | None = None) -> Directions:
    """Return the directions of a channel; `side` as planned, or else as `side_of`."""
    return _directions(channel.entry_in_vertebra_mm.tobytes(), channel.target_in_vertebra_mm.tobytes(), side)


@lru_cache(maxsize=16)
def _directions(entry: bytes, target: bytes, side: Side | None) -> Directions:
    start = np.frombuffer(entry)
    line = np.frombuffer(target) - start
    axis = line / np.linalg.norm(line)
    side = side or _side_along(axis)
    up = np.array([0.0, 0.0, 1.0])
    if np.linalg.norm(np.cross(axis, up)) < MIN_AXIS_SINE:
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
