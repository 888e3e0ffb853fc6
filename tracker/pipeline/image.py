"""Input of all stages: a grey image of the camera's size, with its noise.

The first tracker of a process searches a synthetic image. Compiled kernels are loaded from disk at their
first call, and the first real image would take twenty times as long as the next. This warm-up takes a fifth
of a second.
"""

from collections.abc import Mapping
from dataclasses import dataclass

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
PAPER_GREY, INK_GREY = 200, 20
SPECKS_APART_PX = 16


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


@dataclass(frozen=True, slots=True, kw_only=True)
class WarmUpImage:
    """An image of a marker among dark specks, which triggers every round of a search.

    Attributes:
        image: (h, w).
        corners_px: (4, 2), top-left, top-right, bottom-right, bottom-left of the marker.
        side_px: side of the marker, a quarter of the image.
    """

    image: GreyImage
    corners_px: Array
    side_px: int


def warm_up_image(square: GreyImage, *, size_wh_px: tuple[int, int]) -> WarmUpImage:
    """Return the warm-up image of this size for a marker's grey square (n, n)."""
    width, height = size_wh_px
    side = max(min(width, height) // 4, 2)
    margin = side // 4
    image = np.full((height, width), PAPER_GREY, np.uint8)
    half = SPECKS_APART_PX // 2
    for row in range(half):
        for column in range(half):
            image[row::SPECKS_APART_PX, column::SPECKS_APART_PX] = INK_GREY
    left, top = (width - side) // 2, (height - side) // 2
    image[top - margin : top + side + margin, left - margin : left + side + margin] = PAPER_GREY
    seen = cv2.resize(square, (side, side), interpolation=cv2.INTER_AREA)
    image[top : top + side, left : left + side] = np.minimum(seen, PAPER_GREY)
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]) * side
    return WarmUpImage(image=image, corners_px=corners + np.array([left - 0.5, top - 0.5]), side_px=side)
