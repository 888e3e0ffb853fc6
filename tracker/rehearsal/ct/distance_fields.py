"""Signed distance functions of the solids of a phantom."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from tracker.geometry import Array


class Part(Protocol):
    """A solid with a signed distance function."""

    def distance_mm(self, points_mm: Array) -> Array:
        """Return the signed distance (n,) of points (n, 3), negative inside; exact at the surface."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EllipticTube:
    """A pedicle: a bar with an elliptic section that may widen from its waist and bend.

    Attributes:
        waist_mm: (3,), centre of the narrowest section.
        axis: unit (3,), its direction at the waist.
        across: unit (3,), the direction of the width, across the axis.
        width_mm: full width at the waist, along `across`.
        height_mm: full height at the waist, across axis and width.
        widening_per_mm2: the section grows by this factor times the squared distance from the waist.
        bend_per_mm: curvature of the centre line towards `across`; 0 is straight.
        start_mm: where it begins along its axis, from the waist (negative: behind).
        end_mm: where it ends.
    """

    waist_mm: Array
    axis: Array
    across: Array
    width_mm: float
    height_mm: float
    widening_per_mm2: float = 0.0
    bend_per_mm: float = 0.0
    start_mm: float = -15.0
    end_mm: float = 24.0

    def distance_mm(self, points_mm: Array) -> Array:
        """See `Part`."""
        from_waist = points_mm - self.waist_mm
        s = from_waist @ self.axis
        clipped = np.clip(s, self.start_mm, self.end_mm)
        growth = 1.0 + self.widening_per_mm2 * clipped**2
        u = from_waist @ self.across - 0.5 * self.bend_per_mm * clipped**2
        v = from_waist @ np.cross(self.axis, self.across)
        a, b = 0.5 * self.width_mm * growth, 0.5 * self.height_mm * growth
        wall = _oval_distance(u, v, a, b)
        return np.asarray(np.maximum(wall, np.maximum(self.start_mm - s, s - self.end_mm)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Drum:
    """An upright elliptic cylinder: a vertebral body or a disc.

    Attributes:
        centre_mm: (3,).
        half_mm: half of its width (x), depth (y) and height (z).
    """

    centre_mm: Array
    half_mm: tuple[float, float, float]

    def distance_mm(self, points_mm: Array) -> Array:
        """See `Part`."""
        p = points_mm - self.centre_mm
        wall = _oval_distance(p[:, 0], p[:, 1], self.half_mm[0], self.half_mm[1])
        return np.asarray(np.maximum(wall, np.abs(p[:, 2]) - self.half_mm[2]))


@dataclass(frozen=True, slots=True, kw_only=True)
class Block:
    """An axis-aligned box.

    Attributes:
        centre_mm: (3,).
        half_mm: half of its sides.
    """

    centre_mm: Array
    half_mm: tuple[float, float, float]

    def distance_mm(self, points_mm: Array) -> Array:
        """See `Part`."""
        x, y, z = (
            np.abs(at - c) - h for at, c, h in zip(points_mm.T, self.centre_mm, self.half_mm, strict=True)
        )
        return np.asarray(np.maximum(np.maximum(x, y), z))


@dataclass(frozen=True, slots=True, kw_only=True)
class Rod:
    """A capsule: a rib, a process, a metal rod.

    Attributes:
        start_mm: (3,).
        end_mm: (3,).
        radius_mm: of the bar.
    """

    start_mm: Array
    end_mm: Array
    radius_mm: float

    def distance_mm(self, points_mm: Array) -> Array:
        """See `Part`."""
        along = self.end_mm - self.start_mm
        from_start = points_mm - self.start_mm
        share = np.clip(from_start @ along / (along @ along), 0.0, 1.0)
        x, y, z = (at - share * by for at, by in zip(from_start.T, along, strict=True))
        return np.asarray(np.sqrt(x * x + y * y + z * z) - self.radius_mm)


@dataclass(frozen=True, slots=True, kw_only=True)
class ContrastTube:
    """A solid beside the bone with constant HU: a vessel with contrast, a metal rod, lung.

    Attributes:
        part: its shape.
        hu: its number.
    """

    part: Part
    hu: float


def _oval_distance(u: Array, v: Array, a: Array | float, b: Array | float) -> Array:
    """Return the first-order distance to an ellipse: exact on it, within a few percent 1 mm away."""
    q = np.sqrt((u / a) ** 2 + (v / b) ** 2)
    slope = np.sqrt((u / (a * a)) ** 2 + (v / (b * b)) ** 2) / np.maximum(q, 1e-9)
    return np.asarray((q - 1.0) / np.maximum(slope, 1.0 / (2.0 * np.maximum(a, b))))
