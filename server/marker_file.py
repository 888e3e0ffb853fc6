"""Read and validate the image of a marker."""

from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt

from server.image_file import is_too_large
from tracker.errors import InvalidInput

SMALLEST_SIDE_PX = 8
SQUARE_TOLERANCE_RATIO = 0.02
MIN_CONTRAST_GREY = 32
REMEDY = (
    "Give a PNG, JPEG or BMP image that the black square of the marker fills edge to edge, row 0 at the top."
)


def load_marker_image(path: Path) -> npt.NDArray[np.uint8]:
    """Read a marker image as greyscale (h, w).

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
            {"file": str(path), "system_error": error.strerror},
        ) from error
    return marker_image(content, named=str(path))


def marker_image(content: bytes, *, named: str) -> npt.NDArray[np.uint8]:
    """Decode a marker image as greyscale (h, w).

    Raises:
        InvalidInput: as `load_marker_image`; `named` is the file name in messages.
    """
    image = _grey(content, named)
    height, width = image.shape
    context: dict[str, object] = {"file": named, "width_px": width, "height_px": height}
    if min(width, height) < SMALLEST_SIDE_PX:
        raise InvalidInput(
            "MARKER_IMAGE_TOO_SMALL",
            f"the marker picture {named} is {width}x{height} px, the minimum is "
            f"{SMALLEST_SIDE_PX} px per side",
            REMEDY,
            {**context, "min_px": SMALLEST_SIDE_PX},
        )
    if abs(width - height) > SQUARE_TOLERANCE_RATIO * max(width, height):
        raise InvalidInput(
            "MARKER_IMAGE_NOT_SQUARE",
            f"the marker picture {named} is {width}x{height} px, its sides may differ by "
            f"at most {SQUARE_TOLERANCE_RATIO:.0%}",
            REMEDY,
            {**context, "tolerance_ratio": SQUARE_TOLERANCE_RATIO},
        )
    contrast = int(image.max()) - int(image.min())
    if contrast < MIN_CONTRAST_GREY:
        raise InvalidInput(
            "MARKER_IMAGE_FLAT",
            f"the marker picture {named} spans {contrast} of 255 grey levels, the minimum is "
            f"{MIN_CONTRAST_GREY}",
            REMEDY,
            {**context, "contrast_grey": contrast, "min_contrast_grey": MIN_CONTRAST_GREY},
        )
    return image


def _grey(content: bytes, named: str) -> npt.NDArray[np.uint8]:
    decoded = None
    if content and not is_too_large(content):
        try:
            decoded = cv2.imdecode(np.frombuffer(content, dtype=np.uint8), cv2.IMREAD_GRAYSCALE)
        except cv2.error:
            decoded = None
    if decoded is None:
        raise InvalidInput(
            "MARKER_IMAGE_UNREADABLE",
            f"the marker picture {named} ({len(content)} bytes) cannot be decoded",
            REMEDY,
            {"file": named, "bytes": len(content)},
        )
    return np.asarray(decoded, dtype=np.uint8)
