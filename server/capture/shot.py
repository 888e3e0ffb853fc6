"""One image from a source, and the interface of all sources."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from server.errors import CaptureError
from server.live import CameraStatus
from tracker.geometry import Camera, Marker, Rigid


def is_bgr(image: np.ndarray) -> bool:
    """Return whether an array is an image of three 8-bit channels (h, w, 3), and not empty."""
    return image.dtype == np.uint8 and image.ndim == 3 and image.shape[2] == 3 and image.size > 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Shot:
    """One image of a source.

    Attributes:
        image: (h, w, 3), BGR.
        number: Counts all images of the source, also over repeats of a file and reconnections.
        captured_at_s: monotonic time of the capture.
        source_time_s: the source's own time: a file's timestamp, the theatre's clock; for a live source
            the same as captured_at_s.
        file: name of the image's own file; None where it has none.
        is_predicted: whether it was decoded from video whose images are predicted from earlier ones.
        jpeg: the source's own JPEG, which `decoded` turns into the same image; empty where it has none.
        poses: the valid poses of an external tracker by body, whose image is blank; None for a camera.
    """

    image: npt.NDArray[np.uint8]
    number: int
    captured_at_s: float
    source_time_s: float
    file: str | None = None
    is_predicted: bool = False
    jpeg: bytes = b""
    poses: Mapping[str, Rigid[Camera, Marker]] | None = None

    @classmethod
    def live(
        cls,
        image: npt.NDArray[np.uint8],
        *,
        number: int,
        captured_at_s: float,
        is_predicted: bool = False,
        jpeg: bytes = b"",
    ) -> "Shot":
        """Return an image of a live source, whose own time is that of the capture."""
        return cls(
            image=image,
            number=number,
            captured_at_s=captured_at_s,
            source_time_s=captured_at_s,
            is_predicted=is_predicted,
            jpeg=jpeg,
        )


class Source(Protocol):
    """A source of images; `read` blocks until the next image.

    Attributes:
        name: display name, with passwords masked.
        waits_for_consumer: whether each image must be taken before the next is read (as fast as possible,
            none skipped); otherwise the newest image wins.
        stalls: whether missing images mean an error (a camera), not that the next image is not due.
        defect: Problem of a source that still delivers images (a truncated file, an unreadable image in a
            folder); None without one.
        camera: status of the camera; None for files and rendered images.
    """

    name: str
    waits_for_consumer: bool

    @property
    def stalls(self) -> bool:
        """Whether missing images mean an error."""

    @property
    def defect(self) -> CaptureError | None:
        """Problem of a source that still delivers images."""

    @property
    def camera(self) -> CameraStatus | None:
        """Status of the camera."""

    def open(self) -> None:
        """Open the source. May block for some seconds.

        Raises:
            CaptureError: it cannot be opened.
        """

    def read(self) -> Shot | None:
        """Return the next image; None at the end of a file that is not looped.

        Raises:
            CaptureError: The source delivers no more images.
        """

    def close(self) -> None:
        """Release the device or file; does nothing if it is not open."""
