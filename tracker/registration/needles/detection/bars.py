"""Detect bars: pairs of antiparallel straight edges."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

Image8 = npt.NDArray[np.uint8]
SHORTEST_EDGE_PX = 7.0
MAX_SKEW_DEG = 7.0
MIN_SHARED_PX = 6.0
SAME_PX, SAME_DEG = 2.5, 6.0
SHORTEST_HALF_PX = 10.0
BESIDE_PX, MAX_CROSSED_DEG = 25.0, 50.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Bar:
    """A piece of a bar.

    Attributes:
        middle_px: (2,), on its centre line.
        along: (2,), unit.
        width_px: from edge to edge.
        length_px: over which both edges overlap.
    """

    middle_px: Array
    along: Array
    width_px: float
    length_px: float


def bars(grey: Image8, narrowest_px: float, widest_px: float) -> list[Bar]:
    """Return bars within a width range in a grey image (h, w), the longest first, without duplicates."""
    edges = straight_edges(grey)
    line = edges[:, 2:] - edges[:, :2]
    length = np.hypot(line[:, 0], line[:, 1])
    edges, line, length = (one[length >= SHORTEST_EDGE_PX] for one in (edges, line, length))
    along = line / length[:, None]
    pieces = []
    for n in range(len(edges)):
        start, direction, beside = edges[n, :2], along[n], np.array([-along[n, 1], along[n, 0]])
        # An edge's direction encodes its bright side, so the two edges of a bar are antiparallel.
        facing = along @ direction < -np.cos(np.radians(MAX_SKEW_DEG))
        first, second = (edges[:, :2] - start) @ direction, (edges[:, 2:] - start) @ direction
        low = np.maximum(np.minimum(first, second), 0.0)
        high = np.minimum(np.maximum(first, second), length[n])
        middle = 0.5 * (edges[:, :2] + edges[:, 2:])
        # The distance within the overlap, so that a slight skew of long edges has no effect.
        shared = start + (0.5 * (low + high))[:, None] * direction
        at = np.einsum("ij,ij->i", shared - middle, -along)
        width = (middle - at[:, None] * along - shared) @ beside
        good = facing & (high - low >= MIN_SHARED_PX)
        good &= (np.abs(width) >= narrowest_px) & (np.abs(width) <= widest_px)
        for m in np.flatnonzero(good):
            if m > n:
                mean = direction - along[m]
                pieces.append(
                    Bar(
                        middle_px=shared[m] + 0.5 * width[m] * beside,
                        along=mean / np.linalg.norm(mean),
                        width_px=float(abs(width[m])),
                        length_px=float(high[m] - low[m]),
                    )
                )
    return _each_once(sorted(pieces, key=lambda one: -one.length_px))


def straight_edges(grey: Image8) -> Array:
    """Return line segments (n, 4) of a grey image (h, w): x and y of both ends (LSD)."""
    found: object = cv2.createLineSegmentDetector(cv2.LSD_REFINE_STD).detect(grey)[0]
    return np.zeros((0, 4)) if found is None else np.asarray(found, dtype=np.float64).reshape(-1, 4)


def single_edge_bars(grey: Image8, width_px: float, beside: Sequence[Bar]) -> list[Bar]:
    """Return bars with one visible edge, near others; crossing needles occlude each other.

    Args:
        grey: (h, w).
        width_px: expected width.
        beside: bars near which to search.
    """
    edges = straight_edges(grey)
    middles, lines = 0.5 * (edges[:, :2] + edges[:, 2:]), edges[:, 2:] - edges[:, :2]
    lengths = np.hypot(lines[:, 0], lines[:, 1])
    out = []
    for n in np.argsort(-lengths):
        if lengths[n] < SHORTEST_HALF_PX:
            break
        along = lines[n] / lengths[n]
        if not any(_is_beside(bar, middles[n], along) for bar in beside):
            continue
        aside = 0.5 * width_px * np.array([-along[1], along[0]])
        out += [
            Bar(middle_px=at, along=along, width_px=width_px, length_px=float(lengths[n]))
            for at in (middles[n] + aside, middles[n] - aside)
            if not any(is_collinear(bar, at, along) for bar in beside)
        ]
    return out


def _is_beside(bar: Bar, middle_px: Array, along: Array) -> bool:
    off = middle_px - bar.middle_px
    reach = 0.5 * bar.length_px + BESIDE_PX
    return bool(np.hypot(off[0], off[1]) < reach) and abs(float(along @ bar.along)) > np.cos(
        np.radians(MAX_CROSSED_DEG)
    )


def is_collinear(bar: Bar, middle_px: Array, along: Array) -> bool:
    """Return whether a straight line through a point (2,) is that of the bar."""
    beside = np.array([-bar.along[1], bar.along[0]])
    turned = abs(float(along @ beside))
    return abs(float((middle_px - bar.middle_px) @ beside)) < SAME_PX and turned < np.sin(
        np.radians(SAME_DEG)
    )


def _each_once(pieces: list[Bar]) -> list[Bar]:
    retained: list[Bar] = []
    for piece in pieces:
        near = [one for one in retained if np.linalg.norm(one.middle_px - piece.middle_px) < 60.0]
        if not any(is_collinear(one, piece.middle_px, piece.along) for one in near):
            retained.append(piece)
    return retained
