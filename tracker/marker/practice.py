"""A picture to try all loops on, before the first image comes."""

import cv2
import numpy as np

from tracker.edges import GreyImage

PAPER_GREY, INK_GREY = 200, 20
SPECKS_APART_PX = 16


def practice_image(square: GreyImage, *, size_wh_px: tuple[int, int]) -> GreyImage:
    """A marker (n, n) a quarter of the picture (h, w) wide, among dark squares for every round."""
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
    return image
