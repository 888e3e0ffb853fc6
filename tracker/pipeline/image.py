"""The image as all stages take it: grey, of the camera's size, with its noise."""

from collections.abc import Mapping

import cv2
import numpy as np
import numpy.typing as npt

from tracker.appearance import Textures
from tracker.edges import GreyImage
from tracker.errors import InvalidInput
from tracker.pose import Pixels
from tracker.regions import noise_grey

PIXELS_FOR_NOISE = 125_000
# One pixel in so many each way tells nearly always that an image is another one.
TELLING_STRIDE = 16


def is_same_image(one: npt.NDArray[np.uint8], other: npt.NDArray[np.uint8]) -> bool:
    """Whether two images, (h, w) or (h, w, 3), are equal in each pixel; other sizes are other images."""
    few = slice(None, None, TELLING_STRIDE)
    return np.array_equal(one[few, few], other[few, few]) and np.array_equal(one, other)


class LastImage:
    """The image before, to know one that comes again: of a frozen camera, or of one slower than its card."""

    def __init__(self) -> None:
        self._grey: GreyImage | None = None

    def is_again(self, grey: GreyImage) -> bool:
        """Whether this image is the one of the last call, pixel by pixel; it is kept for the next."""
        last = self._grey
        if last is None:
            # The caller may write over its own.
            self._grey = grey.copy()
            return False
        if is_same_image(last, grey):
            return True
        np.copyto(last, grey)
        return False


def grey_of(image: npt.NDArray[np.uint8], *, size_wh_px: tuple[int, int]) -> GreyImage:
    """The grey image (h, w) of one that is grey (h, w) or BGR (h, w, 3).

    Raises:
        InvalidInput: IMAGE_INVALID, or IMAGE_SIZE_DIFFERS from the camera's.
    """
    if not isinstance(image, np.ndarray):
        # What `cv2.imread` gives of a file that is not there.
        raise InvalidInput(
            "IMAGE_INVALID",
            f"an image is {type(image).__name__}, needed an array uint8 (h, w) or (h, w, 3)",
            "Look whether the file that it was read from is there.",
        )
    if image.dtype != np.uint8 or not (image.ndim == 2 or (image.ndim == 3 and image.shape[2] == 3)):
        raise InvalidInput(
            "IMAGE_INVALID",
            f"an image is {image.dtype} of shape {image.shape}, needed uint8 (h, w) or (h, w, 3)",
            "Give grey or BGR images with 8 bits.",
        )
    height, width = image.shape[:2]
    if (width, height) != size_wh_px:
        raise InvalidInput(
            "IMAGE_SIZE_DIFFERS",
            f"the image is {width}x{height} px, the camera was calibrated at "
            f"{size_wh_px[0]}x{size_wh_px[1]} px",
            "Set the camera to the size it was calibrated at, or calibrate it at this size.",
            {"width_px": width, "height_px": height, "calibrated_wh_px": list(size_wh_px)},
        )
    grey = np.ascontiguousarray(image) if image.ndim == 2 else cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
    return np.asarray(grey, dtype=np.uint8)


def pixels_of(grey: GreyImage, textures: Mapping[str, Textures]) -> Pixels:
    """The same with the sd of its noise, and with the pictures of the markers by name."""
    # Noise is alike everywhere: some rows tell it.
    every = max(grey.size // PIXELS_FOR_NOISE, 1)
    return Pixels(image=grey, noise_grey=noise_grey(grey, every=every), textures=textures)
