"""Edges of an image: gradient with its noise threshold, edgels, chains and their straight segments.

The gradient is the paper's equations 6 and 7. Edgels are local maxima of its magnitude across an edge, with
sub-pixel position (section 2.3).
"""

from dataclasses import dataclass
from math import isnan
from typing import TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from tracker.edges.edge_kernels import (
    find_edgels,
    join_collinear,
    link_edgels,
    median_magnitude,
    split_straight,
    trace_chains,
)

GreyImage: TypeAlias = npt.NDArray[np.uint8]
GradientImage: TypeAlias = npt.NDArray[np.int16]

# A step of h grey levels gives a Sobel response of up to 4 h.
SOBEL_GAIN = 4.0
# The gradient magnitude of pure noise has a Rayleigh distribution with median 1.18 sd. One noise pixel in 500
# exceeds three medians; non-maximum suppression and chaining remove those.
NOISE_MEDIANS = 3.0
# Contrasts under 3 grey levels are indistinguishable from 8-bit quantisation; texture must not raise the
# threshold above a dimly lit marker.
MIN_THRESHOLD, MAX_THRESHOLD = 3.0 * SOBEL_GAIN, 110.0
SAMPLE_STRIDE = 7
Float32 = npt.NDArray[np.float32]
Int32 = npt.NDArray[np.int32]
MIN_CHAIN_EDGELS = 5
# Half of the deviation of an edge that is straight in the world from a line in the image: lens distortion,
# blur at the corners, noise.
STRAIGHT_TOLERANCE_PX = 0.9
JOIN_GAP_PX, JOIN_OFF_PX, JOIN_COS = 8.0, 1.2, 0.97


@dataclass(frozen=True, slots=True, kw_only=True)
class Gradient:
    """The gradient of an image or of a window of it.

    Attributes:
        x: (h, w), derivative to the right, Sobel's scale (4 per grey level of a step).
        y: (h, w), derivative downwards.
        left_px: column of the image at which the window starts.
        top_px: row of the image at which it starts.
        threshold: gradient magnitude below which a response counts as noise.
    """

    x: GradientImage
    y: GradientImage
    left_px: int
    top_px: int
    threshold: float


def gradient_of(image: GreyImage, *, left_px: int = 0, top_px: int = 0) -> Gradient:
    """Compute the gradient of a grey image (h, w), or of a window that starts at (left_px, top_px)."""
    x, y = cv2.spatialGradient(image)
    gx, gy = np.asarray(x, dtype=np.int16), np.asarray(y, dtype=np.int16)
    return Gradient(x=gx, y=gy, left_px=left_px, top_px=top_px, threshold=noise_threshold(gx, gy))


def noise_threshold(x: GradientImage, y: GradientImage) -> float:
    """Return the gradient magnitude that noise rarely exceeds, from the median over a sparse grid."""
    median = float(median_magnitude(x, y, SAMPLE_STRIDE))
    if isnan(median):
        return MIN_THRESHOLD
    return min(max(NOISE_MEDIANS * median, MIN_THRESHOLD), MAX_THRESHOLD)


@dataclass(frozen=True, slots=True, kw_only=True)
class Edgels:
    """The edge elements of an image.

    Attributes:
        x, y: (n,), position in px of the gradient's window, sub-pixel.
        nx, ny: (n,), unit direction of the gradient: from dark to bright, across the edge.
        strength: (n,), gradient magnitude.
        at: (h, w), index of the edgel in each pixel, -1 where there is none.
    """

    x: Float32
    y: Float32
    nx: Float32
    ny: Float32
    strength: Float32
    at: Int32


def edgels_of(gradient: Gradient) -> Edgels:
    """Return all edgels above the gradient's noise threshold, in row order."""
    x, y, nx, ny, strength, at = find_edgels(gradient.x, gradient.y, np.float32(gradient.threshold))
    return Edgels(x=x, y=y, nx=nx, ny=ny, strength=strength, at=at)


# Chains have the dark side on the right. The outline of a dark square is therefore clockwise on the screen,
# and edges of opposite polarity are never linked.


@dataclass(frozen=True, slots=True, kw_only=True)
class Chains:
    """Edgels in order along their edges.

    Attributes:
        order: (m,), indexes of edgels, chain after chain.
        starts: (c + 1,), start of each chain in `order`; the last entry is m.
        closed: (c,), whether a chain is closed.
    """

    order: Int32
    starts: Int32
    closed: npt.NDArray[np.bool_]


def chains_of(edgels: Edgels) -> Chains:
    """Link edgels to chains of at least five edgels."""
    successor, predecessor = link_edgels(edgels.nx, edgels.ny, edgels.strength, edgels.at)
    order, starts, closed = trace_chains(successor, predecessor, edgels.x, edgels.y, MIN_CHAIN_EDGELS)
    return Chains(order=order, starts=starts, closed=closed)


def segments_of(edgels: Edgels, chains: Chains, *, min_length_px: float) -> npt.NDArray[np.float32]:
    """Return straight segments (s, 4) of the chains: start x, y and end x, y, dark side on the right."""
    off, minimum = np.float32(STRAIGHT_TOLERANCE_PX), np.float32(min_length_px)
    return np.asarray(
        split_straight(edgels.x, edgels.y, chains.order, chains.starts, off, minimum), np.float32
    )


def straight_pieces(
    x: Float32, y: Float32, starts: Int32, *, off_px: float, min_length_px: float
) -> npt.NDArray[np.float32]:
    """Split polylines x, y (n,) into straight segments (s, 4), and join collinear ones.

    Each polyline begins at one of `starts`. No point is farther from its segment than `off_px`.
    """
    order = np.arange(len(x), dtype=np.int32)
    pieces = split_straight(x, y, order, starts, np.float32(off_px), np.float32(min_length_px))
    pieces = np.asarray(pieces, dtype=np.float32)
    return np.concatenate([pieces, joined_segments(pieces)])


def joined_segments(segments: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Join collinear segments across gaps from specks or faint edges; return the joined segments (j, 4)."""
    if len(segments) < 2:
        return np.empty((0, 4), np.float32)
    return np.asarray(
        join_collinear(segments, np.float32(JOIN_GAP_PX), np.float32(JOIN_OFF_PX), np.float32(JOIN_COS)),
        dtype=np.float32,
    )
