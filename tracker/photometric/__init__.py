"""Photometric (direct) pose refinement of a planar marker.

A prerendered, blurred texture of the marker is compared with the grey levels of the image, and pose, blur,
camera response and illumination are fitted together. The package does not search: a start within about half
a pixel is required.
"""

from tracker.photometric.focal_length import (
    MAX_FOCAL_LENGTH_ERROR_RATIO,
    FocalLengthError,
    focal_length_error,
)
from tracker.photometric.illumination import KnownIllumination
from tracker.photometric.inner_region import MIN_INLIER_RATIO
from tracker.photometric.refinement import RefinedPose, refine_poses
from tracker.photometric.samples import OccludedAt
from tracker.photometric.texture import Textures, textures_of

__all__ = [
    "MAX_FOCAL_LENGTH_ERROR_RATIO",
    "MIN_INLIER_RATIO",
    "FocalLengthError",
    "KnownIllumination",
    "OccludedAt",
    "RefinedPose",
    "Textures",
    "focal_length_error",
    "refine_poses",
    "textures_of",
]
