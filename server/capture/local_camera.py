"""A camera at this machine as a source."""

import time

import cv2
import numpy as np

from server.capture.address import SourceAddress
from server.capture.codecs import open_device
from server.capture.shot import Shot
from server.errors import CaptureError


class LocalCameraSource:
    """Images of a local camera, the moment they arrive."""

    def __init__(
        self,
        address: SourceAddress,
        *,
        size_wh_px: tuple[int, int] | None = None,
        rate_hz: float | None = None,
        first_number: int = 0,
    ) -> None:
        self.name = address.name
        self.waits_for_taker = False
        self.stalls = True
        self.defect: CaptureError | None = None
        self._device = address.text
        self._size_wh_px = size_wh_px
        self._rate_hz = rate_hz
        self._number = first_number
        self._camera: cv2.VideoCapture | None = None

    def open(self) -> None:
        """Open the device and ask it for size and rate."""
        self.close()
        camera = open_device(self._device)
        if not camera.isOpened():
            camera.release()
            raise CaptureError(
                "CAMERA_NOT_OPENED",
                f"{self.name} cannot be opened",
                "Check its cable, that no other program holds it, and the right to read it (group 'video'); "
                "it is tried again by itself.",
                {"camera": self.name},
            )
        if self._size_wh_px is not None:
            camera.set(cv2.CAP_PROP_FRAME_WIDTH, self._size_wh_px[0])
            camera.set(cv2.CAP_PROP_FRAME_HEIGHT, self._size_wh_px[1])
        if self._rate_hz is not None:
            camera.set(cv2.CAP_PROP_FPS, self._rate_hz)
        self._camera = camera

    def read(self) -> Shot | None:
        """The next image."""
        image = None
        captured_at_s = 0.0
        if self._camera is not None and self._camera.grab():
            captured_at_s = time.monotonic()
            image = self._camera.retrieve()[1]
        if image is None:
            raise CaptureError(
                "CAMERA_STOPPED",
                f"{self.name} gave no image",
                "Check its cable and power; it is tried again by itself.",
                {"camera": self.name},
            )
        shot = Shot(
            image=np.asarray(image, dtype=np.uint8),
            number=self._number,
            captured_at_s=captured_at_s,
            source_time_s=captured_at_s,
        )
        self._number += 1
        return shot

    def close(self) -> None:
        """Let go of the device."""
        if self._camera is not None:
            self._camera.release()
            self._camera = None
