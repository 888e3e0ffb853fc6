"""Landmarks on the bone surface, and intersection of rays from inside with the surface."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from tracker.geometry import Array
from tracker.rehearsal.anatomy import bone_field, bone_normals

MAX_DISTANCE_MM, COARSE_MM, HALVINGS = 30.0, 0.5, 24

# Name, a point inside the bone, and the direction from it to the landmark. Left is x > 0; y is posterior.
ANCHORS = (
    ("left transverse process, tip", (40.5, 13.3, 5.8), (0.45, 0.85, 0.0)),
    ("left superior articular process, top", (20.2, 13.5, 21.0), (0.0, 0.75, 0.66)),
    ("spinous process, upper end", (0.0, 46.0, -7.0), (0.0, 0.93, 0.37)),
    ("right transverse process, tip", (-40.5, 13.3, 5.8), (-0.45, 0.85, 0.0)),
    ("right inferior articular process, tip", (-13.2, 17.0, -24.0), (0.0, 0.80, -0.60)),
    ("spinous process, lower end", (0.0, 46.0, -17.5), (0.0, 0.60, -0.80)),
    ("left inferior articular process, tip", (13.2, 17.0, -24.0), (0.0, 0.80, -0.60)),
)
CHECK_ANCHOR = ("left mammillary process", (21.5, 17.5, 13.0), (0.35, 0.94, 0.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class Landmark:
    """A named point of the bone surface.

    Attributes:
        name: in words.
        point_in_vertebra_mm: (3,), LPS.
        outwards: (3,), unit, the surface's normal.
    """

    name: str
    point_in_vertebra_mm: Array
    outwards: Array


@lru_cache(maxsize=1)
def registration_landmarks() -> tuple[Landmark, ...]:
    """Return the landmarks for registration, in capture order."""
    return tuple(_landmark(*anchor) for anchor in ANCHORS)


@lru_cache(maxsize=1)
def check_landmark() -> Landmark:
    """Return the landmark that is reserved for the check."""
    return _landmark(*CHECK_ANCHOR)


def surface_exits(inside_mm: Array, outwards: Array) -> Array:
    """Return where rays from points (n, 3) inside the bone along unit directions (n, 3) first exit."""
    steps = np.arange(0.0, MAX_DISTANCE_MM, COARSE_MM)
    outside = bone_field(inside_mm[:, None] + steps[:, None] * outwards[:, None]) > 0.0
    first = np.argmax(outside, axis=1)
    low, high = steps[np.maximum(first - 1, 0)], steps[first]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        out = bone_field(inside_mm + middle[:, None] * outwards) > 0.0
        low, high = np.where(out, low, middle), np.where(out, middle, high)
    return np.asarray(inside_mm + (0.5 * (low + high))[:, None] * outwards, dtype=np.float64)


def _landmark(name: str, inside: tuple[float, ...], way: tuple[float, ...]) -> Landmark:
    direction = np.array([way]) / np.linalg.norm(way)
    point = surface_exits(np.array([inside]), direction)
    return Landmark(name=name, point_in_vertebra_mm=point[0], outwards=bone_normals(point)[0])
