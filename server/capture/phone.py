"""A phone, tablet or other computer as a source: its page sends the images of its camera over a WebSocket.

The web process receives them, the tracking process reads them through an inbox in shared memory. Each image
has the browser's capture time, converted to this machine's monotonic clock by the receiver
(`server.stream.phone.page_clock`).
"""

import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

import numpy as np
import numpy.typing as npt

from server.capture.modes import WantedMode, is_same_rate
from server.capture.shot import Shot
from server.errors import CaptureError
from server.image_file import DamagedJpeg, decode_jpeg
from server.live import CameraMode, CameraStatus, ImageClock, Problem
from tracker.camera import CameraControl

NAME = "phone"
# Timeout of `open` for a sender, and interval of the stop check in `read`.
WAIT_S = 0.5
# Below capture.STALLED_AFTER_S, so that this reason is reported instead of that of a wired camera.
SILENT_AFTER_S = 1.5


class Focus(StrEnum):
    """Focus mode of a phone."""

    LOCKED = "locked"
    AUTOMATIC = "automatic"
    UNKNOWN = "unknown"  # the browser neither sets nor reports it


@dataclass(frozen=True, slots=True, kw_only=True)
class PhoneCamera:
    """Camera settings reported by a browser.

    Attributes:
        label: the browser's name of it; empty without one.
        size_wh_px: granted.
        rate_hz: granted; 0 where unknown.
        focus: focus mode.
        focus_mm: focus distance; None where unknown.
        zoom_percent: 100 is no zoom; None where unknown.
    """

    label: str
    size_wh_px: tuple[int, int]
    rate_hz: float
    focus: Focus
    focus_mm: int | None = None
    zoom_percent: int | None = None

    @property
    def controls(self) -> Mapping[CameraControl, int]:
        """The same as controls of a local camera, so that a change since the calibration is reported."""
        values = {CameraControl.FOCUS: self.focus_mm, CameraControl.ZOOM: self.zoom_percent}
        if self.focus is not Focus.UNKNOWN:
            values[CameraControl.AUTOFOCUS] = int(self.focus is Focus.AUTOMATIC)
        return {control: value for control, value in values.items() if value is not None}


@dataclass(frozen=True, slots=True, kw_only=True)
class PhoneImage:
    """One received image.

    Attributes:
        jpeg: complete, and of an allowed size.
        number: counts the images of all senders, from 0.
        captured_at_s: this machine's monotonic clock; never later than the true capture.
        clock: clock of the capture time.
        camera: its camera.
    """

    jpeg: bytes
    number: int
    captured_at_s: float
    clock: ImageClock
    camera: PhoneCamera


@dataclass(frozen=True, slots=True, kw_only=True)
class PhoneUpdate:
    """One update from the receiver to the source.

    Attributes:
        sender: name of the sender; empty without one.
        image: the newest image; None in other updates.
        problem: why the last image was unusable; None where it was usable.
    """

    sender: str
    image: PhoneImage | None = None
    problem: Problem | None = None


class Inbox(Protocol):
    """Last update of the receiver; newest wins."""

    def newest(self) -> tuple[int, PhoneUpdate] | None:
        """Return the last entry and its number; None before the first."""

    def next_after(self, sequence: int, timeout_s: float) -> tuple[int, PhoneUpdate] | None:
        """Return the last entry if its number is above `sequence`; wait up to the timeout."""


