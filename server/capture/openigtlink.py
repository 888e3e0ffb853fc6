"""Poses of an external tracker by OpenIGTLink, in place of images of a camera.

The clock of the sender is mapped to ours by `DeviceClock`: the offset is the smallest difference of arrival
and time stamp in the last 10 s. It contains the smallest delay of the way, which no message tells; the stated
latency, from the measurement to the arrival of the fastest message, is therefore subtracted from each time.
If all messages of 10 s were delayed, the minimum has risen: they would look new, and the connection is ended.
Drill and patient have the same stamp (`pose_frames`), so that an error of the offset or of the latency is one
of the age of a pose, never one of the drill in the patient.
"""

import math
import socket
import threading
import time
from collections import deque
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from server.capture.address import SourceAddress
from server.capture.device_clock import DeviceClock
from server.capture.pose_frames import PoseFrame, PoseFrames
from server.capture.shot import Shot
from server.config import ExternalTrackerConfig
from server.errors import CaptureError
from server.live import CameraStatus
from server.openigtlink_wire import (
    ChecksumError,
    Message,
    MessageReader,
    WireError,
    pack,
    start_tracking_content,
)

# A TRANSFORM has some hundred bytes. Images, which Plus can send too, are not accepted.
MAX_BODY_BYTES = 16 * 1024
CHUNK_BYTES = 64 * 1024
CONNECT_TIMEOUT_S = 1.0
POLL_S = 0.1
# Before `Capture` supposes a camera that stalls.
SILENT_AFTER_S = 1.5
# Plus then sends TDATA, if its settings name it, with each frame.
RESOLUTION_MS = 1
DEVICE = "Coaxial"
# Capture times increase strictly, also where a faster message corrects the offset.
MIN_STEP_S = 1e-6
# Rise of the smallest difference within a connection that is no drift of a crystal; ages would be too small
# by it.
MAX_RISE_S = 0.05
MAX_DRIFT_RATIO = 1e-4
# Of what is shown instead of an image; its size is that at which the overlay is legible.
PICTURE_WH_PX = (960, 540)
BACKGROUND = 28


def blank_picture() -> npt.NDArray[np.uint8]:
    """Return the picture (h, w, 3) of a source without a camera; the overlay states so."""
    width, height = PICTURE_WH_PX
    return np.full((height, width, 3), BACKGROUND, dtype=np.uint8)


