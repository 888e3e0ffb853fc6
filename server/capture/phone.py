"""A phone, tablet or other computer as a source: a page there sends its camera's images over a WebSocket.

The web process receives them, the tracking process reads them through an inbox in shared memory. Each image
comes with the time at which the browser says that it was captured, on this machine's monotonic clock; the
conversion is the receiver's (`server.stream.phone.page_clock`).
"""

import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

import cv2
import numpy as np
import numpy.typing as npt

from server.capture.shot import Shot
from server.errors import CaptureError
from server.live import CameraMode, CameraStatus, ImageClock, Problem
from tracker.camera import CameraControl

NAME = "phone"
# How long `open` waits for a sender, and `read` for an image before it looks whether it shall stop.
WAIT_S = 0.5
# Below capture.STALLED_AFTER_S, so that this reason is told and not the one of a camera with a cable.
SILENT_AFTER_S = 1.5


class Focus(StrEnum):
    """What is known of a phone's focus."""

    LOCKED = "locked"
    AUTOMATIC = "automatic"
    UNKNOWN = "unknown"  # the browser neither sets it nor says how it is set


@dataclass(frozen=True, slots=True, kw_only=True)
class PhoneCamera:
    """What a browser says of its camera.

    Attributes:
        label: as the browser names it; empty where it does not.
        size_wh_px: granted.
        rate_hz: granted; 0 where it is not known.
        focus: locked, or not.
        focus_mm: distance that it is focused at; None where that is not known.
        zoom_percent: 100 is none; None where that is not known.
    """

    label: str
    size_wh_px: tuple[int, int]
    rate_hz: float
    focus: Focus
    focus_mm: int | None = None
    zoom_percent: int | None = None

    @property
    def controls(self) -> Mapping[CameraControl, int]:
        """As the controls of a local camera are, so that a change since the calibration is told."""
        values = {CameraControl.FOCUS: self.focus_mm, CameraControl.ZOOM: self.zoom_percent}
        if self.focus is not Focus.UNKNOWN:
            values[CameraControl.AUTOFOCUS] = int(self.focus is Focus.AUTOMATIC)
        return {control: value for control, value in values.items() if value is not None}


@dataclass(frozen=True, slots=True, kw_only=True)
class PhoneImage:
    """One image as it was received.

    Attributes:
        jpeg: whole, and of a size that is allowed.
        number: counts the images of all senders, from 0.
        captured_at_s: this machine's monotonic clock; never later than the capture.
        clock: whose time that is.
        camera: that took it.
    """

    jpeg: bytes
    number: int
    captured_at_s: float
    clock: ImageClock
    camera: PhoneCamera


@dataclass(frozen=True, slots=True, kw_only=True)
class Inbound:
    """What the receiver tells the source.

    Attributes:
        sender: who sends; empty when nobody does.
        image: the newest one; None where something else is told.
        problem: why the last image could not be used; None where it could.
    """

    sender: str
    image: PhoneImage | None = None
    problem: Problem | None = None


class Inbox(Protocol):
    """What the receiver last told; newest wins."""

    def newest(self) -> tuple[int, Inbound] | None:
        """The last entry and its number; None before the first."""

    def next_after(self, sequence: int, timeout_s: float) -> tuple[int, Inbound] | None:
        """The last entry, if its number is above `sequence`, now or within this time."""


