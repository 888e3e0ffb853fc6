"""Photometric (direct) pose refinement of a planar marker.

A prerendered, blurred texture of the marker is compared with the grey levels of the image, and pose, blur,
camera response and illumination are fitted together. The package does not search: a start within about half
a pixel is required.
"""

from tracker.photometric.illumination import KnownIllumination
from tracker.photometric.inner_region import MIN_INLIER_RATIO
from tracker.photometric.refinement import RefinedPose, refine_poses
from tracker.photometric.samples import OccludedAt
from tracker.photometric.texture import Textures, textures_of

__all__ = [
    "MIN_INLIER_RATIO",
    "KnownIllumination",
    "OccludedAt",
    "RefinedPose",
    "Textures",
    "refine_poses",
    "textures_of",
]
