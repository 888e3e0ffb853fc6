"""Parts of a square that are not the model's: over its border they cover it, within it they contradict."""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.marker.explanation.cover.kernels import grown, weights_of_a_part, wrong_pieces
from tracker.marker.explanation.fields.kernels import FIELDS, RING

Mask = npt.NDArray[np.bool_]
HIDDEN_CONTRAST, CLEAR_CONTRAST = 0.35, 0.2
MIN_PIECE = 3
# Under this part of the square, a piece is a speck (dirt, a highlight) and not another shape.
MIN_AREA_RATIO = MIN_PIECE / FIELDS**2 - 1e-9
# What is left of a cover beside it: its rim in other light.
MAX_RIM = 10
WIDE_BLUR_FIELDS = 0.6
MAX_CLEAR_RATIO = 0.1
SAME_COVER_CONTRAST, MAX_SLOPE = 0.35, 0.12
# Of what covers a part inside, the strip of paper that is looked at shows at least this much.
MIN_END_RATIO = 0.3
# Light is nowhere under this part of the brightest: a field that is dark is ink, not night.
MIN_GAIN_RATIO = 0.08
# A part lies on one side of a line: so many directions, and places in half sides.
PART_ANGLES, PART_PLACES = 12, np.array([0.0, 0.35, 0.7])
PART_CONTRAST = 0.25


@dataclass(frozen=True, slots=True, kw_only=True)
class Left:
    """Fields (n, n) of a square and its paper, when the model has been fitted to them.

    Attributes:
        seen: in grey levels.
        picture: the model, dark 0 to bright 1.
        rest: what is seen less what is explained, in grey levels.
        gain: the contrast, in grey levels.
    """

    seen: Array
    picture: npt.NDArray[np.float32]
    rest: Array
    gain: Array


def weights_beside_a_cover(seen: Array, picture: npt.NDArray[np.float32]) -> Array | None:
    """Weights of the fields by even light of the part that is not covered; None if none need be."""
    weight = np.empty(seen.shape)
    found = weights_of_a_part(seen, picture, PART_ANGLES, PART_PLACES, PART_CONTRAST, weight)
    return weight if found else None


def covered(left: Left, *, blur_fields: float) -> tuple[Mask, int]:
    """What lies over the square from outside, and the area of the largest other contradicting piece.

    `blur_fields` is the sd of the image's blur: so far the edge of a cover reaches beyond it.
    """
    night = MIN_GAIN_RATIO * float(left.gain.max())
    contrast = np.maximum(left.gain, night)
    labels = np.empty(left.seen.shape, np.int64)
    areas = wrong_pieces(left.rest, contrast, RING, HIDDEN_CONTRAST, MIN_PIECE, labels)
    hidden = (left.gain <= night) | (labels == -1)
    inside = 0
    covers = hidden.copy() if len(areas) else hidden
    beside = grown(grown(covers)) if len(areas) else covers
    for number, area in enumerate(areas, start=1):
        piece = labels == number
        is_rim = int(area) <= MAX_RIM and bool((piece & beside).any())
        if is_rim or _goes_on(piece, covers, left, contrast):
            hidden |= piece
        else:
            inside = max(inside, int(area))
    out = grown(hidden)
    return (grown(out) if blur_fields > WIDE_BLUR_FIELDS else out), inside


def _goes_on(piece: Mask, covers: Mask, left: Left, contrast: Array) -> bool:
    """Whether a piece inside goes on, unseen for being as dark as the ink, to what covers the outside.

    It does where one hull over both has nothing clear of the model in it, the outline least of all: in mere
    shadow the outline is faint and there.
    """
    seen = left.seen
    count, labels = cv2.connectedComponents(covers.astype(np.uint8), connectivity=8)
    grey = float(np.median(seen[piece]))
    clear = (np.abs(left.rest) < CLEAR_CONTRAST * contrast) & (np.abs(seen - grey) > 0.4 * contrast)
    for label in range(1, count):
        end = labels == label
        alike = abs(float(np.median(seen[end])) - grey) < SAME_COVER_CONTRAST * float(
            np.median(contrast[end])
        )
        if not alike or end.sum() < MIN_END_RATIO * piece.sum():
            continue
        v, u = np.nonzero(piece | end)
        area = np.zeros(piece.shape, np.uint8)
        cv2.fillConvexPoly(area, cv2.convexHull(np.stack([u, v], axis=1).astype(np.int32)), 1)
        over = area > 0
        if (
            float(clear[over].mean()) < MAX_CLEAR_RATIO
            and _slope(seen, left.picture, over, contrast) < MAX_SLOPE
        ):
            return True
    return False


def _slope(seen: Array, picture: npt.NDArray[np.float32], area: Mask, contrast: Array) -> float:
    """How much of the model's contrast is seen in an area, 0..1."""
    model = picture[area] - picture[area].mean()
    spread = float(model @ model)
    return float(model @ seen[area]) / (spread * float(np.median(contrast[area]))) if spread > 0.0 else 0.0
