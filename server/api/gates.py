"""The gates: what a marker, a calibration, a tool and a registration must reach, as the settings have it."""

from fastapi import APIRouter

from server.config import (
    CalibrationConfig,
    Config,
    RegistrationConfig,
    ToolCalibrationConfig,
    TrackerConfig,
)
from server.stream.messages import Message
from tracker.camera.collecting import CollectingSettings


class CollectingMessage(Message):
    """When there are enough views of a board."""

    min_views: int
    min_coverage_ratio: float
    """How much of the image the board must have been in."""
    min_tilt_deg: float
    """To every side."""


class GatesMessage(Message):
    """Every limit that a step is held against; nothing in it changes while the server runs."""

    tracker: TrackerConfig
    collecting: CollectingMessage
    calibration: CalibrationConfig
    tool_calibration: ToolCalibrationConfig
    registration: RegistrationConfig


def gates_router(config: Config) -> APIRouter:
    """`GET /api/gates`."""
    router = APIRouter(prefix="/api/gates", tags=["procedure"])
    wanted = CollectingSettings()
    message = GatesMessage(
        tracker=config.tracker,
        collecting=CollectingMessage(
            min_views=wanted.min_views,
            min_coverage_ratio=wanted.min_coverage_ratio,
            min_tilt_deg=wanted.min_tilt_deg,
        ),
        calibration=config.calibration,
        tool_calibration=config.tool_calibration,
        registration=config.registration,
    )

    @router.get("")
    def gates() -> GatesMessage:
        """What each step is held against."""
        return message

    return router
