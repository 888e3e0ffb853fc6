"""A picture out of a file, decoded as the camera made it: in one way for calibration and for tracking."""

import cv2
import numpy as np
import numpy.typing as npt


def decoded(content: bytes, *, grey: bool = False) -> npt.NDArray[np.uint8] | None:
    """The picture (h, w, 3) BGR, or (h, w) if it shall be grey, in a file's bytes; None if they are none.

    What a file says about turning it is left aside: the lens was not turned.
    """
    colours = cv2.IMREAD_GRAYSCALE if grey else cv2.IMREAD_COLOR
    try:
        picture = cv2.imdecode(
            np.frombuffer(content, dtype=np.uint8), colours | cv2.IMREAD_IGNORE_ORIENTATION
        )
    except cv2.error:
        # It is empty, or says that it is larger than OpenCV reads at all.
        return None
    return None if picture is None else np.asarray(picture, dtype=np.uint8)


def png_bytes(picture: npt.NDArray[np.uint8]) -> bytes:
    """The picture (h, w) or (h, w, 3) BGR as a PNG file."""
    _, content = cv2.imencode(".png", picture)
    return content.tobytes()
