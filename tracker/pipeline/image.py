"""Input of all stages: a grey image of the camera's size, with its noise."""

from collections.abc import Mapping

import cv2
import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage
from tracker.errors import InvalidInput
from tracker.geometry import Array
from tracker.photometric import Textures
from tracker.pose import ImageContext
from tracker.regions import noise_grey

PIXELS_FOR_NOISE = 125_000
# A subsample with this stride nearly always differs between two images, and is compared first.
COMPARISON_STRIDE = 16
# Margin around a marker that contains all pixels its pose depends on, in sides.
PATCH_MARGIN_RATIO = 0.2


def is_same_image(one: npt.NDArray[np.uint8], other: npt.NDArray[np.uint8]) -> bool:
    """Return whether two images, (h, w) or (h, w, 3), have equal size and pixels."""
    few = slice(None, None, COMPARISON_STRIDE)
    return np.array_equal(one[few, few], other[few, few]) and np.array_equal(one, other)


class RepeatedPatch:
    """Detects that the pixels around a marker repeat those of its last sighting.

    They repeat with a frozen camera, also if its time stamps advance, and with a camera slower than its card.
    """

    def __init__(self) -> None:
        self._at: tuple[slice, slice] | None = None
        self._grey: GreyImage | None = None

    def is_repeated(self, grey: GreyImage) -> bool:
        """Return whether the stored pixels equal those at the same position of this image."""
        return self._at is not None and self._grey is not None and np.array_equal(grey[self._at], self._grey)

    def store(self, grey: GreyImage, corners_px: Array) -> None:
        """Store the pixels of this image around a marker with these corners (4, 2)."""
        low, high = corners_px.min(axis=0), corners_px.max(axis=0)
        margin = PATCH_MARGIN_RATIO * (high - low).max()
        left, top = np.maximum(np.floor(low - margin), 0).astype(int)
        right, bottom = np.maximum(np.ceil(high + margin), 1).astype(int)
        self._at = (slice(top, bottom), slice(left, right))
        # Copy, because the caller may reuse its buffer.
        self._grey = grey[self._at].copy()


def grey_of(image: npt.NDArray[np.uint8], *, size_wh_px: tuple[int, int]) -> GreyImage:
    """Convert an image, grey (h, w) or BGR (h, w, 3), to grey (h, w).

    Raises:
        InvalidInput: IMAGE_INVALID, or IMAGE_SIZE_DIFFERS from the camera's.
    """
    if not isinstance(image, np.ndarray):
        # `cv2.imread` returns None for a missing file.
        raise InvalidInput(
            "IMAGE_INVALID",
            f"an image is {type(image).__name__}, needed an array uint8 (h, w) or (h, w, 3)",
            "Check that the image file exists.",
            {"given": type(image).__name__},
        )
    if image.dtype != np.uint8 or not (image.ndim == 2 or (image.ndim == 3 and image.shape[2] == 3)):
        raise InvalidInput(
            "IMAGE_INVALID",
            f"an image is {image.dtype} of shape {image.shape}, needed uint8 (h, w) or (h, w, 3)",
            "Give grey or BGR images with 8 bits.",
            {"shape": str(image.shape), "dtype": str(image.dtype)},
        )
    height, width = image.shape[:2]
    if (width, height) != size_wh_px:
        raise InvalidInput(
            "IMAGE_SIZE_DIFFERS",
            f"the image is {width}x{height} px, the camera was calibrated at "
            f"{size_wh_px[0]}x{size_wh_px[1]} px",
            "Set the camera to the size it was calibrated at, or calibrate it at this size.",
            {
                "width_px": width,
                "height_px": height,
                "calibrated_wh_px": list(size_wh_px),
                "calibrated_width_px": size_wh_px[0],
                "calibrated_height_px": size_wh_px[1],
            },
        )
    grey = np.ascontiguousarray(image) if image.ndim == 2 else cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
    return np.asarray(grey, dtype=np.uint8)


def image_context_of(grey: GreyImage, textures: Mapping[str, Textures]) -> ImageContext:
    """Return the image with its noise (sd) and the marker textures by name."""
    # Noise is uniform over the image, so some rows suffice to estimate it.
    every = max(grey.size // PIXELS_FOR_NOISE, 1)
    return ImageContext(image=grey, noise_grey=noise_grey(grey, every=every), textures=textures)
