"""Whether swept points hold the bone in place, in all six directions, and where another fit is as good."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array

SHIFTS = ("to the left or right", "to the front or back", "along the spine (to head or feet)")
TURNS = (
    "tilting to head or feet (about the left-right axis)",
    "tilting to the side (about the front-back axis)",
    "turning about the spine's own axis",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Direction:
    """One way in which a bone may move, and how well that is known.

    Attributes:
        way: (6,) of unit length: a shift in mm and a turn in mm at the lever, on the CT's axes.
        sd_mm: how unsure it is; infinite where nothing holds it.
        in_words: for a surgeon.
    """

    way: Array
    sd_mm: float
    in_words: str


def directions(normal: Array, lever_mm: float) -> list[Direction]:
    """The six independent ways to move, the least sure first, of a normal matrix (6, 6) of mm and rad.

    Turns count by the arc that they make at the lever: what the target would feel.
    """
    scale = np.diag([1.0] * 3 + [1.0 / lever_mm] * 3)
    values, ways = np.linalg.eigh(scale @ normal @ scale)
    floor = 1e-9 * max(float(values[-1]), 1e-12)
    found = []
    for value, way in zip(values, ways.T, strict=True):
        sd = float(1.0 / np.sqrt(value)) if value > floor else np.inf
        found.append(Direction(way=way, sd_mm=sd, in_words=in_words(way)))
    return found


def in_words(way: Array) -> str:
    """The axis that a movement (6,) follows most."""
    shift, turn = float(np.linalg.norm(way[:3])), float(np.linalg.norm(way[3:]))
    if shift >= turn:
        return SHIFTS[int(np.argmax(np.abs(way[:3])))]
    return TURNS[int(np.argmax(np.abs(way[3:])))]
