"""A network stream (RTSP, HTTP) as a source.

OpenCV's FFmpeg backend silently scales images that change their size to the first size, whatever their
shape; a calibration would then hold for stretched images. Of MJPEG it hands over the packets, so those are
decoded here in their own size, and truncated ones are dropped. H.264 and H.265 streams that change their
size are still stretched.

Of an RTSP stream OpenCV gives each image's RTP time, which is mapped to this machine's clock like a camera's
own (`device_clock`). The wall clock of the sender reports is not used: FFmpeg keeps the first report alone,
and nothing in the stream says how far the sender's wall clock is from ours. Only video is requested, because
beside sound FFmpeg shifts all times at the first report.
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
from server.capture.codecs import OPEN_TIMEOUT_MS, READ_TIMEOUT_MS, open_stream
from server.capture.device_clock import DeviceClock
from server.capture.driver_clock import DriverClock
from server.capture.pace import Pace
from server.capture.shot import Shot
from server.errors import CaptureError
from server.live import CameraStatus, ImageClock

# Their packets carry the sender's time (RTP); those of HTTP carry none, and FFmpeg makes them up from a rate.
TIMED_SCHEMES = ("rtsp", "rtsps")
DEFAULT_PORTS = {"rtsp": 554, "rtsps": 322, "rtmp": 1935, "http": 80, "https": 443}
# Short, so that a host that comes back is noticed within a second: the decoder's own attempt takes 3 s.
KNOCK_TIMEOUT_S = 0.5
MAX_OLD_S = 2.0
MAX_TORN = 30

log = structlog.get_logger(__name__)


class StreamSource:
    """Images of a network stream, the moment they arrive; a file behind http:// comes at its own rate.

    What waited on its way is left out: it is old, as its rhythm says. RTSP carries the sender's time of each
    image besides, by which the jitter of the way is taken out of its time.

    Args:
        address: of the stream.
        stop: set when the source shall wait no longer.
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
        self.waits_for_taker = False
        self.stalls = True
        self.defect: CaptureError | None = None
        self._address = address.text
        self._number = first_number
        self._clock = clock
        self._pace = Pace(stop=stop)
        self._backlog = Backlog()
        self._is_timed = address.text.partition("://")[0].lower() in TIMED_SCHEMES
        self._sender_clock = DeviceClock()
        self._stamps = DriverClock()
        self._is_file = False
        self._is_jpeg = False
        self._stream: cv2.VideoCapture | None = None
        self._torn = 0

    @property
    def camera(self) -> CameraStatus | None:
        """Whose clock stamped its last image; None of a file."""
        if self._is_file:
            return None
        is_used = self._is_timed and self._stamps.clock is ImageClock.DRIVER
        return CameraStatus(clock=ImageClock.SENDER if is_used else ImageClock.ARRIVAL)

    def open(self) -> None:
        """Connect; takes at most about 4 s, and half a second when nobody answers."""
        self.close()
        self._knock()
        stream = open_stream(self._address)
        if not stream.isOpened():
            stream.release()
            raise CaptureError(
                "STREAM_WITHOUT_VIDEO",
                f"the stream {self.name} answers, but gives no video within {OPEN_TIMEOUT_MS / 1000:g} s",
                "Check path, user and password of the stream; it is tried again by itself.",
                {"stream": self.name, "timeout_ms": OPEN_TIMEOUT_MS},
            )
        images = float(stream.get(cv2.CAP_PROP_FRAME_COUNT))
        self._is_file = math.isfinite(images) and images > 0
        # OpenCV scales images that change their size in a stream to its first size, whatever their shape, and
        # does not say so; of JPEG, it can hand them over as they came.
        is_jpeg = int(stream.get(cv2.CAP_PROP_FOURCC)) == cv2.VideoWriter.fourcc(*"MJPG")
        self._is_jpeg = is_jpeg and not self._is_file and bool(stream.set(cv2.CAP_PROP_FORMAT, -1))
        self._pace.restart()
        self._backlog.restart()
        self._sender_clock.restart()
        self._stamps.restart()
        self._torn = 0
        self._stream = stream

    def read(self) -> Shot | None:
        """The next image."""
        if self._stream is None:
            raise self._stopped()
        image, captured_at_s = self._newest(self._stream)
        source_time_s = captured_at_s
        if self._is_file:
            source_time_s = float(self._stream.get(cv2.CAP_PROP_POS_MSEC)) / 1000.0
            self._pace.wait_until_due(source_time_s)
            captured_at_s = self._clock()
        shot = Shot(
            image=np.asarray(image, dtype=np.uint8),
            number=self._number,
            captured_at_s=captured_at_s,
            source_time_s=source_time_s,
        )
        self._number += 1
        return shot

    def close(self) -> None:
        """Hang up."""
        if self._stream is not None:
            self._stream.release()
            self._stream = None

    def _newest(self, stream: cv2.VideoCapture) -> tuple[np.ndarray, float]:
        """The next image that is whole and did not wait, with the time it was taken; others are counted."""
        while True:
            good = stream.grab()
            arrived_s = self._clock()
            if not good:
                raise self._stopped()
            captured_at_s = self._captured_at_s(stream, arrived_s)
            is_old = not self._is_file and self._backlog.is_old(arrived_s)
            if not is_old:
                image = self._decoded(stream)
                if image is not None:
                    self._torn = 0
                    return image, captured_at_s
                self._torn += 1
            if self._torn > MAX_TORN:
                raise self._all_torn()
            if is_old and self._backlog.old_for_s(arrived_s) > MAX_OLD_S:
                raise self._in_bursts()
            self._number += 1

    def _captured_at_s(self, stream: cv2.VideoCapture, arrived_s: float) -> float:
        """By the sender's clock where the stream has it, as far as that can be believed; else the arrival.

        The clock is known but for its offset. FFmpeg does tell the wall-clock time of the first sender report
        (CAP_PROP_STREAM_OPEN_TIME_USEC), but not how far that is from the time here.
        """
        if not self._is_timed or self._is_file:
            return arrived_s
        jumps, had_given_up = self._sender_clock.jumps, self._stamps.gave_up
        sender_s = float(stream.get(cv2.CAP_PROP_POS_MSEC)) / 1000.0
        at_s = self._sender_clock.monotonic_s(sender_s, arrived_s=arrived_s)
        captured_at_s = self._stamps.captured_at_s(at_s, arrived_s=arrived_s)
        if self._stamps.gave_up and not had_given_up:
            log.warning(
                "the times in the stream are implausible; images count from their arrival",
                code="STREAM_CLOCK_IMPLAUSIBLE",
                stream=self.name,
                remedy="Ages have the network's jitter now. Restart the camera, and update its firmware.",
            )
        elif self._sender_clock.jumps > jumps and not had_given_up:
            log.warning(
                "the clock of the stream's sender jumped; it is taken up anew",
                code="STREAM_CLOCK_JUMPED",
                stream=self.name,
                sender_s=round(sender_s, 3),
                remedy="See that the camera's time server sets its clock once, and not again and again.",
            )
        return captured_at_s

    def _decoded(self, stream: cv2.VideoCapture) -> np.ndarray | None:
        """The image in its own size; None of a JPEG that is cut off."""
        content = stream.retrieve()[1]
        if content is None:
            raise self._stopped()
        if not self._is_jpeg:
            return np.asarray(content)
        image = cv2.imdecode(content, cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION)
        return None if image is None else np.asarray(image)

    def _in_bursts(self) -> CaptureError:
        return CaptureError(
            "STREAM_IN_BURSTS",
            f"the stream {self.name} gives its images in bursts, and for {MAX_OLD_S:g} s none that did not "
            "wait on its way",
            "Set the camera to low latency, and connect it by cable; see that this machine is not busy. It "
            "is opened again by itself.",
            {"stream": self.name, "limit_s": MAX_OLD_S},
        )

    def _all_torn(self) -> CaptureError:
        return CaptureError(
            "STREAM_TORN",
            f"the stream {self.name} gave {self._torn} images in a row that are cut off",
            "Restart the camera, or what stands between it and this machine; it is opened again by itself.",
            {"stream": self.name, "images": self._torn},
        )

    def _stopped(self) -> CaptureError:
        return CaptureError(
            "STREAM_STOPPED",
            f"the stream {self.name} stopped: no image within {READ_TIMEOUT_MS / 1000:g} s, or it was closed",
            "Check the camera, its power and the network; it is tried again by itself.",
            {"stream": self.name, "timeout_ms": READ_TIMEOUT_MS},
        )

    def _knock(self) -> None:
        """See whether anybody answers at all, and say why not."""
        try:
            parts = urlsplit(self._address)
            port = parts.port or DEFAULT_PORTS.get(parts.scheme.lower())
        except ValueError:
            # Not the error's own words, and not the error: they show what stands where the port should,
            # which is a password when that has / ? or # in it.
            raise CaptureError(
                "STREAM_ADDRESS_INVALID",
                f"the stream's address {self.name} cannot be understood: its host or port is none",
                "Give an address like rtsp://user:password@camera:554/path, in which / ? # @ of a password "
                "are written as %2F %3F %23 %40.",
                {"stream": self.name},
            ) from None
        if parts.hostname is None or port is None:
            return
        try:
            socket.create_connection((parts.hostname, port), timeout=KNOCK_TIMEOUT_S).close()
        except OSError as error:
            reason = f"no answer within {KNOCK_TIMEOUT_S:g} s"
            if not isinstance(error, TimeoutError):
                reason = (error.strerror or str(error)).lower()
            raise CaptureError(
                "STREAM_UNREACHABLE",
                f"the stream {self.name} cannot be reached at {parts.hostname}:{port}: {reason}",
                "Check address, cable and power of the camera; it is tried again by itself.",
                {"stream": self.name, "host": parts.hostname, "port": port},
            ) from error
