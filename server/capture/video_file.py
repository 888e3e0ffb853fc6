"""A video file as a source: at its own rate or as fast as possible, once or looped."""

import time
from pathlib import Path

import cv2
import numpy as np

from server.capture.codecs import is_predicted, open_file, set_jpeg_packets
from server.capture.pacer import Pacer
from server.capture.shot import Shot
from server.errors import CaptureError
from server.image_file import DamagedJpeg, decode_jpeg
from server.live import CameraStatus

FALLBACK_RATE_HZ = 30.0
# The number of images in a container may be an estimate; a file that lacks more than this is truncated.
CUT_RATIO = 0.05
CUT_IMAGES = 2


class VideoFileSource:
    """Images of a video file, at its timestamps; damaged JPEGs are left out and keep their number."""

    def __init__(
        self,
        path: Path,
        *,
        loop: bool,
        pacer: Pacer | None,
        rate_hz: float | None = None,
        first_number: int = 0,
    ) -> None:
        self.name = str(path)
        self.waits_for_consumer = pacer is None
        self.stalls = False
        self.defect: CaptureError | None = None
        self.camera: CameraStatus | None = None
        self._path = path
        self._loop = loop
        self._rate_hz = rate_hz
        self._number = first_number
        self._pacer = pacer
        self._video: cv2.VideoCapture | None = None
        self._is_predicted = False
        self._is_jpeg = False
        self._claimed = 0
        self._read_in_pass = 0
        self._damaged_in_pass = 0
        self._offset_s = 0.0
        self._last_s = 0.0

    def open(self) -> None:
        """Open the file at its first image."""
        self._start_pass()
        self._offset_s = 0.0
        if self._pacer is not None:
            self._pacer.restart()

    def read(self) -> Shot | None:
        """Return the next image when it is due."""
        image, time_s = self._decode()
        if image is None:
            if self._read_in_pass == 0:
                raise self._no_video("it has no image that can be decoded")
            self._note_if_cut()
            if not self._loop:
                return None
            self._offset_s += self._last_s + self._period_s()
            self._start_pass()
            image, time_s = self._decode()
            if image is None:
                raise self._no_video("it has no image that can be decoded")
        if self._pacer is not None:
            self._pacer.wait_until_due(self._offset_s + time_s)
        shot = Shot(
            image=image,
            number=self._number,
            captured_at_s=time.monotonic(),
            source_time_s=self._offset_s + time_s,
            is_predicted=self._is_predicted,
        )
        self._number += 1
        return shot

    def close(self) -> None:
        """Close the file."""
        if self._video is not None:
            self._video.release()
            self._video = None

    def _decode(self) -> tuple[np.ndarray | None, float]:
        """Return the next intact image with its time; None at the end."""
        if self._video is None:
            raise self._no_video("it is not open")
        while True:
            good, content = self._video.read()
            if not good or content is None:
                return None, 0.0
            time_s = self._time_s(self._video)
            image = np.asarray(content, dtype=np.uint8)
            decoded = decode_jpeg(image) if self._is_jpeg else image
            if not isinstance(decoded, DamagedJpeg):
                return decoded, time_s
            self._number += 1
            self._damaged_in_pass += 1
            self.defect = self._damaged(decoded.reason)

    def _time_s(self, video: cv2.VideoCapture) -> float:
        time_s = float(video.get(cv2.CAP_PROP_POS_MSEC)) / 1000.0
        # Some files have no or constant timestamps: then the rate is used.
        if self._read_in_pass > 0 and not time_s > self._last_s:
            time_s = self._last_s + self._period_s()
        self._read_in_pass += 1
        self._last_s = time_s
        return time_s

    def _start_pass(self) -> None:
        # Reopened at each repeat, because seeking to the first image is not exact in every container, and the
        # file may have been replaced.
        self.close()
        _check_readable(self._path)
        video = open_file(str(self._path))
        if not video.isOpened():
            video.release()
            raise self._no_video("it cannot be decoded as video")
        self._video = video
        self._is_predicted = is_predicted(video)
        self._is_jpeg = set_jpeg_packets(video)
        self._claimed = max(0, int(video.get(cv2.CAP_PROP_FRAME_COUNT)))
        self._read_in_pass = 0
        self._damaged_in_pass = 0
        self._last_s = 0.0

    def _period_s(self) -> float:
        rate_hz = float(self._video.get(cv2.CAP_PROP_FPS)) if self._video is not None else 0.0
        if not 0.1 <= rate_hz <= 1000.0:
            rate_hz = self._rate_hz or FALLBACK_RATE_HZ
        return 1.0 / rate_hz

    def _note_if_cut(self) -> None:
        missing = self._claimed - self._read_in_pass
        if not self._damaged_in_pass:
            self.defect = None
        if missing > max(CUT_IMAGES, CUT_RATIO * self._claimed):
            images = self._read_in_pass - self._damaged_in_pass
            self.defect = CaptureError(
                "VIDEO_FILE_CUT",
                f"the video file {self.name} ends after {images} of {self._claimed} images",
                "Copy or export the file again; the existing images are played.",
                {"file": self.name, "images": images, "claimed_images": self._claimed},
            )

    def _damaged(self, reason: str) -> CaptureError:
        return CaptureError(
            "VIDEO_IMAGES_DAMAGED",
            f"{self._damaged_in_pass} of {self._read_in_pass} images of {self.name} are damaged and not used "
            f"({reason})",
            "Copy or export the file again; the existing images are played.",
            {
                "file": self.name,
                "damaged_images": self._damaged_in_pass,
                "images": self._read_in_pass,
                "library_error": reason,
            },
        )

    def _no_video(self, reason: str) -> CaptureError:
        size = self._path.stat().st_size if self._path.is_file() else 0
        return CaptureError(
            "VIDEO_FILE_UNREADABLE",
            f"{self.name} ({size} bytes) is not a usable video file: {reason}",
            "Give a complete video file (MP4, MOV, AVI or MKV); copy or export a truncated file again.",
            {"file": self.name, "bytes": size, "video_problem": reason},
        )


def _check_readable(path: Path) -> None:
    """Raise for simple errors, for which the decoder would fail without a reason."""
    reason = ""
    if not path.exists():
        reason = "it does not exist"
    elif not path.is_file():
        # Opening a pipe without a writer would block forever.
        reason = "it is a pipe, a socket or a device, not a file"
    else:
        try:
            with path.open("rb") as file:
                if not file.read(1):
                    reason = "it is empty (0 bytes)"
        except OSError as error:
            reason = (error.strerror or "it cannot be read").lower()
    if reason:
        raise CaptureError(
            "SOURCE_NOT_FOUND" if "exist" in reason else "VIDEO_FILE_UNREADABLE",
            f"the source {path} cannot be opened: {reason}",
            "Check the path in camera.source or --source; it is retried automatically.",
            {"file": str(path), "source_problem": reason},
        )
