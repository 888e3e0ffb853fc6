"""A recording of Coaxial as a source: its images at its own rate or as fast as possible, once or looped."""

import time
from collections.abc import Iterator
from pathlib import Path

from server.capture.pacer import Pacer
from server.capture.shot import Shot
from server.errors import CaptureError, RecordingError
from server.live import CameraStatus
from server.recording_file import RecordedMessage, RecordingReader, Topic, rejecting_other_content

FALLBACK_PERIOD_S = 1.0 / 30.0


class RecordingSource:
    """Images of a recording at their capture times; an incomplete file is played up to its end."""

    def __init__(self, path: Path, *, loop: bool, pacer: Pacer | None, first_number: int = 0) -> None:
        self.name = str(path)
        self.waits_for_consumer = pacer is None
        self.stalls = False
        self.defect: CaptureError | None = None
        self.camera: CameraStatus | None = None
        self._path = path
        self._loop = loop
        self._number = first_number
        self._pacer = pacer
        self._reader: RecordingReader | None = None
        self._images: Iterator[RecordedMessage] = iter(())
        self._is_predicted = False
        self._read_in_pass = 0
        self._began_s = 0.0
        self._offset_s = 0.0
        self._last_s = -FALLBACK_PERIOD_S

    def open(self) -> None:
        """Open the file at its first image."""
        self._offset_s, self._last_s = 0.0, -FALLBACK_PERIOD_S
        self._start_pass()
        if self._pacer is not None:
            self._pacer.restart()

    def read(self) -> Shot | None:
        """Return the next image when it is due.

        Raises:
            CaptureError: RECORDING_WITHOUT_IMAGES.
        """
        message = self._next()
        if message is None:
            if self._read_in_pass == 0:
                raise self._without_images()
            if not self._loop:
                return None
            self._offset_s = self._last_s + FALLBACK_PERIOD_S
            self._start_pass()
            message = self._next()
            if message is None:
                raise self._without_images()
        image, packed = message.image, message.packed
        if image is None or packed is None:
            raise CaptureError(
                "RECORDING_IMAGE_BROKEN",
                f"image {message.sequence} of {self.name} cannot be decoded",
                "Use another recording; coaxial replay prints the contents of this one.",
                {"file": self.name, "image_number": message.sequence},
            )
        if self._read_in_pass == 0:
            self._began_s = message.unix_s
        self._read_in_pass += 1
        self._last_s = self._offset_s + message.unix_s - self._began_s
        if self._pacer is not None:
            self._pacer.wait_until_due(self._last_s)
        shot = Shot(
            image=image,
            number=self._number,
            captured_at_s=time.monotonic(),
            source_time_s=self._last_s,
            is_predicted=self._is_predicted,
            jpeg=packed.content if packed.is_jpeg else b"",
        )
        self._number += 1
        return shot

    def close(self) -> None:
        """Close the file."""
        if self._reader is not None:
            self._reader.close()
            self._reader = None
        self._images = iter(())

    def _start_pass(self) -> None:
        self.close()
        try:
            self._reader = RecordingReader(self._path)
        except RecordingError as error:
            raise _capture_error(error) from error
        self._images = self._reader.messages()
        self._read_in_pass = 0

    def _next(self) -> RecordedMessage | None:
        try:
            with rejecting_other_content(self._path):
                for message in self._images:
                    if message.topic is Topic.TRACKED:
                        self._is_predicted = bool(message.json()["is_predicted"])
                    elif message.topic is Topic.IMAGE:
                        return message
        except RecordingError as error:
            raise _capture_error(error) from error
        return None

    def _without_images(self) -> CaptureError:
        return CaptureError(
            "RECORDING_WITHOUT_IMAGES",
            f"the recording {self.name} has no image",
            "Use another recording; coaxial replay prints the contents of this one.",
            {"file": self.name},
        )


def _capture_error(error: RecordingError) -> CaptureError:
    return CaptureError(error.code, error.message, error.remedy, error.context)
