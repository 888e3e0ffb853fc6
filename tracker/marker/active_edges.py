"""Active edges of the model: the edges that remain visible at a given size in the image."""

from dataclasses import dataclass, field

import cv2
import numpy as np
import numpy.typing as npt

from tracker.edges import chains_of, edgels_of
from tracker.edges.edge_detection import Gradient
from tracker.geometry import Array

# Sizes of the marker in the image for which active edges are stored, a factor of 1.4 apart.
LEVELS_PX = (12, 17, 24, 34, 48, 68, 96, 136, 192)
# Model pixels per image pixel, so that edgels are located to a hundredth of an image pixel.
OVERSAMPLING = 6
# Blur of a camera in focus (0.6 px), of its pixel (0.3) and of the Sobel filter's smoothing (0.7), together.
BLUR_PX = 1.0
# White paper around the square, as a fraction of its side.
MARGIN_RATIO = 0.25
# Edges closer than about two pixels reduce each other's contrast; below this ratio to the contrast of an
# isolated edge they are not active.
MIN_STRENGTH_RATIO = 0.3
MAX_EDGELS = 360
# Distance in image pixels, on both sides, of the edgels that determine an edge's direction.
CORNER_REACH_PX = 1.6
MAX_CORNER_TURN_COS = 0.9


@dataclass(frozen=True, slots=True, kw_only=True)
class StraightEdges:
    """The active edges without a corner nearby, which the pose fit uses.

    Attributes:
        points_mm: (m, 2), in the marker's plane.
        normals: (m, 2), unit, from dark to bright.
        strength_ratio: (m,), contrast over that of an isolated edge, 0..1.
        weight: sum of their weights, at least 1.
        spacing_ratio: distance between active edges, by the marker's side.
    """

    points_mm: Array
    normals: Array
    strength_ratio: Array
    weight: float
    spacing_ratio: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ActiveEdges:
    """Active edges of a model at one size, as edgels about a pixel apart, weighted by length.

    Attributes:
        level_px: side of the marker in the image for which they are valid.
        points_mm: (n, 2), in the marker's plane.
        normals: (n, 2), unit, from dark to bright.
        length_mm: (n,), edge length that each edgel represents.
        strength_ratio: (n,), contrast over that of an isolated edge, 0..1.
        inner: (n,), not part of the outline of the square.
        straight: (n,), no corner nearby: only these constrain the position.
        fitted: the straight edges only; derived.
        sides: (n,), straight edges of the outline; derived.
        half_mm: largest |x| or |y| of the points; derived.
    """

    level_px: int
    points_mm: Array
    normals: Array
    length_mm: Array
    strength_ratio: Array
    inner: npt.NDArray[np.bool_]
    straight: npt.NDArray[np.bool_]
    fitted: StraightEdges = field(init=False, repr=False, compare=False)
    sides: npt.NDArray[np.bool_] = field(init=False, repr=False, compare=False)
    half_mm: float = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        farthest = float(np.abs(self.points_mm).max()) if len(self.points_mm) else 0.0
        object.__setattr__(self, "sides", self.straight & ~self.inner)
        object.__setattr__(self, "half_mm", farthest)
        chosen, strength = self.straight, self.strength_ratio[self.straight]
        side_mm = float(np.ptp(self.points_mm, axis=0).max()) if len(self.points_mm) else 1.0
        fitted = StraightEdges(
            points_mm=np.ascontiguousarray(self.points_mm[chosen]),
            normals=np.ascontiguousarray(self.normals[chosen]),
            strength_ratio=strength,
            weight=max(float(strength.sum()), 1.0),
            spacing_ratio=float(np.median(self.length_mm)) / side_mm if len(self.length_mm) else 1.0,
        )
        object.__setattr__(self, "fitted", fitted)


