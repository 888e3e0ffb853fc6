"""Acceptance limits (gates) of marker, calibration, tool and registration from the settings."""

from fastapi import APIRouter

from server.config import (
    CalibrationConfig,
    Config,
    RegistrationConfig,
    ToolCalibrationConfig,
    TrackerConfig,
)
from server.stream.messages import Message
from tracker.camera.board_collector import BoardCollectorSettings


class CollectingMessage(Message):
    """Requirements for the views of a calibration board."""

    min_views: int
    min_coverage_ratio: float
    """Fraction of the image that the views must cover."""
    min_tilt_deg: float
    """In every direction."""


class GatesMessage(Message):
    """Acceptance limits of all steps, constant while the server runs."""

    tracker: TrackerConfig
    collecting: CollectingMessage
    calibration: CalibrationConfig
    tool_calibration: ToolCalibrationConfig
    registration: RegistrationConfig


def gates_router(config: Config) -> APIRouter:
    """Return the router of `GET /api/gates`."""
    router = APIRouter(prefix="/api/gates", tags=["procedure"])
    wanted = BoardCollectorSettings()
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
        """Return the acceptance limits of all steps."""
        return message

    return router
