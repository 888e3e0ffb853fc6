"""Square candidates in an image: every quadrilateral outline that a square-marker detector has to test.

They are selected for high recall, whereas the tracker's search stops once it has found its marker.
"""

import cv2
import numpy as np

from tracker.edges import GreyImage, chains_of, edgels_of, gradient_of, joined_segments, segments_of
from tracker.geometry import Array
from tracker.quads import Quads, corner_quads_of

# A third of the side of the smallest marker that is found.
MIN_PIECE_PX = 4.0
MIN_STEP_GREY = 5.0


def outlines_of(image: GreyImage) -> Array:
    """Return quadrilaterals (n, 4, 2) in px, corners clockwise on the screen, of a grey image (h, w).

    Also runs at half resolution, where an edge that is blurred over four pixels is sharp.
    """
    half = np.asarray(cv2.resize(image, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA), dtype=np.uint8)
    coarse = _outlines(half).astype(np.float64) * 2.0 + 0.5
    return np.concatenate([_outlines(image).astype(np.float64), coarse])


def _outlines(image: GreyImage) -> Quads:
    edgels = edgels_of(gradient_of(image))
    pieces = segments_of(edgels, chains_of(edgels), min_length_px=MIN_PIECE_PX)
    return corner_quads_of(
        image, np.concatenate([pieces, joined_segments(pieces)]), min_step_grey=MIN_STEP_GREY
    )
