"""`LiveHub`: publishes the newest result of tracking to all viewers.

One thread publishes, any number of asyncio tasks and threads wait. Only the newest instant is stored: a slow
reader skips instants, visible as gaps in the sequence number. Nothing is queued, so that a slow reader
neither delays others nor fills the memory.
"""

import asyncio
import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
import numpy.typing as npt

from tracker.camera import CameraControl, LampFlicker
from tracker.errors import NavigationError
from tracker.navigation import NavigationSnapshot
from tracker.navigation.alarms import QUIET, AlarmSnapshot
from tracker.plan.pedicle import Side

# V4L2_EXPOSURE_MANUAL, and the unit of V4L2_CID_EXPOSURE_ABSOLUTE.
EXPOSURE_FIXED, V4L2_EXPOSURE_UNIT_MS = 1, 0.1


class SourceState(StrEnum):
    """State of the image source."""

    OPENING = "opening"
    RUNNING = "running"
    RECONNECTING = "reconnecting"  # it failed or stopped; it is retried automatically
    ENDED = "ended"  # a file that is not looped has been played to its end


@dataclass(frozen=True, slots=True, kw_only=True)
class Problem:
    """A present fault, with the fields of an error."""

    code: str
    message: str
    remedy: str
    context: dict[str, object] = field(default_factory=dict, hash=False)

    @classmethod
    def from_error(cls, error: NavigationError) -> "Problem":
        """Return the fault that this error describes."""
        return cls(code=error.code, message=error.message, remedy=error.remedy, context=dict(error.context))


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraMode:
    """A video mode of a camera.

    Attributes:
        fourcc: Pixel format as named by V4L2 and OpenCV ("MJPG", "YUYV") or GenICam ("BayerRG8"); empty if
            unknown.
        size_wh_px: Width and height.
        rate_hz: Images per second; 0 if unknown.
    """

    fourcc: str
    size_wh_px: tuple[int, int]
    rate_hz: float

    def __str__(self) -> str:
        """Return a text such as "1920x1080 MJPG at 30 Hz"."""
        width, height = self.size_wh_px
        rate = f" at {self.rate_hz:.4g} Hz" if self.rate_hz > 0.0 else ""
        return f"{width}x{height}{' ' if self.fourcc else ''}{self.fourcc}{rate}"


class ImageClock(StrEnum):
    """Source of the capture time of an image."""

    DRIVER = "driver"  # time stamp of the camera's driver
    DEVICE = "device"  # time stamp of the camera by its own clock
    SENDER = "sender"  # time stamp of the stream's sender; the minimum network delay is unknown
    BROWSER = "browser"  # capture time stated by the browser of the phone
    ARRIVAL = "arrival"  # time of arrival, which is later by exposure, transfer and buffers


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraStatus:
    """State of a camera.

    Attributes:
        clock: Source of the capture times.
        requested: Requested mode; None if the supported modes are unknown.
        granted: Mode that the camera delivers; None if unknown.
        controls: Last values in the units of the driver; empty if unknown.
        trigger: Trigger input; empty in free run.
        flicker: Detected lamp flicker; None if there is none or it is unknown.
        is_predicted: Whether its codec predicts images from earlier ones.
        exposure_unit_ms: Unit of the control EXPOSURE.
        device: Identity of the camera: its model, or its serial number if it has one; empty if unknown.
    """

    clock: ImageClock
    requested: CameraMode | None = None
    granted: CameraMode | None = None
    controls: Mapping[CameraControl, int] = field(default_factory=dict)
    trigger: str = ""
    flicker: LampFlicker | None = None
    is_predicted: bool = False
    exposure_unit_ms: float = V4L2_EXPOSURE_UNIT_MS
    device: str = ""

    @property
    def exposure_ms(self) -> float | None:
        """Exposure time; None if unknown or automatic."""
        exposure = self.controls.get(CameraControl.EXPOSURE)
        is_fixed = self.controls.get(CameraControl.AUTO_EXPOSURE) == EXPOSURE_FIXED
        return exposure * self.exposure_unit_ms if exposure and is_fixed else None