def active_edges_at(square: npt.NDArray[np.uint8], *, side_mm: float, level_px: int) -> ActiveEdges:
    """Extract the active edges of a grey square (n, n) that appears `level_px` wide."""
    picture, scale, margin = _seen_at(square, level_px)
    x = np.asarray(cv2.Sobel(picture, cv2.CV_32F, 1, 0), dtype=np.float32)
    y = np.asarray(cv2.Sobel(picture, cv2.CV_32F, 0, 1), dtype=np.float32)
    upper = np.s_[margin, margin : margin + scale]
    free = float(np.percentile(np.hypot(x[upper], y[upper]), 50))
    quantise = np.float32(8000.0 / max(free, 1e-6))
    gradient = Gradient(
        x=_whole_numbers(x, quantise),
        y=_whole_numbers(y, quantise),
        left_px=0,
        top_px=0,
        threshold=8000.0 * MIN_STRENGTH_RATIO,
    )
    edgels = edgels_of(gradient)
    chains = chains_of(edgels)
    mm_per_px = side_mm / scale
    selected: list[npt.NDArray[np.int64]] = []
    lengths: list[Array] = []
    straight: list[npt.NDArray[np.bool_]] = []
    for k in range(len(chains.closed)):
        chain = chains.order[chains.starts[k] : chains.starts[k + 1]].astype(np.int64)
        if len(chain) < OVERSAMPLING:
            continue
        points = np.stack([edgels.x[chain], edgels.y[chain]], axis=1).astype(np.float64)
        picked, spacing = _every_pixel(points, closed=bool(chains.closed[k]))
        selected.append(chain[picked])
        lengths.append(np.full(len(picked), spacing * mm_per_px))
        straight.append(_away_from_corners(edgels.nx[chain], edgels.ny[chain], picked))
    index, length, plain = _thin(selected, lengths, straight)
    centre = margin + scale / 2.0 - 0.5
    u = (edgels.x[index].astype(np.float64) - centre) * mm_per_px
    v = (edgels.y[index].astype(np.float64) - centre) * mm_per_px
    # The outline lies on the border of the square; within a pixel of it is the outline.
    near_border = side_mm / 2.0 - 1.2 * side_mm / level_px
    return ActiveEdges(
        level_px=level_px,
        points_mm=np.stack([u, -v], axis=1),
        normals=np.stack([edgels.nx[index], -edgels.ny[index]], axis=1).astype(np.float64),
        length_mm=length,
        strength_ratio=np.minimum(edgels.strength[index].astype(np.float64) / 8000.0, 1.0),
        inner=np.maximum(np.abs(u), np.abs(v)) < near_border,
        straight=plain,
    )


def _seen_at(square: npt.NDArray[np.uint8], level_px: int) -> tuple[npt.NDArray[np.float32], int, int]:
    """Return the model on white paper with camera blur, its side and the margin in px."""
    scale = level_px * OVERSAMPLING
    mode = cv2.INTER_AREA if scale < square.shape[0] else cv2.INTER_LINEAR
    seen = cv2.resize(square, (scale, scale), interpolation=mode).astype(np.float32)
    white = float(np.percentile(square, 98))
    margin = max(int(MARGIN_RATIO * scale), 4 * OVERSAMPLING)
    paper = cv2.copyMakeBorder(seen, margin, margin, margin, margin, cv2.BORDER_CONSTANT, value=(white,))
    blurred = cv2.GaussianBlur(paper, (0, 0), BLUR_PX * OVERSAMPLING)
    return np.asarray(blurred, dtype=np.float32), scale, margin


def _whole_numbers(slopes: npt.NDArray[np.float32], quantise: np.float32) -> npt.NDArray[np.int16]:
    """Scale slopes and round to int16; `slopes` is overwritten to save memory."""
    np.multiply(slopes, quantise, out=slopes)
    np.clip(slopes, -32000, 32000, out=slopes)
    return slopes.astype(np.int16)


def _every_pixel(points: Array, *, closed: bool) -> tuple[npt.NDArray[np.int64], float]:
    """Return the indexes of edgels of a chain (n, 2) one image pixel apart, and their exact spacing."""
    ends = np.vstack([points, points[:1]]) if closed else points
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(ends, axis=0), axis=1))])
    count = max(round(float(along[-1]) / OVERSAMPLING), 1)
    wanted = (np.arange(count) + 0.5) * (along[-1] / count)
    picked = np.clip(np.searchsorted(along, wanted), 0, len(points) - 1)
    return picked.astype(np.int64), float(along[-1] / count)


def _away_from_corners(
    nx: npt.NDArray[np.float32], ny: npt.NDArray[np.float32], picked: npt.NDArray[np.int64]
) -> npt.NDArray[np.bool_]:
    """Return whether the edge keeps its direction on both sides of each picked edgel."""
    reach = int(CORNER_REACH_PX * OVERSAMPLING)
    before = np.clip(picked - reach, 0, len(nx) - 1)
    after = np.clip(picked + reach, 0, len(nx) - 1)
    return np.asarray(nx[before] * nx[after] + ny[before] * ny[after] > MAX_CORNER_TURN_COS)


def _thin(
    selected: list[npt.NDArray[np.int64]], lengths: list[Array], straight: list[npt.NDArray[np.bool_]]
) -> tuple[npt.NDArray[np.int64], Array, npt.NDArray[np.bool_]]:
    """Reduce to at most `MAX_EDGELS`, evenly; each represents more of the length."""
    if not selected:
        return np.empty(0, np.int64), np.empty(0), np.empty(0, np.bool_)
    index, length, plain = np.concatenate(selected), np.concatenate(lengths), np.concatenate(straight)
    step = -(-len(index) // MAX_EDGELS)
    return index[::step], length[::step] * step, plain[::step]
