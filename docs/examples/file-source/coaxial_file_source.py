"""An image source of Coaxial: a picture file that another program replaces with each new image."""

import time
from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt

LOOK_AGAIN_S = 0.002
TIMEOUT_S = 2.0


class FileSource:
    """Gives the picture at a path each time when it was replaced."""

    def __init__(self, address: str) -> None:
        """Take the path from `plugin:file:PATH`."""
        self._path = Path(address)
        self._written_at_ns = 0

    def read(self) -> tuple[npt.NDArray[np.uint8], float | None]:
        """Return the next image, BGR, and its capture time; None, because the file does not tell it."""
        deadline_s = time.monotonic() + TIMEOUT_S
        while time.monotonic() < deadline_s:
            written_at_ns = self._path.stat().st_mtime_ns
            image = cv2.imread(str(self._path)) if written_at_ns != self._written_at_ns else None
            # Where the other program is still writing, the picture cannot be decoded yet.
            if image is not None:
                self._written_at_ns = written_at_ns
                return image.astype(np.uint8, copy=False), None
            time.sleep(LOOK_AGAIN_S)
        raise TimeoutError(f"{self._path} was not replaced for {TIMEOUT_S:g} s")

    def close(self) -> None:
        """Do nothing: no file stays open."""
