"""Decode image files identically for calibration and tracking."""

import cv2
import numpy as np
import numpy.typing as npt


def decoded(content: bytes, *, grey: bool = False) -> npt.NDArray[np.uint8] | None:
    """Decode an image as (h, w, 3) BGR or (h, w) greyscale; None if it cannot be decoded.

    The EXIF orientation is ignored, because the calibration refers to the sensor.
    """
    colours = cv2.IMREAD_GRAYSCALE if grey else cv2.IMREAD_COLOR
    try:
        picture = cv2.imdecode(
            np.frombuffer(content, dtype=np.uint8), colours | cv2.IMREAD_IGNORE_ORIENTATION
        )
    except cv2.error:
        # Empty data, or larger than the limit of OpenCV.
        return None
    return None if picture is None else np.asarray(picture, dtype=np.uint8)


def png_bytes(picture: npt.NDArray[np.uint8]) -> bytes:
    """Encode an image (h, w) or (h, w, 3) BGR as PNG."""
    _, content = cv2.imencode(".png", picture)
    return content.tobytes()
