"""A printed marker as polygons, painted one over the other on a black square."""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage
from tracker.geometry import Array

SHIFT_BITS = 6
# Subsamples per pixel and axis.
SUPERSAMPLING = 4
# Polygon approximation tolerance by the side; areas below the second are specks where two polygons cross.
STRAIGHT_RATIO, MIN_AREA_RATIO = 0.015, 0.002


@dataclass(frozen=True, slots=True, kw_only=True)
class Patch:
    """One painted polygon.

    Attributes:
        corners: (n, 2) in sides of the square, x right and y down from its top-left corner.
        white: white paper, else black ink.
    """

    corners: Array
    white: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Shape:
    """A black square of side 1 with polygons painted on it in this order."""

    patches: tuple[Patch, ...]


def rendered_face(shape: Shape, side_px: int) -> GreyImage:
    """Return the printed face (side_px, side_px), black 0 and white 255, antialiased; no white margin."""
    fine = rasterised(shape, side_px * SUPERSAMPLING)
    return np.asarray(cv2.resize(fine, (side_px, side_px), interpolation=cv2.INTER_AREA), dtype=np.uint8)


def rasterised(shape: Shape, side_px: int) -> npt.NDArray[np.uint8]:
    """Return the face (side_px, side_px) without antialiasing: each pixel is 0 or 255."""
    image = np.zeros((side_px, side_px), dtype=np.uint8)
    for patch in shape.patches:
        # The square's edge lies half a pixel outside the centre of the first pixel.
        at = np.rint((patch.corners * side_px - 0.5) * 2**SHIFT_BITS).astype(np.int32)
        cv2.fillPoly(image, [at], 255 if patch.white else 0, lineType=cv2.LINE_8, shift=SHIFT_BITS)
    return image


def vectorised(image: npt.NDArray[np.uint8]) -> Shape:
    """Return the polygons of a picture (n, n) of 0 and 255; they do not overlap, small specks are dropped."""
    side = image.shape[0]
    outlines, tree = cv2.findContours(image, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    patches: list[Patch] = []
    for outline, (_, _, _, parent) in zip(outlines, tree[0] if outlines else (), strict=True):
        corners = cv2.approxPolyDP(outline, STRAIGHT_RATIO * side, closed=True)[:, 0].astype(np.float64)
        if len(corners) >= 3 and cv2.contourArea(outline) >= MIN_AREA_RATIO * side**2:
            patches.append(Patch(corners=(corners + 0.5) / side, white=parent < 0))
    # Holes after the bodies that they are in.
    return Shape(patches=tuple(sorted(patches, key=lambda patch: not patch.white)))