class PhoneSource:
    """Images of the sending phone, decoded here; images replaced before they were read count as skipped.

    Args:
        inbox: updates of the receiver.
        stop: ends all waits.
        wanted: mode of the settings, which the browser may not grant.
        first_number: number of its first image.
        clock: monotonic.
    """

    def __init__(
        self,
        inbox: Inbox,
        *,
        stop: threading.Event,
        wanted: WantedMode | None = None,
        first_number: int = 0,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.name = NAME
        self.waits_for_consumer = False
        self.stalls = True
        self._inbox = inbox
        self._stop = stop
        self._wanted = wanted or WantedMode()
        self._number = first_number
        self._clock = clock
        self._sequence = 0
        self._received = -1
        self._last: PhoneImage | None = None

    @property
    def defect(self) -> CaptureError | None:
        """A focus that may move and so invalidate the calibration, or a mode that was not granted."""
        if self._last is None:
            return None
        camera = self._last.camera
        if camera.focus is not Focus.LOCKED:
            return _focus_not_locked(camera)
        return _mode_not_granted(camera, self._wanted)

    @property
    def camera(self) -> CameraStatus:
        """Status of the camera, as the browser reports it."""
        last = self._last
        if last is None:
            return CameraStatus(clock=ImageClock.ARRIVAL)
        camera = last.camera
        granted = CameraMode(fourcc="MJPG", size_wh_px=camera.size_wh_px, rate_hz=camera.rate_hz)
        return CameraStatus(clock=last.clock, granted=granted, controls=camera.controls, device=camera.label)

    def open(self) -> None:
        """Wait for a sender. Images sent before are old, and not read."""
        entry = self._inbox.newest()
        if entry is None or not entry[1].sender:
            entry = self._inbox.next_after(0 if entry is None else entry[0], WAIT_S)
        if entry is None or not entry[1].sender:
            raise _absent()
        self._sequence, update = entry
        if update.image is not None:
            self._received = update.image.number

    def read(self) -> Shot | None:
        """Return the next image."""
        began_s, problem = self._clock(), None
        while not self._stop.is_set():
            if self._clock() - began_s >= SILENT_AFTER_S:
                raise _silent() if problem is None else _unusable(problem)
            entry = self._inbox.next_after(self._sequence, WAIT_S)
            if entry is None:
                continue
            self._sequence, update = entry
            if not update.sender:
                raise _gone()
            problem = update.problem or problem
            if update.image is None:
                continue
            image = decode_jpeg(update.image.jpeg)
            if isinstance(image, DamagedJpeg):
                problem = broken_image()
                continue
            return self._shot(image, update.image)
        return None

    def close(self) -> None:
        """Discard the camera's status, which does not apply to the next one."""
        self._last = None

    def _shot(self, image: npt.NDArray[np.uint8], received: PhoneImage) -> Shot:
        if self._received >= 0:
            self._number += max(0, received.number - self._received - 1)
        self._received, self._last = received.number, received
        shot = Shot.live(image, number=self._number, captured_at_s=received.captured_at_s, jpeg=received.jpeg)
        self._number += 1
        return shot


def broken_image() -> Problem:
    """Return the problem of an incomplete or invalid JPEG."""
    return Problem(
        code="PHONE_IMAGE_BROKEN",
        message="an image of the phone is not a complete JPEG",
        remedy="Reload the page on the phone; if the error persists, use another browser.",
    )


def _absent() -> CaptureError:
    return CaptureError(
        "PHONE_ABSENT",
        "no phone or tablet sends images",
        "Open the page /camera of this server on it and touch START. The page People invites it as a camera.",
        {"source": NAME},
    )


def _gone() -> CaptureError:
    return CaptureError(
        "PHONE_GONE",
        "the phone has disconnected: its page was closed or stopped, or its network is down",
        "Check the phone: its page /camera must be open, in the foreground and started, and its network must "
        "work.",
        {"source": NAME},
    )


def _silent() -> CaptureError:
    return CaptureError(
        "PHONE_SILENT",
        f"the phone is connected, but sent no image for {SILENT_AFTER_S:g} s",
        "Check the phone: its page must be in the foreground, its screen on, and its camera not in use by "
        "another app.",
        {"source": NAME, "limit_s": SILENT_AFTER_S},
    )


def _unusable(problem: Problem) -> CaptureError:
    return CaptureError(problem.code, problem.message, problem.remedy, dict(problem.context))


def _mode_not_granted(camera: PhoneCamera, wanted: WantedMode) -> CaptureError | None:
    size, rate_hz = wanted.size_wh_px, wanted.rate_hz
    # In portrait orientation width and height are exchanged.
    is_other_size = size is not None and sorted(size) != sorted(camera.size_wh_px)
    is_other_rate = bool(rate_hz and camera.rate_hz) and not is_same_rate(rate_hz or 0.0, camera.rate_hz)
    if not is_other_size and not is_other_rate:
        return None
    granted = CameraMode(fourcc="", size_wh_px=camera.size_wh_px, rate_hz=camera.rate_hz)
    return CaptureError(
        "CAMERA_MODE_NOT_GRANTED",
        f"the phone sends other images than requested: the settings request {wanted}, {granted} was granted",
        "Set camera.width, camera.height and camera.rate_hz to a mode of the phone's camera, or to null.",
        {"camera": NAME, "requested": str(wanted), "granted": str(granted)},
    )


def _focus_not_locked(camera: PhoneCamera) -> CaptureError:
    how = "is automatic" if camera.focus is Focus.AUTOMATIC else "cannot be locked or read in its browser"
    return CaptureError(
        "PHONE_FOCUS_NOT_LOCKED",
        f"the focus of the phone's camera {how}: when it changes, the calibration is invalid, "
        "and the change may go unnoticed",
        "Keep the distance from the phone to the field as during the calibration, and check on a landmark "
        "often. Chrome on Android can lock the focus of most phones.",
        {"focus": camera.focus.value, "focus_phrase": how},
    )
