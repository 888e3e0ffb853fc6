"""What the page has to know when it is loaded."""

from importlib.metadata import PackageNotFoundError, version

from fastapi import APIRouter

from server.api.alarms import ARMED_EVERY_S, SoundMessage, sound_messages
from server.config import Config
from server.overlay.words import RESEARCH_SOFTWARE
from server.stream.message import Message

PRODUCT = "Coaxial"


class CameraMessage(Message):
    """One camera and where its pictures are."""

    name: str
    video_path: str
    """MJPEG with the overlay burned in."""
    view_path: str
    """WebSocket with image and pose of one instant in one message."""


class LimitsMessage(Message):
    """From where on a page must say that something is old."""

    pose_stale_after_ms: float
    video_stale_after_ms: float
    scene_stale_after_ms: float


class PathsMessage(Message):
    """Where everything else is."""

    live: str
    """WebSocket with one `LiveMessage` for each instant."""
    scene: str
    documentation: str
    health: str
    metrics: str


class DashboardMessage(Message):
    """What the page has to know when it is loaded; nothing in it changes while the server runs."""

    product: str
    version: str
    notice: str
    """To be shown on every page."""
    cameras: list[CameraMessage]
    limits: LimitsMessage
    scene_available: bool
    paths: PathsMessage
    sounds: list[SoundMessage]
    """Of the alarms, the highest first."""
    armed_every_s: float
    """How often a screen says whether its sound is armed."""


def product_version() -> str:
    """The version of what is installed; "unknown" for a bare copy of the code."""
    try:
        return version("coaxial")
    except PackageNotFoundError:
        return "unknown"


def dashboard_message(config: Config, *, scene_available: bool) -> DashboardMessage:
    """The message for this configuration."""
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
    """`GET /api/dashboard`."""
    router = APIRouter(prefix="/api", tags=["page"])

    @router.get("/dashboard")
    async def dashboard() -> DashboardMessage:
        """What the page has to know when it is loaded: names, limits, addresses."""
        return message

    return router
