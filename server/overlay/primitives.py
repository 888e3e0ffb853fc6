"""Lines with a dark halo and text on a dark background, legible on bone, blood and white drapes."""

import threading
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

Image: TypeAlias = npt.NDArray[np.uint8]
Colour: TypeAlias = tuple[int, int, int]

# BGR. Blue and orange are distinguishable with every kind of colour blindness; their shapes differ as well.
PLAN_BLUE: Colour = (245, 185, 80)
PLACED_GREY: Colour = (212, 200, 190)
DRILL_ORANGE: Colour = (20, 150, 255)
WHITE: Colour = (255, 255, 255)
QUIET: Colour = (205, 205, 205)
HALO: Colour = (20, 16, 12)
# Text and shapes repeat the meaning for red-green colour blindness.
GREEN: Colour = (176, 224, 111)
YELLOW: Colour = (77, 216, 255)
RED: Colour = (110, 110, 255)

SUBPIXEL_BITS = 4
FARTHEST_PX = 20_000.0
SEMIBOLD = 600
REGULAR = 450

LEFT = cv2.PUT_TEXT_ALIGN_LEFT
NEVER_WRAPPED = (0, 1 << 15)

_fonts = threading.local()


@dataclass(frozen=True, slots=True, kw_only=True)
class Box:
    """Upper and right edge of a drawn rectangle that must not be covered."""

    top_px: float
    right_px: float


def stroke(image: Image, runs: Sequence[Array], colour: Colour, *, width_px: float) -> None:
    """Draw polylines (m, 2) in px over their halo; polylines that are not finite are skipped."""
    drawn = [run for run in runs if len(run) > 1]
    if not drawn:
        return
    # In one call, because the overhead per call dominates.
    points = np.concatenate(drawn)
    fixed = np.split(_fixed_point(points), np.cumsum([len(run) for run in drawn])[:-1])
    if not np.isfinite(points).all():
        fixed = [part for part, run in zip(fixed, drawn, strict=True) if np.isfinite(run).all()]
        if not fixed:
            return
    # A line of one pixel would be hidden by its halo.
    width = max(2, round(width_px))
    for ink, thickness in ((HALO, width + 2 * max(1, round(width_px * 0.5))), (colour, width)):
        cv2.polylines(image, fixed, False, ink, thickness, cv2.LINE_AA, SUBPIXEL_BITS)


def dot(image: Image, at_px: Array, colour: Colour, *, radius_px: float) -> None:
    """Draw a filled dot with its halo."""
    if not np.isfinite(at_px).all():
        return
    u, v = (int(value) for value in _fixed_point(at_px.reshape(1, 2)).ravel())
    for ink, radius in ((HALO, radius_px * 1.45), (colour, radius_px)):
        fixed_radius = round(radius * (1 << SUBPIXEL_BITS))
        cv2.circle(image, (u, v), fixed_radius, ink, -1, cv2.LINE_AA, SUBPIXEL_BITS)


def darken_box(image: Image, left: float, top: float, right: float, bottom: float) -> None:
    """Darken a box of the image, so that text on it is legible on any background."""
    height, width = image.shape[:2]
    x0, x1 = (min(max(round(x), 0), width) for x in (left, right))
    y0, y1 = (min(max(round(y), 0), height) for y in (top, bottom))
    if x1 > x0 and y1 > y0:
        box = image[y0:y1, x0:x1]
        cv2.convertScaleAbs(box, dst=box, alpha=0.22, beta=10.0)


def text(
    image: Image, words: str, at_px: tuple[float, float], colour: Colour, *, size_px: float, weight: int
) -> float:
    """Draw text with the left end of its baseline at (u, v); return the u of its right end."""
    u, v = round(at_px[0]), round(at_px[1])
    size = max(6, round(size_px))
    end, drawn = cv2.putText(image, words, (u, v), colour, _font(), size, weight, LEFT, NEVER_WRAPPED)
    if drawn is not image:
        image[...] = drawn
    return float(end[0])


def text_width_px(words: str, *, size_px: float, weight: int) -> float:
    """Return the width of a text."""
    size = max(6, round(size_px))
    box = cv2.getTextSize((0, 0), words, (0, 0), _font(), size, weight, LEFT, NEVER_WRAPPED)
    return float(box[2])


def _font() -> "cv2.FontFace":
    # One font per thread, because drawing in another weight modifies the font object.
    font: cv2.FontFace | None = getattr(_fonts, "sans", None)
    if font is None:
        font = _fonts.sans = cv2.FontFace("sans")
    return font


def _fixed_point(run: Array) -> npt.NDArray[np.int32]:
    """Return OpenCV's fixed-point coordinates for sub-pixel drawing, clamped to its range."""
    bounded = np.nan_to_num(np.clip(run, -FARTHEST_PX, FARTHEST_PX), copy=False)
    return np.round(bounded * (1 << SUBPIXEL_BITS)).astype(np.int32).reshape(-1, 1, 2)