class PhoneSource:
    """Images of the phone that sends them, decoded here; an image that was replaced before is skipped.

    Args:
        inbox: where they come from.
        stop: set when the source shall wait no longer.
        first_number: number of its first image.
        clock: monotonic.
    """

    def __init__(
        self,
        inbox: Inbox,
        *,
        stop: threading.Event,
        first_number: int = 0,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.name = NAME
        self.waits_for_taker = False
        self.stalls = True
        self._inbox = inbox
        self._stop = stop
        self._number = first_number
        self._clock = clock
        self._sequence = 0
        self._received = -1
        self._last: PhoneImage | None = None

    @property
    def defect(self) -> CaptureError | None:
        """That the focus may move without a word, and with it the calibration; None where it is locked."""
        camera = None if self._last is None else self._last.camera
        return None if camera is None or camera.focus is Focus.LOCKED else _focus_not_locked(camera)

    @property
    def camera(self) -> CameraStatus:
        """What the browser says of the camera."""
        last = self._last
        if last is None:
            return CameraStatus(clock=ImageClock.ARRIVAL)
        camera = last.camera
        granted = CameraMode(fourcc="MJPG", size_wh_px=camera.size_wh_px, rate_hz=camera.rate_hz)
        return CameraStatus(clock=last.clock, granted=granted, controls=camera.controls)

    def open(self) -> None:
        """Wait for a sender. What was sent before is old, and is not read."""
        entry = self._inbox.newest()
        if entry is None or not entry[1].sender:
            entry = self._inbox.next_after(0 if entry is None else entry[0], WAIT_S)
        if entry is None or not entry[1].sender:
            raise _absent()
        self._sequence, told = entry
        if told.image is not None:
            self._received = told.image.number

    def read(self) -> Shot | None:
        """The next image."""
        began_s, problem = self._clock(), None
        while not self._stop.is_set():
            if self._clock() - began_s >= SILENT_AFTER_S:
                raise _silent() if problem is None else _unusable(problem)
            entry = self._inbox.next_after(self._sequence, WAIT_S)
            if entry is None:
                continue
            self._sequence, told = entry
            if not told.sender:
                raise _gone()
            problem = told.problem or problem
            if told.image is None:
                continue
            image = _decoded(told.image.jpeg)
            if image is None:
                problem = broken_image()
                continue
            return self._shot(image, told.image)
        return None

    def close(self) -> None:
        """What was said of a camera that is gone is not said of the next one."""
        self._last = None

    def _shot(self, image: npt.NDArray[np.uint8], received: PhoneImage) -> Shot:
        if self._received >= 0:
            self._number += max(0, received.number - self._received - 1)
        self._received, self._last = received.number, received
        shot = Shot(
            image=image,
            number=self._number,
            captured_at_s=received.captured_at_s,
            source_time_s=received.captured_at_s,
        )
        self._number += 1
        return shot


def _decoded(jpeg: bytes) -> npt.NDArray[np.uint8] | None:
    content = np.frombuffer(jpeg, dtype=np.uint8)
    image = cv2.imdecode(content, cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION)
    return None if image is None else np.asarray(image, dtype=np.uint8)


def broken_image() -> Problem:
    """An image is no JPEG, or is cut off."""
    return Problem(
        code="PHONE_IMAGE_BROKEN",
        message="an image that the phone sent is no whole JPEG",
        remedy="Reload the page on the phone; if it happens again, use another browser there.",
    )


def _absent() -> CaptureError:
    return CaptureError(
        "PHONE_ABSENT",
        "no phone or tablet sends images",
        "Open this server's page /camera on it and touch START; the page for people invites it as a camera.",
        {"source": NAME},
    )


def _gone() -> CaptureError:
    return CaptureError(
        "PHONE_GONE",
        "the phone that sent images is gone: its page was closed or stopped, or its network is lost",
        "Look at the phone: its page /camera must be open, in front and started, and its network must stand.",
        {"source": NAME},
    )


def _silent() -> CaptureError:
    return CaptureError(
        "PHONE_SILENT",
        f"the phone is connected, but sent no image for {SILENT_AFTER_S:g} s",
        "Look at the phone: its page must be in front, its screen on, and its camera in no other use.",
        {"source": NAME, "limit_s": SILENT_AFTER_S},
    )


def _unusable(problem: Problem) -> CaptureError:
    return CaptureError(problem.code, problem.message, problem.remedy, dict(problem.context))


def _focus_not_locked(camera: PhoneCamera) -> CaptureError:
    how = "is automatic" if camera.focus is Focus.AUTOMATIC else "cannot be locked or read in its browser"
    return CaptureError(
        "PHONE_FOCUS_NOT_LOCKED",
        f"the focus of the phone's camera {how}: when it moves, the calibration does not hold any more, "
        "and nothing may tell",
        "Keep the distance from phone to field as it was at the calibration, and check on a landmark often; "
        "Chrome on Android locks the focus of most phones.",
        {"focus": camera.focus.value},
    )
