"""A network stream (RTSP, HTTP) as a source.

OpenCV's FFmpeg backend silently scales images that change their size to the first size, with any aspect
ratio; a calibration would then be applied to stretched images. For MJPEG it returns the packets, so those are
decoded here in their own size, and damaged ones are skipped. H.264 and H.265 streams that change their size
are still stretched.

For an RTSP stream OpenCV returns each image's RTP time, which is mapped to this machine's clock like a
camera's own (`device_clock`). The wall clock of the sender reports is not used: FFmpeg keeps the first report
only, and nothing in the stream gives the offset of the sender's wall clock. Only video is requested, because
with audio FFmpeg shifts all times at the first report.
"""

import math
import socket
import threading
import time
from collections.abc import Callable
from urllib.parse import urlsplit

import cv2
import numpy as np
import structlog

from server.capture.address import SourceAddress
from server.capture.backlog import Backlog
from server.capture.codecs import (
    OPEN_TIMEOUT_MS,
    READ_TIMEOUT_MS,
    is_predicted,
    open_stream,
    set_jpeg_packets,
)
from server.capture.damaged_images import DamagedImages
from server.capture.device_clock import DeviceClock
from server.capture.driver_clock import DriverClock
from server.capture.pacer import Pacer
from server.capture.shot import Shot
from server.errors import CaptureError
from server.image_file import DamagedJpeg, decode_jpeg
from server.live import CameraStatus, ImageClock

# RTSP packets carry the sender's time (RTP); HTTP has none, and FFmpeg derives it from a rate.
TIMED_SCHEMES = ("rtsp", "rtsps")
DEFAULT_PORTS = {"rtsp": 554, "rtsps": 322, "rtmp": 1935, "http": 80, "https": 443}
# Short, so that a host is found within a second after its return; an attempt of the decoder takes 3 s.
CONNECT_TIMEOUT_S = 0.5
MAX_OLD_S = 2.0

log = structlog.get_logger(__name__)


