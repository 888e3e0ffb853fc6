"""The camera: its model (pinhole and lens), and the boards that it is calibrated with."""

from tracker.camera.boards import Board, CharucoBoard, CharucoLayout, CheckerBoard, DotBoard, DotLayout
from tracker.camera.model import CameraModel

__all__ = [
    "Board",
    "CameraModel",
    "CharucoBoard",
    "CharucoLayout",
    "CheckerBoard",
    "DotBoard",
    "DotLayout",
]
