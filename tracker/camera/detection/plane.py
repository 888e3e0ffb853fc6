"""Homography from a flat board to its image."""

from typing import cast

import cv2
import numpy as np

from tracker.geometry import Array


def plane_map(board: Array, px: Array, *, is_robust: bool) -> Array | None:
    """Return the homography (3, 3) from board points (n, 2) to px (n, 2), or None.

    With `is_robust`, least median of squares.
    """
    method = cv2.LMEDS if is_robust else 0
    # OpenCV returns None for no result, contrary to its type annotations.
    found = cast("object", cv2.findHomography(board, px, method)[0])
    return None if found is None else np.asarray(found, dtype=np.float64)


def off_plane_px(board: Array, px: Array, *, is_robust: bool) -> Array | None:
    """Return the residuals (n, 2) of the homography, or None where there is none."""
    found = plane_map(board, px, is_robust=is_robust)
    if found is None:
        return None
    expected = cv2.perspectiveTransform(board.reshape(-1, 1, 2), found)
    return px - np.asarray(expected, dtype=np.float64).reshape(-1, 2)
