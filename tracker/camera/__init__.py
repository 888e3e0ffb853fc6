"""The camera: its model (pinhole and lens)."""

from tracker.camera.model import CameraModel

__all__ = ["CameraModel"]
