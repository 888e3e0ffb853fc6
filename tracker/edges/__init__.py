"""Edges: gradient, edgels with sub-pixel position, chains and their straight segments."""

from tracker.edges.edge_detection import (
    Chains,
    Edgels,
    Gradient,
    GreyImage,
    chains_of,
    edgels_of,
    gradient_of,
    joined_segments,
    segments_of,
    straight_pieces,
)

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
