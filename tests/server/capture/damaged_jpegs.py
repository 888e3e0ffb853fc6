"""A JPEG with texture everywhere, and what a transfer makes of it."""

import cv2
import numpy as np

_COARSE = np.random.default_rng(0).integers(0, 256, (30, 40, 3), dtype=np.uint8)
PICTURE = cv2.resize(_COARSE, (640, 480), interpolation=cv2.INTER_CUBIC)


def jpeg_of(*options: int) -> bytes:
    """Encode the picture with these options of OpenCV."""
    return cv2.imencode(".jpg", PICTURE, options)[1].tobytes()


JPEG = jpeg_of()
# A lost packet of USB; OpenCV decodes it.
WITH_GAP = JPEG[:9000] + JPEG[9512:]
