"""The camera: pinhole model with lens distortion, calibration boards, controls and lamp flicker."""

from tracker.camera.boards import (
    AprilGridBoard,
    Board,
    CharucoBoard,
    CharucoLayout,
    CheckerBoard,
    DotBoard,
    DotLayout,
)
from tracker.camera.controls import GEOMETRIC, CameraControl, ControlChange, control_changes
from tracker.camera.flicker import FlickerMonitor, LampFlicker
from tracker.camera.model import CameraModel

__all__ = [
    "GEOMETRIC",
    "AprilGridBoard",
    "Board",
    "CameraControl",
    "CameraModel",
    "CharucoBoard",
    "CharucoLayout",
    "CheckerBoard",
    "ControlChange",
    "DotBoard",
    "DotLayout",
    "FlickerMonitor",
    "LampFlicker",
    "control_changes",
]
