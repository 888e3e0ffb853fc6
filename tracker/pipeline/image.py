"""The image as all stages take it: grey, of the camera's size, with its noise."""

from collections.abc import Mapping

import cv2
import numpy as np
import numpy.typing as npt

from tracker.appearance import Textures
from tracker.edges import GreyImage
from tracker.errors import InvalidInput
from tracker.geometry import Array
from tracker.pose import Pixels
from tracker.regions import noise_grey

PIXELS_FOR_NOISE = 125_000
# One pixel in so many each way tells nearly always that an image is another one.
TELLING_STRIDE = 16
# Of the paper around a marker: all that its pose is told by.
PATCH_MARGIN_RATIO = 0.2


def is_same_image(one: npt.NDArray[np.uint8], other: npt.NDArray[np.uint8]) -> bool:
    """Whether two images, (h, w) or (h, w, 3), are equal in each pixel; other sizes are other images."""
    few = slice(None, None, TELLING_STRIDE)
    return np.array_equal(one[few, few], other[few, few]) and np.array_equal(one, other)


class Patch:
    """The pixels around a marker when it was last seen, to know them when they come again.

    So they do from a frozen camera, also under a clock that goes on, and from one slower than its card.
    """

    def __init__(self) -> None:
        self._at: tuple[slice, slice] | None = None
        self._grey: GreyImage | None = None

    def is_again(self, grey: GreyImage) -> bool:
        """Whether these pixels are all in this image, where they were."""
        return self._at is not None and self._grey is not None and np.array_equal(grey[self._at], self._grey)

    def keep(self, grey: GreyImage, corners_px: Array) -> None:
        """Those of this image, around a marker with these corners (4, 2)."""
        low, high = corners_px.min(axis=0), corners_px.max(axis=0)
        margin = PATCH_MARGIN_RATIO * (high - low).max()
        left, top = np.maximum(np.floor(low - margin), 0).astype(int)
        right, bottom = np.maximum(np.ceil(high + margin), 1).astype(int)
        self._at = (slice(top, bottom), slice(left, right))
        # The caller may write over its own.
        self._grey = grey[self._at].copy()


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
