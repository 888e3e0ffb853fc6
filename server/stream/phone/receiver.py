"""The one active sender, and the transfer of its images to the tracking process."""

import asyncio
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import structlog

from server.capture.local_camera import CalibratedCamera
from server.capture.phone import PhoneImage, PhoneUpdate
from server.config import CameraConfig
from server.live import Problem
from server.loop.phone_inbox import PhoneInbox
from server.security import Person
from server.stream.connection import MAX_CLIENT_MESSAGE_BYTES
from server.stream.phone.messages import WelcomeMessage
from server.stream.phone.sender import Received
from tracker.camera import CameraControl
from tracker.errors import NavigationError

DEFAULT_SIZE_WH_PX = (1280, 720)
DEFAULT_RATE_HZ = 30.0
# Compression artefacts stay below the sensor's noise; 1280x720 needs some 150 to 300 kB.
JPEG_QUALITY_RATIO = 0.9
# As for a local camera: an older image was buffered somewhere.
MAX_AGE_S = 1.0
RATE_WINDOW_S = 2.0

_log = structlog.get_logger(__name__)


class PhoneTaken(NavigationError):
    """Another device is sending already."""

    def __init__(self, name: str) -> None:
        super().__init__(
            "PHONE_TAKEN",
            f"another device is already sending images, signed in as {name}",
            "Touch STOP on it or close its page, then touch START here.",
            {"name": name},
        )

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle by the constructor's arguments."""
        return type(self), (self.context["name"],)


@dataclass(slots=True, eq=False)
class SenderSlot:
    """The slot of the active sender.

    Attributes:
        key: key of the page.
        person: person signed in on it.
        replaced: set when the same page reconnects.
        problem: problem of the last image; None when it was passed on.
    """

    key: str
    person: Person
    replaced: asyncio.Event = field(default_factory=asyncio.Event)
    problem: Problem | None = None


class Receiver:
    """Passes on the images of one sender, each newer than the one before. For one event loop.

    Attributes:
        images: number of images passed on, of all senders.
        calibrated: camera settings of the calibration in use; None without one.
    """

    def __init__(
        self, inbox: PhoneInbox, settings: CameraConfig, *, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self.images = 0
        self.calibrated: CalibratedCamera | None = None
        self._inbox = inbox
        self._settings = settings
        self._clock = clock
        self._slot: SenderSlot | None = None
        self._captured_at_s = 0.0
        self._arrived: deque[float] = deque(maxlen=240)

    @property
    def rate_hz(self) -> float:
        """Images per second passed on in the last two seconds."""
        since_s = self._clock() - RATE_WINDOW_S
        recent = [at_s for at_s in self._arrived if at_s >= since_s]
        if len(recent) < 2 or recent[-1] <= recent[0]:
            return 0.0
        return (len(recent) - 1) / (recent[-1] - recent[0])

    def welcome(self) -> WelcomeMessage:
        """Return the camera settings for a page: from the configuration, else those of the calibration."""
        settings, calibrated = self._settings, self.calibrated
        width, height = DEFAULT_SIZE_WH_PX if calibrated is None else calibrated.size_wh_px
        if settings.width is not None and settings.height is not None:
            width, height = settings.width, settings.height
        return WelcomeMessage(
            width_px=width,
            height_px=height,
            rate_hz=settings.rate_hz or DEFAULT_RATE_HZ,
            quality_ratio=JPEG_QUALITY_RATIO,
            part_bytes=MAX_CLIENT_MESSAGE_BYTES,
            lock_focus=settings.lock_controls,
            focus_mm=None if calibrated is None else calibrated.controls.get(CameraControl.FOCUS),
        )

    @contextmanager
    def sending(self, key: str, person: Person) -> Iterator[SenderSlot]:
        """Reserve the sender's slot for the duration of the block.

        Raises:
            PhoneTaken: another page has it. The same page of the same person gets its place back.
        """
        before = self._slot
        if before is not None and (before.key, before.person.id) != (key, person.id):
            _log.warning("phone_rejected", by=person.name, sending=before.person.name)
            raise PhoneTaken(before.person.name)
        if before is not None:
            before.replaced.set()
        slot = self._slot = SenderSlot(key=key, person=person)
        self._inbox.put(PhoneUpdate(sender=person.name))
        _log.info("phone_sends", by=person.name)
        try:
            yield slot
        finally:
            if self._slot is slot:
                self._slot = None
                self._inbox.put(PhoneUpdate(sender=""))
                _log.info("phone_gone", by=person.name)

    def deliver(self, slot: SenderSlot, received: Received | Problem) -> None:
        """Pass an image on to the tracking process, or the reason why it is unusable."""
        if self._slot is not slot:
            return
        problem = received if isinstance(received, Problem) else self._problem_of(received)
        if problem is not None and (slot.problem is None or slot.problem.code != problem.code):
            _log.warning(problem.message, code=problem.code, remedy=problem.remedy, by=slot.person.name)
        slot.problem = problem
        image = None
        if problem is None and isinstance(received, Received):
            image = PhoneImage(
                jpeg=received.jpeg,
                number=self.images,
                captured_at_s=received.captured_at_s,
                clock=received.clock,
                camera=received.camera,
            )
            self.images += 1
            self._captured_at_s = received.captured_at_s
            self._arrived.append(received.arrived_s)
        self._inbox.put(PhoneUpdate(sender=slot.person.name, image=image, problem=problem))

    def _problem_of(self, received: Received) -> Problem | None:
        if received.captured_at_s <= self._captured_at_s:
            return Problem(
                code="PHONE_IMAGE_REPEATED",
                message="an image of the phone was captured no later than the one before it",
                remedy="Touch STOP and START on the phone.",
            )
        age_s = received.arrived_s - received.captured_at_s
        if age_s <= MAX_AGE_S:
            return None
        return Problem(
            code="PHONE_IMAGE_OLD",
            message=f"images of the phone arrive {age_s:.1f} s after their capture, limit {MAX_AGE_S:g} s",
            remedy="Move the phone closer to its access point, or set smaller images with camera.width and "
            "camera.height.",
            context={"age_s": age_s, "limit_s": MAX_AGE_S},
        )
