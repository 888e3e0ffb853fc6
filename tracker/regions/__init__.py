"""Dark regions: what is darker than its surroundings, the four sides of its outline, its borders."""

from tracker.regions.dark import (
    Regions,
    border_segments,
    dark_mask,
    even_image,
    noise_grey,
    quads_of,
    regions_of_mask,
)

__all__ = [
    "Regions",
    "border_segments",
    "dark_mask",
    "even_image",
    "noise_grey",
    "quads_of",
    "regions_of_mask",
]
