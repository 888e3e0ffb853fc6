"""Reads the picture of a marker from a file, and refuses what cannot be one."""

from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt

from tracker.errors import InvalidInput

SMALLEST_SIDE_PX = 8
SQUARE_TOLERANCE_RATIO = 0.02
MIN_CONTRAST_GREY = 32
REMEDY = "Give a PNG, JPEG or BMP picture which the marker's black square fills edge to edge, row 0 on top."


def load_marker_image(path: Path) -> npt.NDArray[np.uint8]:
    """The picture of a marker as grey (h, w).

    Raises:
        InvalidInput: MARKER_IMAGE_UNREADABLE, MARKER_IMAGE_TOO_SMALL, MARKER_IMAGE_NOT_SQUARE or
            MARKER_IMAGE_FLAT.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InvalidInput(
            "MARKER_IMAGE_UNREADABLE",
            f"the marker picture {path} cannot be read: {error.strerror}",
            REMEDY,
            {"file": str(path)},
        ) from error
    return marker_image(content, named=str(path))


def marker_image(content: bytes, *, named: str) -> npt.NDArray[np.uint8]:
    """The picture of a marker as grey (h, w), out of a file's bytes.

    Raises:
        InvalidInput: as `load_marker_image`; `named` is how the file is called there.
    """
    image = _grey(content, named)
    height, width = image.shape
    context: dict[str, object] = {"file": named, "width_px": width, "height_px": height}
    if min(width, height) < SMALLEST_SIDE_PX:
        raise InvalidInput(
            "MARKER_IMAGE_TOO_SMALL",
            f"the marker picture {named} is {width}x{height} px, needed at least "
            f"{SMALLEST_SIDE_PX} px a side",
            REMEDY,
            context,
        )
    if abs(width - height) > SQUARE_TOLERANCE_RATIO * max(width, height):
        raise InvalidInput(
            "MARKER_IMAGE_NOT_SQUARE",
            f"the marker picture {named} is {width}x{height} px, its sides may differ by "
            f"{SQUARE_TOLERANCE_RATIO:.0%} at most",
            REMEDY,
            context,
        )
    contrast = int(image.max()) - int(image.min())
    if contrast < MIN_CONTRAST_GREY:
        raise InvalidInput(
            "MARKER_IMAGE_FLAT",
            f"the marker picture {named} spans {contrast} grey levels of 255, needed at least "
            f"{MIN_CONTRAST_GREY}",
            REMEDY,
            {**context, "contrast_grey": contrast},
        )
    return image


def _grey(content: bytes, named: str) -> npt.NDArray[np.uint8]:
    decoded = None
    if content:
        try:
            decoded = cv2.imdecode(np.frombuffer(content, dtype=np.uint8), cv2.IMREAD_GRAYSCALE)
        except cv2.error:
            decoded = None
    if decoded is None:
        raise InvalidInput(
            "MARKER_IMAGE_UNREADABLE",
            f"the marker picture {named} ({len(content)} bytes) is no picture that can be decoded",
            REMEDY,
            {"file": named, "bytes": len(content)},
        )
    return np.asarray(decoded, dtype=np.uint8)
