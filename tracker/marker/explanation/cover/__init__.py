"""What lies over a square from outside, and what inside it contradicts the model."""

from tracker.marker.explanation.cover.cover import (
    MIN_AREA_RATIO,
    PART_CONTRAST,
    Left,
    Mask,
    covered,
    weights_beside_a_cover,
)

__all__ = ["MIN_AREA_RATIO", "PART_CONTRAST", "Left", "Mask", "covered", "weights_beside_a_cover"]
