"""A synthetic image to warm up the compiled kernels before the first image.

The first tracker of a process searches it. Compiled kernels are loaded from disk at their first call, and the
first real image would take twenty times as long as the next. The warm-up takes a fifth of a second.
"""

from dataclasses import dataclass

import cv2
import numpy as np

from tracker.edges import GreyImage
from tracker.geometry import Array

PAPER_GREY, INK_GREY = 200, 20
SPECKS_APART_PX = 16


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
