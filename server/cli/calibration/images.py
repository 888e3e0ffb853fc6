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
        name: as shown in reports.
        image: (h, w, 3), as the sensor gave it: what a file says about its turning is left aside.
    """

    name: str
    image: npt.NDArray[np.uint8]


@dataclass(frozen=True, slots=True, kw_only=True)
class Unusable:
    """An image file in which no board can be looked for, and why, in a sentence."""

    name: str
    sentence: str


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
    """Return the shortest names that distinguish the files."""
    short = [file.name for file in files]
    return short if len(set(short)) == len(short) else [str(file) for file in files]


def read_picture(file: Path, name: str) -> Picture | Unusable:
    """The image in a file, or why there is none."""
    try:
        content = file.read_bytes()
    except OSError as error:
        return Unusable(name=name, sentence=f"it cannot be read: {(error.strerror or str(error)).lower()}")
    image = decoded(content)
    if image is None:
        return Unusable(name=name, sentence=f"its {len(content)} bytes are no image")
    if min(image.shape[:2]) < MIN_SIDE_PX:
        size = f"{image.shape[1]}x{image.shape[0]}"
        return Unusable(name=name, sentence=f"it has {size} px, needed are {MIN_SIDE_PX}x{MIN_SIDE_PX}")
    return Picture(name=name, image=image)


def usual_size(sizes_wh_px: Mapping[str, tuple[int, int]], unusable: Sequence[Unusable]) -> tuple[int, int]:
    """The size of more than half of the images, by their names: one camera has one size.

    Raises:
        InvalidInput: IMAGE_UNREADABLE, there is no image at all.
        CalibrationError: IMAGE_SIZES_DIFFER, no size is that of more than half.
    """
    if not sizes_wh_px:
        first = unusable[0]
        more = f", nor are {len(unusable) - 1} more" if unusable[1:] else ""
        raise InvalidInput(
            "IMAGE_UNREADABLE",
            f"{first.name} is no image that can be used: {first.sentence}{more}",
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
        f"{', and '.join(reported)}: one camera, one size",
        "Give images of one camera at one setting, not cropped or scaled.",
        {"sizes": {f"{size[0]}x{size[1]}": n for size, n in Counter(sizes_wh_px.values()).items()}},
    )