class StreamSource:
    """Images of a network stream at their arrival; a file over http:// is played at its own rate.

    Images that were buffered on the way are dropped, as detected by their rhythm. RTSP carries the sender's
    time of each image, which removes the network's jitter.

    Args:
        address: address of the stream.
        stop: ends all waits.
        first_number: number of its first image.
        clock: monotonic.
    """

    def __init__(
        self,
        address: SourceAddress,
        *,
        stop: threading.Event,
        first_number: int = 0,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.name = address.name
        self.waits_for_consumer = False
        self.stalls = True
        self._damaged = DamagedImages(address.name)
        self._address = address.text
        self._number = first_number
        self._clock = clock
        self._pacer = Pacer(stop=stop)
        self._backlog = Backlog()
        self._is_timed = address.text.partition("://")[0].lower() in TIMED_SCHEMES
        self._sender_clock = DeviceClock()
        self._timestamps = DriverClock()
        self._is_file = False
        self._is_jpeg = False
        self._is_predicted = False
        self._stream: cv2.VideoCapture | None = None

    @property
    def defect(self) -> CaptureError | None:
        """The damaged images of the last seconds; None without one."""
        return self._damaged.problem

    @property
    def camera(self) -> CameraStatus | None:
        """Clock of its last image; None for a file."""
        if self._is_file:
            return None
        is_used = self._is_timed and self._timestamps.clock is ImageClock.DRIVER
        clock = ImageClock.SENDER if is_used else ImageClock.ARRIVAL
        return CameraStatus(clock=clock, is_predicted=self._is_predicted)

    def open(self) -> None:
        """Connect; takes at most about 4 s, and half a second without a server."""
        self.close()
        self._check_reachable()
        stream = open_stream(self._address)
        if not stream.isOpened():
            stream.release()
            raise CaptureError(
                "STREAM_WITHOUT_VIDEO",
                f"the stream {self.name} is reachable, but sent no video within {OPEN_TIMEOUT_MS / 1000:g} s",
                "Check path, user and password of the stream; it is retried automatically.",
                {"stream": self.name, "timeout_ms": OPEN_TIMEOUT_MS, "timeout_s": OPEN_TIMEOUT_MS / 1000},
            )
        images = float(stream.get(cv2.CAP_PROP_FRAME_COUNT))
        self._is_file = math.isfinite(images) and images > 0
        self._is_jpeg = set_jpeg_packets(stream)
        self._is_predicted = is_predicted(stream)
        self._pacer.restart()
        self._backlog.restart()
        self._sender_clock.restart()
        self._timestamps.restart()
        self._damaged.restart()
        self._stream = stream

    def read(self) -> Shot | None:
        """Return the next image."""
        if self._stream is None:
            raise self._stopped()
        image, captured_at_s = self._newest(self._stream)
        source_time_s = captured_at_s
        if self._is_file:
            source_time_s = float(self._stream.get(cv2.CAP_PROP_POS_MSEC)) / 1000.0
            self._pacer.wait_until_due(source_time_s)
            captured_at_s = self._clock()
        shot = Shot(
            image=np.asarray(image),
            number=self._number,
            captured_at_s=captured_at_s,
            source_time_s=source_time_s,
            is_predicted=self._is_predicted,
        )
        self._number += 1
        return shot

    def close(self) -> None:
        """Disconnect."""
        if self._stream is not None:
            self._stream.release()
            self._stream = None

    def _newest(self, stream: cv2.VideoCapture) -> tuple[np.ndarray, float]:
        """Return the next intact image that was not buffered, with its capture time; others are counted."""
        while True:
            good = stream.grab()
            arrived_s = self._clock()
            if not good:
                raise self._stopped()
            captured_at_s = self._captured_at_s(stream, arrived_s)
            is_old = not self._is_file and self._backlog.is_old(arrived_s)
            if not is_old:
                image = self._decoded(stream)
                if not isinstance(image, DamagedJpeg):
                    self._damaged.add_intact(arrived_s)
                    return image, captured_at_s
                self._damaged.add_damaged(image.reason, arrived_s)
            if is_old and self._backlog.old_for_s(arrived_s) > MAX_OLD_S:
                raise self._in_bursts()
            self._number += 1

    def _captured_at_s(self, stream: cv2.VideoCapture, arrived_s: float) -> float:
        """Return the sender's time where the stream has a plausible one; else the arrival time.

        Only the offset is estimated. FFmpeg reports the wall-clock time of the first sender report
        (CAP_PROP_STREAM_OPEN_TIME_USEC), but not its offset from the local time.
        """
        if not self._is_timed or self._is_file:
            return arrived_s
        jumps, had_given_up = self._sender_clock.jumps, self._timestamps.gave_up
        sender_s = float(stream.get(cv2.CAP_PROP_POS_MSEC)) / 1000.0
        at_s = self._sender_clock.monotonic_s(sender_s, arrived_s=arrived_s)
        captured_at_s = self._timestamps.captured_at_s(at_s, arrived_s=arrived_s)
        if self._timestamps.gave_up and not had_given_up:
            log.warning(
                "the time stamps of the stream are implausible; arrival times are used instead",
                code="STREAM_CLOCK_IMPLAUSIBLE",
                stream=self.name,
                remedy="Ages now include network jitter. Restart the camera, and update its firmware.",
            )
        elif self._sender_clock.jumps > jumps and not had_given_up:
            log.warning(
                "the clock of the stream's sender jumped; it is synchronised again",
                code="STREAM_CLOCK_JUMPED",
                stream=self.name,
                sender_s=round(sender_s, 3),
                remedy="Configure the camera's time server so that it does not set the clock repeatedly.",
            )
        return captured_at_s

    def _decoded(self, stream: cv2.VideoCapture) -> np.ndarray | DamagedJpeg:
        """Return the image in its own size."""
        content = stream.retrieve()[1]
        if content is None:
            raise self._stopped()
        image = np.asarray(content, dtype=np.uint8)
        return decode_jpeg(image) if self._is_jpeg else image

    def _in_bursts(self) -> CaptureError:
        return CaptureError(
            "STREAM_IN_BURSTS",
            f"the stream {self.name} sends its images in bursts; for {MAX_OLD_S:g} s all images were "
            "buffered on the way",
            "Set the camera to low latency, connect it by cable, and check that this machine is not "
            "overloaded. It is reopened automatically.",
            {"stream": self.name, "limit_s": MAX_OLD_S},
        )

    def _stopped(self) -> CaptureError:
        return CaptureError(
            "STREAM_STOPPED",
            f"the stream {self.name} stopped: no image within {READ_TIMEOUT_MS / 1000:g} s, or closed",
            "Check the camera, its power and the network; it is retried automatically.",
            {"stream": self.name, "timeout_ms": READ_TIMEOUT_MS, "timeout_s": READ_TIMEOUT_MS / 1000},
        )

    def _check_reachable(self) -> None:
        """Check by a TCP connection that the server is reachable."""
        try:
            parts = urlsplit(self._address)
            port = parts.port or DEFAULT_PORTS.get(parts.scheme.lower())
        except ValueError:
            # The text and the cause of the error are not used: they may contain a part of the password, if it
            # contains / ? or #.
            raise CaptureError(
                "STREAM_ADDRESS_INVALID",
                f"the stream's address {self.name} is invalid: it has no valid host or port",
                "Give an address such as rtsp://user:password@camera:554/path; write / ? # @ in a password "
                "as %2F %3F %23 %40.",
                {"stream": self.name},
            ) from None
        if parts.hostname is None or port is None:
            return
        try:
            socket.create_connection((parts.hostname, port), timeout=CONNECT_TIMEOUT_S).close()
        except OSError as error:
            reason = f"no answer within {CONNECT_TIMEOUT_S:g} s"
            if not isinstance(error, TimeoutError):
                reason = (error.strerror or str(error)).lower()
            raise CaptureError(
                "STREAM_UNREACHABLE",
                f"the stream {self.name} cannot be reached at {parts.hostname}:{port}: {reason}",
                "Check address, cable and power of the camera; it is retried automatically.",
                {"stream": self.name, "host": parts.hostname, "port": port, "stream_problem": reason},
            ) from error
