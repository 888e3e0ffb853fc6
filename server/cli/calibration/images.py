"""Images for calibration: files, folders or patterns, read one after the other."""

import glob
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from server.image_file import decoded
from tracker.errors import CalibrationError, InvalidInput

ENDINGS = {".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp", ".pgm", ".ppm"}
MIN_SIDE_PX = 16
REMEDY = "Give images of the board: files, a folder, or a pattern as 'images/*.png'."


@dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """One image file.

    Attributes:
        name: Name in reports.
        image: (h, w, 3), in the orientation of the sensor; the EXIF orientation is ignored.
    """

    name: str
    image: npt.NDArray[np.uint8]


@dataclass(frozen=True, slots=True, kw_only=True)
class Unusable:
    """An image file that cannot be used, with the reason as a sentence."""

    name: str
    sentence: str


def files_of(given: Sequence[str]) -> list[Path]:
    """Return the image files of paths, folders and patterns, in order and without duplicates.

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
                "contains no image"
                if path.is_dir()
                else "is not a file, a folder or a pattern that matches one"
            )
            raise InvalidInput("IMAGES_MISSING", f"{text} {what}", REMEDY, {"given": text})
        files += found
    return list(dict.fromkeys(files))


def names_of(files: Sequence[Path]) -> list[str]:
    """Return the shortest names that distinguish the files."""
    short = [file.name for file in files]
    return short if len(set(short)) == len(short) else [str(file) for file in files]


def read_picture(file: Path, name: str) -> Picture | Unusable:
    """Return the image in a file, or the reason why it cannot be used."""
    try:
        content = file.read_bytes()
    except OSError as error:
        return Unusable(name=name, sentence=f"it cannot be read: {(error.strerror or str(error)).lower()}")
    image = decoded(content)
    if image is None:
        return Unusable(name=name, sentence=f"its {len(content)} bytes are not a readable image")
    if min(image.shape[:2]) < MIN_SIDE_PX:
        size = f"{image.shape[1]}x{image.shape[0]}"
        return Unusable(name=name, sentence=f"it has {size} px, the minimum is {MIN_SIDE_PX}x{MIN_SIDE_PX}")
    return Picture(name=name, image=image)


def usual_size(sizes_wh_px: Mapping[str, tuple[int, int]], unusable: Sequence[Unusable]) -> tuple[int, int]:
    """Return the size that more than half of the images have; `sizes_wh_px` is by image name.

    Raises:
        InvalidInput: IMAGE_UNREADABLE, no image is readable.
        CalibrationError: IMAGE_SIZES_DIFFER, no size is in the majority.
    """
    if not sizes_wh_px:
        first = unusable[0]
        more = f" ({len(unusable) - 1} more images cannot be used)" if unusable[1:] else ""
        raise InvalidInput(
            "IMAGE_UNREADABLE",
            f"{first.name} cannot be used: {first.sentence}{more}",
            REMEDY,
            {"image": first.name, "unusable": len(unusable)},
        )
    (usual, count), *others = Counter(sizes_wh_px.values()).most_common()
    if 2 * count > len(sizes_wh_px):
        return usual
    named = {size: name for name, size in reversed(tuple(sizes_wh_px.items()))}
    reported = [f"{named[size]} has {size[0]}x{size[1]} px" for size in (usual, others[0][0])]
    raise CalibrationError(
        "IMAGE_SIZES_DIFFER",
        f"the images have different sizes: {', and '.join(reported)}",
        "Give images of one camera at one setting, not cropped or scaled.",
        {"sizes": {f"{size[0]}x{size[1]}": n for size, n in Counter(sizes_wh_px.values()).items()}},
    )
