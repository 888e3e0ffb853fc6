"""Decode image files identically for calibration and tracking."""

import cv2
import numpy as np
import numpy.typing as npt

from server import MAX_IMAGE_PIXELS


def decoded(content: bytes, *, grey: bool = False) -> npt.NDArray[np.uint8] | None:
    """Decode an image as (h, w, 3) BGR or (h, w) greyscale; None if it cannot be decoded.

    The EXIF orientation is ignored, because the calibration refers to the sensor.
    """
    if is_too_large(content):
        return None
    colours = cv2.IMREAD_GRAYSCALE if grey else cv2.IMREAD_COLOR
    try:
        picture = cv2.imdecode(
            np.frombuffer(content, dtype=np.uint8), colours | cv2.IMREAD_IGNORE_ORIENTATION
        )
    except cv2.error:
        # Empty data, or larger than `MAX_IMAGE_PIXELS`.
        return None
    return None if picture is None else np.asarray(picture, dtype=np.uint8)


def is_too_large(content: bytes) -> bool:
    """Return whether a PNG states too many pixels; OpenCV applies its limit after it has allocated them."""
    if not content.startswith(b"\x89PNG\r\n\x1a\n"):
        return False
    return int.from_bytes(content[16:20], "big") * int.from_bytes(content[20:24], "big") > MAX_IMAGE_PIXELS


def png_bytes(picture: npt.NDArray[np.uint8]) -> bytes:
    """Encode an image (h, w) or (h, w, 3) BGR as PNG."""
    _, content = cv2.imencode(".png", picture)
    return content.tobytes()