class OpenIgtLinkSource:
    """Poses of an external tracker as a live source: each shot has poses and a blank picture."""

    def __init__(
        self,
        address: SourceAddress,
        *,
        settings: ExternalTrackerConfig,
        stop: threading.Event,
        first_number: int,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.name = address.name
        self.waits_for_consumer = False
        self.stalls = True
        self.defect: CaptureError | None = None
        self.camera: CameraStatus | None = None
        self._settings = settings
        self._place = f"{settings.host}:{settings.port}"
        self._latency_s = settings.latency_ms / 1000.0
        self._stop = stop
        self._number = first_number
        self._clock = clock
        self._captured_at_s = -math.inf
        self._picture = blank_picture()
        self._socket: socket.socket | None = None
        self._restart()

    def _restart(self) -> None:
        self._sender_clock = DeviceClock()
        self._offset_s, self._offset_at_s = math.inf, 0.0
        self._messages = MessageReader(max_body_bytes=MAX_BODY_BYTES)
        self._frames = PoseFrames(self._settings.transforms)
        self._waiting: deque[tuple[PoseFrame, float]] = deque()

    def open(self) -> None:
        """Connect, and request poses.

        Raises:
            CaptureError: TRACKER_UNREACHABLE.
        """
        self.close()
        self._restart()
        try:
            address = (self._settings.host, self._settings.port)
            self._socket = socket.create_connection(address, timeout=CONNECT_TIMEOUT_S)
            self._socket.settimeout(POLL_S)
            for kind, content in (("GET_STATUS", b""), ("STT_TDATA", start_tracking_content(RESOLUTION_MS))):
                # In version 2: Plus then states in metadata which poses are valid.
                self._socket.sendall(
                    pack(Message(type=kind, device=DEVICE, timestamp_s=0.0, content=content), version=2)
                )
        except OSError as error:
            raise self._unreachable(error) from error

    def read(self) -> Shot | None:
        """Return the poses of the next moment; None when the source is stopped.

        Raises:
            CaptureError: TRACKER_CLOSED, TRACKER_SILENT, TRACKER_LATE, TRACKER_MESSAGE_INVALID.
        """
        began_s = self._clock()
        while not self._waiting:
            if self._stop.is_set():
                return None
            if self._clock() - began_s > SILENT_AFTER_S:
                raise self._silent()
            self._receive()
        frame, arrived_s = self._waiting.popleft()
        at_s = self._sender_clock.monotonic_s(frame.stamp_s, arrived_s=arrived_s)
        self._reject_late(at_s - frame.stamp_s, arrived_s)
        self._captured_at_s = max(at_s - self._latency_s, self._captured_at_s + MIN_STEP_S)
        shot = Shot(
            image=self._picture,
            number=self._number,
            captured_at_s=self._captured_at_s,
            source_time_s=self._captured_at_s,
            poses=frame.poses,
        )
        self._number += 1
        return shot

    def close(self) -> None:
        """Disconnect."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    def _receive(self) -> None:
        """Read what has arrived, and store the frames that are complete with it."""
        if self._socket is None:
            raise self._closed()
        try:
            content = self._socket.recv(CHUNK_BYTES)
        except TimeoutError:
            return
        except OSError as error:
            raise self._closed() from error
        if not content:
            raise self._closed()
        arrived_s = self._clock()
        try:
            for message in self._messages.feed(content):
                if isinstance(message, ChecksumError):
                    raise message
                frame = self._frames.take(message)
                if frame is not None:
                    self._waiting.append((frame, arrived_s))
        except WireError as error:
            raise CaptureError(
                "TRACKER_MESSAGE_INVALID",
                f"a message of the tracker at {self._place} is not valid: {error}",
                "Let it send only TRANSFORM or TDATA, as rigid motions in mm with time stamps; it is "
                "reconnected automatically.",
                {"place": self._place, "reason": str(error)},
            ) from error

    def _reject_late(self, offset_s: float, arrived_s: float) -> None:
        """Compare the offset of the sender's clock with the smallest one of this connection.

        Raises:
            CaptureError: TRACKER_LATE.
        """
        expected_s = self._offset_s + MAX_DRIFT_RATIO * (arrived_s - self._offset_at_s)
        self._offset_s, self._offset_at_s = min(offset_s, expected_s), arrived_s
        late_ms, limit_ms = (offset_s - self._offset_s) * 1000.0, MAX_RISE_S * 1000.0
        if late_ms > limit_ms:
            raise CaptureError(
                "TRACKER_LATE",
                f"all poses of the tracker at {self._place} arrive {late_ms:.0f} ms later than the fastest "
                f"before, allowed are {limit_ms:g} ms",
                "Check the network and the load of the computer of Plus, or whether its clock was set back; "
                "it is reconnected automatically.",
                {"place": self._place, "late_ms": late_ms, "limit_ms": limit_ms},
            )

    def _unreachable(self, error: OSError) -> CaptureError:
        reason = (error.strerror or str(error)).lower()
        return CaptureError(
            "TRACKER_UNREACHABLE",
            f"the tracker at {self._place} cannot be reached: {reason}",
            "Start Plus, and check external_tracker.host and external_tracker.port; it is retried "
            "automatically.",
            {"place": self._place, "library_error": reason},
        )

    def _closed(self) -> CaptureError:
        return CaptureError(
            "TRACKER_CLOSED",
            f"the tracker at {self._place} closed the connection",
            "Check Plus and the tracker; it is reconnected automatically.",
            {"place": self._place},
        )

    def _silent(self) -> CaptureError:
        names = ", ".join(self._settings.transforms)
        return CaptureError(
            "TRACKER_SILENT",
            f"the tracker at {self._place} sent no new pose of {names} for {SILENT_AFTER_S:g} s",
            "Bring drill and patient into its view, and check that Plus sends transforms of these names; it "
            "is reconnected automatically.",
            {"place": self._place, "bodies": names, "limit_s": SILENT_AFTER_S},
        )
