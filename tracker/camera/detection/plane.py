"""The map from a flat board into its image, without a lens."""

from typing import cast

import cv2
import numpy as np

from tracker.geometry import Array


def plane_map(board: Array, px: Array, *, is_robust: bool) -> Array | None:
    """The homography (3, 3) from board points (n, 2) to px (n, 2), or None where there is none.

    A robust one is told by the better half of the points.
    """
    method = cv2.LMEDS if is_robust else 0
    # OpenCV gives None for nothing, whatever its types say.
    found = cast("object", cv2.findHomography(board, px, method)[0])
    return None if found is None else np.asarray(found, dtype=np.float64)


def off_plane_px(board: Array, px: Array, *, is_robust: bool) -> Array | None:
    """How far (n, 2) points lie from where that map puts them, or None where there is none."""
    found = plane_map(board, px, is_robust=is_robust)
    if found is None:
        return None
    expected = cv2.perspectiveTransform(board.reshape(-1, 1, 2), found)
    return px - np.asarray(expected, dtype=np.float64).reshape(-1, 2)
