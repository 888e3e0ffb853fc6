"""The marker: its model, and its occurrences in an image."""

from tracker.marker.model import MarkerModel

__all__ = ["MarkerModel"]