@dataclass(frozen=True, slots=True, kw_only=True)
class SourceStatus:
    """State of the image source.

    Attributes:
        name: Path, address or "rehearsal". Passwords in addresses are masked.
        state: Its state.
        problem: Why it is not running; None if it is.
        images: Images since the start of the server.
        skipped_images: Images that were not processed because a newer one was available.
        rate_hz: Images per second, over about the last second.
        camera: State of the camera; None for files and rendered images.
    """

    name: str
    state: SourceState
    problem: Problem | None = None
    images: int = 0
    skipped_images: int = 0
    rate_hz: float = 0.0
    camera: CameraStatus | None = None

    @property
    def device(self) -> str:
        """Device of the camera; empty if unknown."""
        return "" if self.camera is None else self.camera.device


class ProcessState(StrEnum):
    """State of the tracking process."""

    STARTING = "starting"
    RUNNING = "running"
    RESTARTING = "restarting"  # it died or fell silent, and is being started again
    GIVEN_UP = "given_up"  # it died too often; see the problem


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessStatus:
    """State of the process that captures and tracks.

    Attributes:
        state: Its state.
        restarts: Restarts since the start of the server.
        problem: Why it is not running; or, while it runs, why it cannot track.
        dropped_images: Tracked images that the server was too slow to show.
    """

    state: ProcessState
    restarts: int = 0
    problem: Problem | None = None
    dropped_images: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class ProposedChannel:
    """Another planned channel, to which the drill is nearer than to the active one.

    Attributes:
        vertebra: Name of the vertebra in the plan.
        side: Side of the patient.
        is_registered: Whether the vertebra has a valid registration.
    """

    vertebra: str
    side: Side
    is_registered: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Instant:
    """The published state of one moment.

    Attributes:
        sequence: Increases by one with each instant, also over restarts of the tracking process.
        source: State of the image source.
        process: State of the tracking process.
        snapshot: Result of the newest image; None before the first image and while capture or tracking is
            stopped, so that an old result is not shown as live.
        image: The camera image without overlay, (h, w, 3) uint8 BGR; None without a snapshot. Read-only.
        jpeg: A picture to show instead of the image with overlay, if there is one; empty for images of a
            source, whose overlay is drawn on demand (`server/stream/scaling`).
        alarms: Alarms, including this image.
        proposed_channel: Channel that is proposed with this image; None for none.
    """

    sequence: int
    source: SourceStatus
    process: ProcessStatus
    snapshot: NavigationSnapshot | None = None
    image: npt.NDArray[np.uint8] | None = None
    jpeg: bytes = b""
    alarms: AlarmSnapshot = QUIET
    proposed_channel: ProposedChannel | None = None

    @property
    def is_stopped(self) -> bool:
        """Whether no image is expected because the source or the tracking is not running.

        Between two images of a slow camera, instants without a snapshot serve as a heartbeat.
        """
        running = self.source.state is SourceState.RUNNING and self.process.state is ProcessState.RUNNING
        return self.snapshot is None and (not running or self.process.problem is not None)

    @property
    def has_picture(self) -> bool:
        """Whether there is a picture, drawn and encoded or not."""
        return bool(self.jpeg) or (self.image is not None and self.snapshot is not None)


class LiveHub:
    """Store the newest instant and wake the readers that wait for it. Thread-safe."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._published = threading.Condition(self._lock)
        self._newest: Instant | None = None
        self._waiting: set[tuple[asyncio.AbstractEventLoop, asyncio.Event]] = set()

    def publish(self, instant: Instant) -> None:
        """Publish an instant. Never blocks on a reader."""
        with self._lock:
            self._newest = instant
            waiting, self._waiting = self._waiting, set()
            self._published.notify_all()
        for loop, event in waiting:
            # A closed event loop has no readers.
            if not loop.is_closed():
                loop.call_soon_threadsafe(event.set)

    @property
    def newest(self) -> Instant | None:
        """The newest instant; None before the first."""
        with self._lock:
            return self._newest

    def wait_after(self, sequence: int, timeout_s: float) -> Instant | None:
        """As `next_after`, for threads; None after the timeout."""
        with self._lock:
            self._published.wait_for(
                lambda: self._newest is not None and self._newest.sequence > sequence, timeout_s
            )
            newest = self._newest
        return newest if newest is not None and newest.sequence > sequence else None

    async def next_after(self, sequence: int) -> Instant:
        """Wait for an instant with a sequence above `sequence` (-1: any) and return the newest one."""
        while True:
            event = asyncio.Event()
            entry = (asyncio.get_running_loop(), event)
            with self._lock:
                if self._newest is not None and self._newest.sequence > sequence:
                    return self._newest
                self._waiting.add(entry)
            try:
                await event.wait()
            finally:
                with self._lock:
                    self._waiting.discard(entry)
