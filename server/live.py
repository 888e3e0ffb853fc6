"""The newest instant: the one place where tracking hands over to everybody who watches.

A thread publishes, any number of asyncio tasks and threads wait. Newest wins: who is slow skips, and is told
how many instants it skipped by the sequence number. Nothing is queued, so nobody can delay anybody or fill
memory.
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
from tracker.navigation.alarms import QUIET, AlarmPicture

# V4L2_EXPOSURE_MANUAL, and the unit of V4L2_CID_EXPOSURE_ABSOLUTE.
EXPOSURE_FIXED, EXPOSURE_UNIT_MS = 1, 0.1


class SourceState(StrEnum):
    """What the source of images is doing."""

    OPENING = "opening"
    RUNNING = "running"
    RECONNECTING = "reconnecting"  # it failed or stopped; it is tried again by itself
    ENDED = "ended"  # a file that is not looped has been played to its end


@dataclass(frozen=True, slots=True, kw_only=True)
class Problem:
    """Something that is wrong now, in the one shape that errors have everywhere."""

    code: str
    message: str
    remedy: str
    context: dict[str, object] = field(default_factory=dict)

    @classmethod
    def from_error(cls, error: NavigationError) -> "Problem":
        """An error, from the moment on when it is a state rather than an event."""
        return cls(code=error.code, message=error.message, remedy=error.remedy, context=dict(error.context))


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraMode:
    """How a camera gives its images.

    Attributes:
        fourcc: pixel format, as V4L2 and OpenCV name it ("MJPG", "YUYV"), or GenICam ("BayerRG8"); empty
            where it is not known.
        size_wh_px: width and height.
        rate_hz: images a second; 0 where it is not known.
    """

    fourcc: str
    size_wh_px: tuple[int, int]
    rate_hz: float

    def __str__(self) -> str:
        """For a person: "1920x1080 MJPG at 30 Hz"."""
        width, height = self.size_wh_px
        rate = f" at {self.rate_hz:.4g} Hz" if self.rate_hz > 0.0 else ""
        return f"{width}x{height}{' ' if self.fourcc else ''}{self.fourcc}{rate}"


class ImageClock(StrEnum):
    """Whose clock says when an image was taken."""

    DRIVER = "driver"  # the camera's driver stamped it
    DEVICE = "device"  # the camera itself stamped it, by its own clock
    SENDER = "sender"  # the stream's sender stamped it; the least delay of its way is not known
    BROWSER = "browser"  # the browser of the phone that sends it said when it was captured
    ARRIVAL = "arrival"  # it was read when the image arrived: later, by exposure, transfer and buffers


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraStatus:
    """What is known of a camera beside its images.

    Attributes:
        clock: whose clock stamped the last image.
        asked: the mode it was asked for; None where it is not known what it offers.
        granted: the mode that it granted; None where it is not known.
        controls: their values when they were last read, in the driver's own units; empty where none is known.
        trigger: the input that starts each image; empty where the camera runs freely.
        flicker: lamps that beat with the images, as last seen; None where they do not, or it is not known.
    """

    clock: ImageClock
    asked: CameraMode | None = None
    granted: CameraMode | None = None
    controls: Mapping[CameraControl, int] = field(default_factory=dict)
    trigger: str = ""
    flicker: LampFlicker | None = None

    @property
    def exposure_ms(self) -> float | None:
        """How long each image is exposed; None where it is not known, as while the camera sets it itself."""
        exposure = self.controls.get(CameraControl.EXPOSURE)
        is_fixed = self.controls.get(CameraControl.AUTO_EXPOSURE) == EXPOSURE_FIXED
        return exposure * EXPOSURE_UNIT_MS if exposure and is_fixed else None


@dataclass(frozen=True, slots=True, kw_only=True)
class SourceStatus:
    """The source of images.

    Attributes:
        name: what a person calls it: a path, an address, "rehearsal". Passwords in addresses are masked.
        state: what it is doing.
        trouble: why it is not running, if it is not.
        images: how many images it has given since the server started.
        skipped_images: how many of them were never looked at, because a newer one was there.
        rate_hz: images a second, over the last second or so.
        camera: what is known of the camera; None where images come from files or are rendered.
    """

    name: str
    state: SourceState
    problem: Problem | None = None
    images: int = 0
    skipped_images: int = 0
    rate_hz: float = 0.0
    camera: CameraStatus | None = None


class ProcessState(StrEnum):
    """What the tracking process is doing."""

    STARTING = "starting"
    RUNNING = "running"
    RESTARTING = "restarting"  # it died or fell silent, and is being started again
    GIVEN_UP = "given_up"  # it died too often; see the trouble


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessStatus:
    """The process that captures and tracks.

    Attributes:
        state: what it is doing.
        restarts: how often it was started again since the server started.
        trouble: why it is not running; or, while it runs, why it cannot track.
        dropped_images: tracked images that the server was too slow to show, since it started.
    """

    state: ProcessState
    restarts: int = 0
    problem: Problem | None = None
    dropped_images: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Instant:
    """What is true now, for everybody.

    Attributes:
        sequence: grows by one with each instant, for ever, over restarts of the tracking process too.
        source: the source of images.
        process: the tracking process.
        snapshot: what the newest image says; None before the first image, and from the moment on when
            capture or tracking is known to be dead (an old snapshot is not kept as if it were live).
        jpeg: the same image with the overlay burned in; empty when there is no snapshot, and when nobody has
            watched in full size lately.
        drawn: the picture in that JPEG, (h, w, 3) uint8 BGR, for other sizes; None when there is no snapshot,
            and when nobody has watched in any size lately. Never written into.
        image: the same image as the camera gave it, (h, w, 3) uint8 BGR, for set-up; None when there is no
            snapshot. Never written into.
        server_ms: time of the server's own stages ("overlay", "encode") for this image.
        alarms: what the alarms say, this image looked at.
    """

    sequence: int
    source: SourceStatus
    process: ProcessStatus
    snapshot: NavigationSnapshot | None = None
    jpeg: bytes = b""
    drawn: npt.NDArray[np.uint8] | None = None
    image: npt.NDArray[np.uint8] | None = None
    server_ms: dict[str, float] = field(default_factory=dict)
    alarms: AlarmPicture = QUIET

    @property
    def is_stopped(self) -> bool:
        """Whether no image is to be expected: the source or the tracking does not run.

        Between two images of a slow camera an instant without a snapshot goes out as a sign of life.
        """
        running = self.source.state is SourceState.RUNNING and self.process.state is ProcessState.RUNNING
        return self.snapshot is None and (not running or self.process.problem is not None)

    @property
    def has_picture(self) -> bool:
        """Whether there is a picture to be shown, drawn and encoded yet or not."""
        drawable = self.image is not None and self.snapshot is not None
        return bool(self.jpeg) or self.drawn is not None or drawable


class LiveHub:
    """Holds the newest instant and wakes those who wait for the next one."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._published = threading.Condition(self._lock)
        self._newest: Instant | None = None
        self._waiting: set[tuple[asyncio.AbstractEventLoop, asyncio.Event]] = set()

    def publish(self, instant: Instant) -> None:
        """Make this the newest instant. From any thread; never blocks on a reader."""
        with self._lock:
            self._newest = instant
            waiting, self._waiting = self._waiting, set()
            self._published.notify_all()
        for loop, event in waiting:
            # A loop that was closed meanwhile has nobody left to wake.
            if not loop.is_closed():
                loop.call_soon_threadsafe(event.set)

    @property
    def newest(self) -> Instant | None:
        """The newest instant, None before the first."""
        with self._lock:
            return self._newest

    def wait_after(self, sequence: int, timeout_s: float) -> Instant | None:
        """As `next_after`, for a thread; None when nothing came within this time."""
        with self._lock:
            self._published.wait_for(
                lambda: self._newest is not None and self._newest.sequence > sequence, timeout_s
            )
            newest = self._newest
        return newest if newest is not None and newest.sequence > sequence else None

    async def next_after(self, sequence: int) -> Instant:
        """The newest instant whose sequence is above `sequence` (use -1 to get whatever there is)."""
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
