"""Photometric verification: do the pixels of a square match the model under blur, illumination and occlusion?

The model is first compared without a fit. Position, blur and illumination are then fitted in steps, while
these can reduce the residuals.
"""

from tracker.marker.photometric_fit.acceptance import PhotometricFit
from tracker.marker.photometric_fit.estimator import local_ncc_at
from tracker.marker.photometric_fit.scale_space import ScaleSpace, scale_space_of
from tracker.marker.photometric_fit.shape_mismatch import ShapeMismatch, shape_mismatch_of
from tracker.marker.photometric_fit.verification import matches_under_saturation, photometric_fit_of

__all__ = [
    "PhotometricFit",
    "ScaleSpace",
    "ShapeMismatch",
    "local_ncc_at",
    "matches_under_saturation",
    "photometric_fit_of",
    "scale_space_of",
    "shape_mismatch_of",
]
