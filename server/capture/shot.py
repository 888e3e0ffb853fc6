"""One image from a source, and what every source can do."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from server.errors import CaptureError
from server.live import CameraStatus


@dataclass(frozen=True, slots=True, kw_only=True)
class Shot:
    """One image as the source gave it.

    Attributes:
        image: (h, w, 3), BGR.
        number: counts every image that the source gave; grows over repeats of a file and reconnections.
        captured_at_s: monotonic time at the grab.
        source_time_s: the source's own time: a file's timestamp, the theatre's clock; for a live source
            the same as captured_at_s.
        file: name of the image's own file; None where it has none.
    """

    image: npt.NDArray[np.uint8]
    number: int
    captured_at_s: float
    source_time_s: float
    file: str | None = None


class Source(Protocol):
    """Something that gives images, at its own pace: `read` returns when the next one is there.

    Attributes:
        name: what may be shown; passwords are masked.
        waits_for_taker: whether each image must be taken before the next is read (as fast as possible, none
            skipped); otherwise images come when they come, and the newest wins.
        stalls: whether silence means that something is wrong (a camera), not that the next image is not due.
        defect: what is wrong with the source although it gives images (a cut file, one bad image in a
            folder); None while nothing is.
        camera: what is known of the camera; None where images come from files or are rendered.
    """

    name: str
    waits_for_taker: bool

    @property
    def stalls(self) -> bool:
        """Whether silence means that something is wrong."""

    @property
    def defect(self) -> CaptureError | None:
        """What is wrong with it although it gives images."""

    @property
    def camera(self) -> CameraStatus | None:
        """What is known of the camera."""

    def open(self) -> None:
        """Make ready to read. May block for some seconds.

        Raises:
            CaptureError: it cannot be opened.
        """

    def read(self) -> Shot | None:
        """The next image; None at the end of a file that is not looped.

        Raises:
            CaptureError: it gives no more images.
        """

    def close(self) -> None:
        """Let go of the device or file; harmless when it is not open."""
