"""The stages of the tracker in order: grey image, candidates, gradient, fit, score, verification."""

from tracker.pipeline.image import is_same_image
from tracker.pipeline.tracker import Tracker

__all__ = ["Tracker", "is_same_image"]
