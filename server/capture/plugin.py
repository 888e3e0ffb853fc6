"""An image source of another package (`plugin:NAME` or `plugin:NAME:ADDRESS`).

The output of a plug-in is not trusted: image and time are validated before they count as live.
"""

import contextlib
import math
import time
from typing import Any

import numpy as np
import numpy.typing as npt

from server.capture.address import SourceAddress
from server.capture.shot import Shot, is_bgr
from server.errors import CaptureError
from server.live import CameraStatus, ImageClock
from server.plugins import IMAGE_SOURCES, PluginError, load_plugin


class PluginSource:
    """A live camera read by a plug-in; `docs/guide/plugins.md` describes the interface."""

    def __init__(self, address: SourceAddress, *, first_number: int) -> None:
        self.name = address.name
        self.waits_for_consumer = False
        self.stalls = True
        self.defect: CaptureError | None = None
        self.camera: CameraStatus | None = None
        _, self._plugin, self._address = (*address.text.split(":", 2), "")[:3]
        self._number = first_number
        self._captured_at_s = -math.inf
        self._source: Any = None

    def open(self) -> None:
        """Load the plug-in and open its source."""
        self.close()
        try:
            self._source = load_plugin(IMAGE_SOURCES, self._plugin)(self._address)
        except PluginError as error:
            raise CaptureError(error.code, error.message, error.remedy, error.context) from error
        except Exception as error:
            raise self._failed("cannot be opened", error) from error

    def read(self) -> Shot:
        """Return the next image.

        Raises:
            CaptureError: PLUGIN_SOURCE_FAILED; PLUGIN_IMAGE_INVALID, PLUGIN_TIME_INVALID.
        """
        try:
            image, captured_at_s = self._source.read()
        except Exception as error:
            raise self._failed("returned no image", error) from error
        self._captured_at_s = self._checked_time_s(captured_at_s, arrived_at_s=time.monotonic())
        shot = Shot.live(
            self._checked_image(image),
            number=self._number,
            captured_at_s=self._captured_at_s,
            is_predicted=bool(getattr(self._source, "is_predicted", False)),
        )
        clock = ImageClock.ARRIVAL if captured_at_s is None else ImageClock.DRIVER
        self.camera = CameraStatus(clock=clock, requested=None, granted=None, is_predicted=shot.is_predicted)
        self._number += 1
        return shot

    def close(self) -> None:
        """Close the source of the plug-in; its errors are ignored."""
        source, self._source = self._source, None
        if source is not None:
            with contextlib.suppress(Exception):
                source.close()

    def _checked_image(self, image: object) -> npt.NDArray[np.uint8]:
        """Return a copy of the image, because the plug-in may write the next one into the same array."""
        if isinstance(image, np.ndarray) and is_bgr(image):
            return np.array(image, order="C")
        given = f"{image.dtype} {image.shape}" if isinstance(image, np.ndarray) else type(image).__name__
        raise self._invalid(
            "PLUGIN_IMAGE_INVALID", f"an image that is {given}, allowed: uint8 (height, width, 3)"
        )

    def _checked_time_s(self, captured_at_s: object, *, arrived_at_s: float) -> float:
        """Return the capture time; rejects a time in the future, which would make an old image look live."""
        if captured_at_s is None:
            return arrived_at_s
        if (
            not isinstance(captured_at_s, int | float)
            or not self._captured_at_s < captured_at_s <= arrived_at_s
        ):
            allowed = f"allowed: None, or a number above {self._captured_at_s!r} and up to {arrived_at_s!r}"
            raise self._invalid("PLUGIN_TIME_INVALID", f"an image with the time {captured_at_s!r}, {allowed}")
        return float(captured_at_s)

    def _failed(self, what: str, error: Exception) -> CaptureError:
        reason = f"{type(error).__name__}: {error}"
        return CaptureError(
            "PLUGIN_SOURCE_FAILED",
            f"the plug-in {self._plugin} {what}: {reason}",
            "Check the camera of the plug-in and its address in camera.source; it is retried automatically.",
            {"plugin": self._plugin, "plugin_problem": what, "library_error": reason},
        )

    def _invalid(self, code: str, what: str) -> CaptureError:
        return CaptureError(
            code,
            f"the plug-in {self._plugin} returned {what}",
            "Correct or update the plug-in; it is retried automatically.",
            {"plugin": self._plugin},
        )
