"""Pixel formats of industrial cameras, by their names in GenICam's Pixel Format Naming Convention (PFNC)."""

from collections.abc import Sequence

import cv2
import numpy as np
import numpy.typing as npt

# Best first: raw Bayer needs a third of the bandwidth of colour converted in the camera. OpenCV names a
# mosaic by its second row, PFNC by its first.
CONVERSIONS = {
    "BayerRG8": cv2.COLOR_BayerRGGB2BGR,
    "BayerGR8": cv2.COLOR_BayerGRBG2BGR,
    "BayerGB8": cv2.COLOR_BayerGBRG2BGR,
    "BayerBG8": cv2.COLOR_BayerBGGR2BGR,
    "BGR8": None,
    "RGB8": cv2.COLOR_RGB2BGR,
    "BGRa8": cv2.COLOR_BGRA2BGR,
    "RGBa8": cv2.COLOR_RGBA2BGR,
    "Mono8": cv2.COLOR_GRAY2BGR,
}


def is_decoded(name: str) -> bool:
    """Return whether images of this format can be decoded."""
    return _canonical(name) in CONVERSIONS


def best_format(offered: Sequence[str]) -> str | None:
    """Return the best of the offered formats; None where none can be decoded."""
    readable = [name for name in offered if is_decoded(name)]
    order = list(CONVERSIONS)
    return min(readable, key=lambda name: order.index(_canonical(name)), default=None)


def bgr_from_pixels(pixels: npt.NDArray[np.uint8], name: str) -> npt.NDArray[np.uint8] | None:
    """Return the image as (h, w, 3) BGR; None for an unsupported format."""
    canonical = _canonical(name)
    if canonical not in CONVERSIONS:
        return None
    conversion = CONVERSIONS[canonical]
    return pixels if conversion is None else np.asarray(cv2.cvtColor(pixels, conversion), dtype=np.uint8)


def _canonical(name: str) -> str:
    """Return the PFNC name of an older name: "RGB8Packed", "BGRA8Packed"."""
    return name.removesuffix("Packed").replace("BGRA8", "BGRa8").replace("RGBA8", "RGBa8")
