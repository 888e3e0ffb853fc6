"""Chains of linked edgels, and their straight segments."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.edges.edge_kernels import join_collinear, link_edgels, split_straight, trace_chains
from tracker.edges.edgels import Edgels, Float32, Int32

# Chains have the dark side on the right. The outline of a dark square is therefore clockwise on the screen,
# and edges of opposite polarity are never linked.

MIN_CHAIN_EDGELS = 5
# Half of the deviation of an edge that is straight in the world from a line in the image: lens distortion,
# blur at the corners, noise.
STRAIGHT_TOLERANCE_PX = 0.9
JOIN_GAP_PX, JOIN_OFF_PX, JOIN_COS = 8.0, 1.2, 0.97


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
