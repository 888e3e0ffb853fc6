"""Dark regions of an image, their quads and the straight segments of their borders."""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage, straight_pieces
from tracker.regions.region_kernels import (
    find_runs,
    median_difference,
    region_quads,
    regions_of,
    trace_borders,
)

Int32 = npt.NDArray[np.int32]

# Minimum side and foreshortening of a square: at 70 degrees of tilt it is a third as high as wide.
MIN_SIDE_PX = 5.0
MIN_EXTENT_PX = 9
MIN_SQUASH_RATIO = 0.3
# Length limits of the followed borders: shorter ones are specks, longer ones texture.
MIN_BORDER_PX, MAX_BORDER_PX = 24, 20_000
# The border of a straight edge deviates by half a pixel from the line, and more with noise.
BORDER_OFF_PX, MIN_PIECE_PX = 1.2, 6.0
SAMPLE_STRIDE = 5
MIN_LIGHT_GREY = 8.0
# The median absolute difference of two pixels is 0.954 times the sd of Gaussian noise.
NOISE_PER_DIFFERENCE = 1.0 / 0.954


@dataclass(frozen=True, slots=True, kw_only=True)
class Regions:
    """Dark regions of an image, as runs of pixels in its rows.

    Attributes:
        mask: (h, w), 255 inside, else 0.
        row, first, last: (n,), row, first and last column of each run.
        parent: (n,), first run of the region of each run.
    """

    mask: npt.NDArray[np.uint8]
    row: Int32
    first: Int32
    last: Int32
    parent: Int32


def noise_grey(image: GreyImage, *, every: int = 1) -> float:
    """Estimate the sd of the image noise in grey levels from neighbouring pixels on a sparse grid."""
    return float(NOISE_PER_DIFFERENCE * median_difference(image, every * SAMPLE_STRIDE, SAMPLE_STRIDE))


def dark_mask(image: GreyImage, *, window_px: int, darker_grey: float) -> npt.NDArray[np.uint8]:
    """Return the mask (h, w, 0 or 255) of pixels darker by `darker_grey` than the local mean.

    `darker_grey` is at least 1.
    """
    # cv2.adaptiveThreshold uses a lookup table per pixel; these steps take two thirds of its time.
    mean = cv2.blur(image, (window_px, window_px), borderType=cv2.BORDER_REPLICATE)
    darker = cv2.subtract(mean, image)
    _, mask = cv2.threshold(darker, np.floor(darker_grey) - 1.0, 255, cv2.THRESH_BINARY)
    return np.asarray(mask, dtype=np.uint8)


def normalise_illumination(image: GreyImage, *, window_px: int, noise_grey: float) -> GreyImage:
    """Divide the image (h, w) by its local mean: 128 where it equals the mean of the window."""
    # The offset prevents the amplification of noise in dark areas.
    floor = max(3.0 * noise_grey, MIN_LIGHT_GREY)
    around = cv2.convertScaleAbs(cv2.blur(image, (window_px, window_px)), beta=floor)
    own = cv2.convertScaleAbs(image, beta=floor)
    return np.asarray(cv2.divide(own, around, scale=128.0), dtype=np.uint8)


def regions_of_mask(mask: npt.NDArray[np.uint8]) -> Regions:
    """Label the 8-connected regions of a mask (h, w, 0 or 255)."""
    row, first, last, parent = find_runs(mask)
    return Regions(mask=mask, row=row, first=first, last=last, parent=parent)


def quads_of(regions: Regions) -> npt.NDArray[np.float32]:
    """Fit quads (q, 4, 2) in px to regions, corners clockwise on the screen."""
    height, width = regions.mask.shape
    row, first, last = regions.row, regions.first, regions.last
    box, head, after = regions_of(
        row, first, last, regions.parent, np.array([width, height]), MIN_EXTENT_PX, max(height, width)
    )
    quads = region_quads(row, first, last, after, box, head, MIN_SIDE_PX, MIN_SQUASH_RATIO)
    return np.asarray(quads, dtype=np.float32)


def border_segments(regions: Regions) -> npt.NDArray[np.float32]:
    """Return straight segments (s, 4) of the region borders, px: from x, y to x, y, dark on the right.

    Border segments also exist where edges are too faint or too blurred to be linked into chains.
    """
    x, y, starts = trace_borders(regions.mask, regions.row, regions.first, MIN_BORDER_PX, MAX_BORDER_PX)
    return straight_pieces(x, y, starts, off_px=BORDER_OFF_PX, min_length_px=MIN_PIECE_PX)
