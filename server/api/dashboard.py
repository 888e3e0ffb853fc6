"""Start-up data of the page."""

from fastapi import APIRouter

from server.api.alarms import ARMED_EVERY_S, SoundMessage, sound_messages
from server.config import Config
from server.installation import product_version
from server.overlay.panel_readings import RESEARCH_SOFTWARE
from server.stream.message import Message

PRODUCT = "Coaxial"


class CameraMessage(Message):
    """A camera and the addresses of its video."""

    name: str
    video_path: str
    """MJPEG with the overlay burned in."""
    view_path: str
    """WebSocket with image and pose of one instant in one message."""


class LimitsMessage(Message):
    """Ages from which data count as stale."""

    pose_stale_after_ms: float
    video_stale_after_ms: float
    scene_stale_after_ms: float


class PathsMessage(Message):
    """Addresses of the other services."""

    live: str
    """WebSocket with one `LiveMessage` for each instant."""
    scene: str
    documentation: str
    health: str
    metrics: str


class DashboardMessage(Message):
    """Start-up data of the page, constant while the server runs."""

    product: str
    version: str
    notice: str
    """Notice for every page."""
    cameras: list[CameraMessage]
    limits: LimitsMessage
    scene_available: bool
    paths: PathsMessage
    sounds: list[SoundMessage]
    """Alarm sounds, highest priority first."""
    armed_every_s: float
    """Period of the sound reports of a screen."""


def dashboard_message(config: Config, *, scene_available: bool) -> DashboardMessage:
    """Return the start-up data for these settings."""
    name = config.camera.name
    limits = config.limits
    return DashboardMessage(
        product=PRODUCT,
        version=product_version(),
        notice=RESEARCH_SOFTWARE,
        cameras=[
            CameraMessage(name=name, video_path=f"/video/{name}.mjpg", view_path=f"/ws/view?camera={name}")
        ],
        limits=LimitsMessage(
            pose_stale_after_ms=limits.pose_stale_after_ms,
            video_stale_after_ms=limits.video_stale_after_ms,
            scene_stale_after_ms=limits.scene_stale_after_ms,
        ),
        scene_available=scene_available,
        paths=PathsMessage(
            live="/ws/live",
            scene="/scene/",
            documentation="/api/docs",
            health="/health",
            metrics="/metrics",
        ),
        sounds=sound_messages(),
        armed_every_s=ARMED_EVERY_S,
    )


def dashboard_router(message: DashboardMessage) -> APIRouter:
    """Return the router of `GET /api/dashboard`."""
    router = APIRouter(prefix="/api", tags=["page"])

    @router.get("/dashboard")
    async def dashboard() -> DashboardMessage:
        """Return the start-up data of the page: names, limits and addresses."""
        return message

    return router
