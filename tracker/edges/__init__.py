"""Edges: gradient, edgels with sub-pixel position, chains and their straight segments."""

from tracker.edges.chains import Chains, chains_of, joined_segments, segments_of, straight_pieces
from tracker.edges.edgels import Edgels, edgels_of
from tracker.edges.gradient import Gradient, GreyImage, gradient_of

__all__ = [
    "Chains",
    "Edgels",
    "Gradient",
    "GreyImage",
    "chains_of",
    "edgels_of",
    "gradient_of",
    "joined_segments",
    "segments_of",
    "straight_pieces",
]
