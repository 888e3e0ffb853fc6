"""A folder of images as a source, in natural sort order."""

import itertools
import re
import time
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import numpy.typing as npt

from server.capture.codecs import silence_codecs
from server.capture.pacer import Pacer
from server.capture.shot import Shot
from server.errors import CaptureError
from server.image_file import JPEG_START, decoded
from server.live import CameraStatus

IMAGE_SUFFIXES = (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp", ".pgm", ".ppm")
DEFAULT_RATE_HZ = 30.0
MAX_NAMED = 3


class FolderSource:
    """Images of a folder at a constant rate; listed again at each repeat, so it may grow.

    It goes on at the file of `first_number`, so that numbers match files also after a restart of the process.
    """

    def __init__(
        self,
        folder: Path,
        *,
        loop: bool,
        pacer: Pacer | None,
        rate_hz: float | None = None,
        first_number: int = 0,
    ) -> None:
        self.name = str(folder)
        self.waits_for_consumer = pacer is None
        self.stalls = False
        self.camera: CameraStatus | None = None
        self._folder = folder
        self._loop = loop
        self._period_s = 1.0 / (rate_hz or DEFAULT_RATE_HZ)
        self._number = first_number
        self._pacer = pacer
        self._files: list[Path] = []
        self._reason_from_unusable: dict[Path, str] = {}
        self._next = 0
        self._given = 0
        self._given_in_pass = 0

    @property
    def defect(self) -> CaptureError | None:
        """The unusable images with reasons; None if all are usable."""
        return _unreadable(self._reason_from_unusable) if self._reason_from_unusable else None

    def open(self) -> None:
        """List the folder, and continue after the image that was returned last."""
        self._list()
        self._next = self._given_in_pass = self._number % len(self._files)
        self._given = 0
        if self._pacer is not None:
            self._pacer.restart()

    def read(self) -> Shot | None:
        """Return the next decodable image when it is due."""
        while True:
            if self._next >= len(self._files):
                if self._files and self._given_in_pass == 0:
                    raise self.defect or self._empty()
                if not self._loop:
                    return None
                self._list()
            file = self._files[self._next]
            self._next += 1
            image, jpeg = self._decode(file)
            if image is not None:
                break
            # A skipped image keeps its number and time slot.
            self._number += 1
            self._given += 1
        source_time_s = self._given * self._period_s
        if self._pacer is not None:
            self._pacer.wait_until_due(source_time_s)
        shot = Shot(
            image=image,
            number=self._number,
            captured_at_s=time.monotonic(),
            source_time_s=source_time_s,
            file=file.name,
            jpeg=jpeg,
        )
        self._number += 1
        self._given += 1
        self._given_in_pass += 1
        return shot

    def close(self) -> None:
        """Do nothing, because no file stays open."""

    def _list(self) -> None:
        try:
            files = [
                path
                for path in self._folder.iterdir()
                if path.suffix.lower() in IMAGE_SUFFIXES and not path.name.startswith(".")
            ]
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            raise CaptureError(
                "SOURCE_NOT_FOUND",
                f"the folder {self.name} cannot be listed: {reason}",
                "Check the path in camera.source or --source; it is retried automatically.",
                {"folder": self.name, "system_error": reason},
            ) from error
        if not files:
            raise self._empty()
        self._files = sorted(files, key=natural_order)
        for gone in self._reason_from_unusable.keys() - set(files):
            del self._reason_from_unusable[gone]
        self._next = 0
        self._given_in_pass = 0

    def _decode(self, file: Path) -> tuple[npt.NDArray[np.uint8] | None, bytes]:
        """Return the image of a file, and its JPEG if it is one; None for an unusable one."""
        silence_codecs()
        image, content = None, b""
        try:
            content = file.read_bytes()
            image = decoded(content)
            reason = f"its {len(content)} bytes are not an image, or a damaged one"
        except OSError as error:
            reason = (error.strerror or "it cannot be read").lower()
        if image is None:
            self._reason_from_unusable[file] = reason
        else:
            # The file may have been replaced since.
            self._reason_from_unusable.pop(file, None)
        return image, content if content.startswith(JPEG_START) else b""

    def _empty(self) -> CaptureError:
        suffixes = ", ".join(IMAGE_SUFFIXES)
        return CaptureError(
            "FOLDER_WITHOUT_IMAGES",
            f"the folder {self.name} has 0 images ({suffixes})",
            "Put images into the folder, or give another folder; it is retried automatically.",
            {"folder": self.name, "images": 0, "suffixes": suffixes},
        )


def _unreadable(reason_from_file: Mapping[Path, str]) -> CaptureError:
    """Return one error for all unusable images, with the names of the first ones."""
    first = list(itertools.islice(reason_from_file.items(), MAX_NAMED))
    context = {"file": str(first[0][0]), "files": [str(file) for file, _ in first]}
    count = len(reason_from_file)
    if count == 1:
        return CaptureError(
            "FOLDER_IMAGE_UNREADABLE",
            f"the image {first[0][0]} cannot be used: {first[0][1]}",
            "Replace the image or remove it from the folder; it is skipped until then.",
            {**context, "images": count, "image_problem": first[0][1]},
        )
    rest = f" and {count - MAX_NAMED} more" if count > MAX_NAMED else ""
    named = ", ".join(f"{file} ({reason})" for file, reason in first)
    return CaptureError(
        "FOLDER_IMAGE_UNREADABLE",
        f"{count} images cannot be used: {named}{rest}",
        "Replace them or remove them from the folder; they are skipped until then.",
        {**context, "images": count, "unusable_images": named, "more_images": rest},
    )


def natural_order(path: Path) -> list[tuple[int, int, str]]:
    """Sort key that puts image2 before image10."""
    parts = re.split(r"(\d+)", path.name.lower())
    return [(0, int(part), "") if part.isdecimal() else (1, 0, part) for part in parts if part]
