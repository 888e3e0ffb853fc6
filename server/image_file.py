"""Decode images identically for calibration and tracking.

A JPEG with a gap decodes to shifted blocks. libjpeg notices that and only warns, which OpenCV does not pass
on; `decode_jpeg` rejects the image. Of 207 images of a tracked marker with a gap of 512 bytes all are
rejected, and in 72 of them OpenCV's image has the tip elsewhere. A flipped bit often changes the brightness
alone, and is not noticed: of 182 such images one had the tip off by 2.0 mm, and the others by less
(`python -m tests.benchmarks.damaged_images --images 69`).
"""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt
import simplejpeg

from server import MAX_IMAGE_PIXELS

JPEG_START = b"\xff\xd8\xff"
START_OF_SCAN = b"\xff\xda"


@dataclass(frozen=True, slots=True, kw_only=True)
class DamagedJpeg:
    """A JPEG that is not used.

    Attributes:
        reason: The decoder's words.
    """

    reason: str


def decode_jpeg(
    content: bytes | npt.NDArray[np.uint8], *, grey: bool = False
) -> npt.NDArray[np.uint8] | DamagedJpeg:
    """Decode a JPEG as (h, w, 3) BGR or (h, w) greyscale; with the first warning it counts as damaged.

    The pixels are those of `cv2.imdecode`. Bytes after the end of the image are ignored, and missing Huffman
    tables are the standard ones, because USB cameras pad their images and omit the tables.
    """
    # OpenCV's packets have two dimensions.
    packet = np.frombuffer(content, dtype=np.uint8)
    image = _decoded_strictly(packet, grey=grey)
    if isinstance(image, DamagedJpeg) and "SOS parameters" in image.reason:
        image = _decoded_strictly(_with_valid_scan_header(packet.tobytes()), grey=grey)
    return image


def _decoded_strictly(
    packet: bytes | npt.NDArray[np.uint8], *, grey: bool
) -> npt.NDArray[np.uint8] | DamagedJpeg:
    try:
        height, width = (int(size) for size in simplejpeg.decode_jpeg_header(packet)[:2])
        if height * width > MAX_IMAGE_PIXELS:
            return DamagedJpeg(reason=f"{width}x{height} px, allowed {MAX_IMAGE_PIXELS} px")
        image = simplejpeg.decode_jpeg(packet, "GRAY" if grey else "BGR")
    except KeyError:
        # simplejpeg has no name for 4:4:1, which damaged headers state.
        return DamagedJpeg(reason="unknown chroma subsampling")
    except ValueError as error:
        return DamagedJpeg(reason=str(error))
    return image[:, :, 0] if grey else image


def _with_valid_scan_header(jpeg: bytes) -> bytes:
    """Return a sequential JPEG with the only scan parameters that it may have.

    Some network cameras and front cameras of phones write zeros there. libjpeg ignores them with a warning,
    and further warnings are not reported.
    """
    # The last marker of this kind, because a thumbnail before it has one, too.
    at = jpeg.rfind(START_OF_SCAN) + len(START_OF_SCAN)
    end = at + int.from_bytes(jpeg[at : at + 2], "big")
    return jpeg[: end - 3] + b"\x00\x3f\x00" + jpeg[end:]


def decoded(content: bytes, *, grey: bool = False) -> npt.NDArray[np.uint8] | None:
    """Decode an image as (h, w, 3) BGR or (h, w) greyscale; None if it is damaged or cannot be decoded.

    The EXIF orientation is ignored, because the calibration refers to the sensor.
    """
    if content.startswith(JPEG_START):
        image = decode_jpeg(content, grey=grey)
        return None if isinstance(image, DamagedJpeg) else image
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
