"""Dark regions: adaptive threshold, quads that regions fill, and border segments."""

from tracker.regions.dark_regions import (
    Regions,
    border_segments,
    dark_mask,
    noise_grey,
    normalise_illumination,
    quads_of,
    regions_of_mask,
)

__all__ = [
    "Regions",
    "border_segments",
    "dark_mask",
    "noise_grey",
    "normalise_illumination",
    "quads_of",
    "regions_of_mask",
]
