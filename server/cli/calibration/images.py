"""Images for calibration: files, folders or patterns, read one after the other."""

import glob
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from server.picture_file import decoded
from tracker.errors import CalibrationError, InvalidInput

ENDINGS = {".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp", ".pgm", ".ppm"}
REMEDY = "Give images of the board: files, a folder, or a pattern as 'images/*.png'."


@dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """One image file.

    Attributes:
        name: as it is told.
        image: (h, w, 3), as the sensor gave it: what a file says about its turning is left aside.
    """

    name: str
    image: npt.NDArray[np.uint8]


def files_of(given: Sequence[str]) -> list[Path]:
    """The image files that are meant, in order, each once.

    Raises:
        InvalidInput: IMAGES_MISSING.
    """
    files: list[Path] = []
    for text in given:
        path = Path(text)
        if path.is_dir():
            found = sorted(one for one in path.iterdir() if one.suffix.lower() in ENDINGS and one.is_file())
        elif path.exists():
            found = [path]
        else:
            found = [Path(one) for one in sorted(glob.glob(text, recursive=True)) if Path(one).is_file()]  # noqa: PTH207  a pattern may be absolute
        if not found:
            what = (
                "holds no image" if path.is_dir() else "is no file, no folder, and no pattern that fits one"
            )
            raise InvalidInput("IMAGES_MISSING", f"{text} {what}", REMEDY, {"given": text})
        files += found
    return list(dict.fromkeys(files))


def names_of(files: Sequence[Path]) -> list[str]:
    """Short names, that are still told apart."""
    short = [file.name for file in files]
    return short if len(set(short)) == len(short) else [str(file) for file in files]


def pictures(files: Sequence[Path]) -> Iterator[Picture]:
    """The images, all of one size.

    Raises:
        InvalidInput: IMAGE_UNREADABLE.
        CalibrationError: IMAGE_SIZES_DIFFER.
    """
    first: Picture | None = None
    for file, name in zip(files, names_of(files), strict=True):
        picture = Picture(name=name, image=_read(file))
        first = first or picture
        sizes = [f"{one.image.shape[1]}x{one.image.shape[0]}" for one in (first, picture)]
        if sizes[0] != sizes[1]:
            raise CalibrationError(
                "IMAGE_SIZES_DIFFER",
                f"{picture.name} has {sizes[1]} px, and {first.name} {sizes[0]} px: one camera, one size",
                "Give images of one camera at one setting, not cropped or scaled.",
                {"image": picture.name, "size": sizes[1], "first": first.name, "first_size": sizes[0]},
            )
        yield picture


def _read(file: Path) -> npt.NDArray[np.uint8]:
    try:
        content = file.read_bytes()
    except OSError as error:
        why = (error.strerror or str(error)).lower()
        raise InvalidInput(
            "IMAGE_UNREADABLE", f"{file} cannot be read: {why}", REMEDY, {"file": str(file)}
        ) from error
    read = decoded(content)
    if read is None:
        raise InvalidInput("IMAGE_UNREADABLE", f"{file} is no image", REMEDY, {"file": str(file)})
    return read
