"""A folder of images as a source, in the order that a person would sort them."""

import re
import threading
import time
from pathlib import Path

import numpy as np
import numpy.typing as npt

from server.capture.codecs import silence_codecs
from server.capture.pace import Pace
from server.capture.shot import Shot
from server.errors import CaptureError
from server.picture_file import decoded

IMAGE_SUFFIXES = (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp", ".pgm", ".ppm")
DEFAULT_RATE_HZ = 30.0


class FolderSource:
    """Images of a folder at a steady rate; read again at each repeat, so that it may grow."""

    def __init__(
        self,
        folder: Path,
        *,
        loop: bool,
        fast: bool,
        stop: threading.Event,
        rate_hz: float | None = None,
        first_number: int = 0,
    ) -> None:
        self.name = str(folder)
        self.waits_for_taker = fast
        self.stalls = False
        self.defect: CaptureError | None = None
        self._folder = folder
        self._loop = loop
        self._period_s = 1.0 / (rate_hz or DEFAULT_RATE_HZ)
        self._number = first_number
        self._pace = None if fast else Pace(stop=stop)
        self._files: list[Path] = []
        self._next = 0
        self._given = 0
        self._given_in_pass = 0

    def open(self) -> None:
        """List the folder."""
        self._list()
        self._given = 0
        if self._pace is not None:
            self._pace.restart()

    def read(self) -> Shot | None:
        """The next image that can be decoded, when it is due."""
        while True:
            if self._next >= len(self._files):
                if self._files and self._given_in_pass == 0:
                    raise self.defect or self._empty()
                if not self._loop:
                    return None
                self._list()
            file = self._files[self._next]
            self._next += 1
            image = self._decode(file)
            if image is not None:
                break
            # It keeps its number and its time: those after it are as late as they are.
            self._number += 1
            self._given += 1
        source_time_s = self._given * self._period_s
        if self._pace is not None:
            self._pace.wait_until_due(source_time_s)
        shot = Shot(
            image=image,
            number=self._number,
            captured_at_s=time.monotonic(),
            source_time_s=source_time_s,
            file=file.name,
        )
        self._number += 1
        self._given += 1
        self._given_in_pass += 1
        return shot

    def close(self) -> None:
        """Nothing is held open."""

    def _list(self) -> None:
        try:
            files = [
                path
                for path in self._folder.iterdir()
                if path.suffix.lower() in IMAGE_SUFFIXES and not path.name.startswith(".")
            ]
        except OSError as error:
            raise CaptureError(
                "SOURCE_NOT_FOUND",
                f"the folder {self.name} cannot be listed: {(error.strerror or '').lower()}",
                "Check the path in camera.source or --source; it is tried again by itself.",
                {"folder": self.name},
            ) from error
        if not files:
            raise self._empty()
        self._files = sorted(files, key=natural_order)
        self._next = 0
        self._given_in_pass = 0

    def _decode(self, file: Path) -> npt.NDArray[np.uint8] | None:
        """The image in a file; None, and a defect noted, when it has none."""
        silence_codecs()
        image = None
        try:
            content = file.read_bytes()
            image = decoded(content)
            reason = f"its {len(content)} bytes are no picture that can be decoded"
        except OSError as error:
            reason = (error.strerror or "it cannot be read").lower()
        if image is not None:
            return image
        self.defect = CaptureError(
            "FOLDER_IMAGE_UNREADABLE",
            f"the image {file} cannot be used: {reason}",
            "Replace it or take it out of the folder; it is left out until then.",
            {"file": str(file)},
        )
        return None

    def _empty(self) -> CaptureError:
        return CaptureError(
            "FOLDER_WITHOUT_IMAGES",
            f"the folder {self.name} has 0 images ({', '.join(IMAGE_SUFFIXES)})",
            "Put images into the folder, or name another one; it is tried again by itself.",
            {"folder": self.name, "images": 0},
        )


def natural_order(path: Path) -> list[tuple[int, int, str]]:
    """Sorts image2 before image10."""
    parts = re.split(r"(\d+)", path.name.lower())
    return [(0, int(part), "") if part.isdecimal() else (1, 0, part) for part in parts if part]
