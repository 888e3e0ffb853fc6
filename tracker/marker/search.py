"""Where in an image the marker could be: outlines whose inside looks like it at a glance."""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.edges import (
    Edgels,
    Gradient,
    GreyImage,
    chains_of,
    edgels_of,
    gradient_of,
    joined_segments,
    segments_of,
)
from tracker.geometry import Array
from tracker.marker.glance import glance
from tracker.marker.kernels import LEAST_SIDE_PX
from tracker.marker.outline import Quads, quads_of

# At a glance (12x12 cells, corners off by a pixel or two) a marker in sight has 0.6 to 1.
LEAST_LIKENESS = 0.35
MOST_CANDIDATES = 10
# Two outlines nearer than this at all corners are one.
SAME_OUTLINE_SIDE_RATIO = 0.06


@dataclass(frozen=True, slots=True, kw_only=True)
class Look:
    """What edge finding made of an image, for all models at once.

    Attributes:
        image: the grey image (h, w).
        gradient: of the whole image.
        edgels: of the whole image.
        quads: (q, 4, 2), outlines that could be a dark square's, clockwise on the screen.
    """

    image: GreyImage
    gradient: Gradient
    edgels: Edgels
    quads: Quads


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidate:
    """An outline that could be one model's.

    Attributes:
        corners_px: (4, 2), top-left, top-right, bottom-right, bottom-left of the printed face.
        likeness: correlation of its inside with the model's, -1..1.
    """

    corners_px: Array
    likeness: float


def outlines_in(image: GreyImage, gradient: Gradient) -> Look:
    """The edges of a grey image and the outlines that they make.

    Outlines are looked for at half the size as well: an edge blurred over four pixels is a clear one there.
    """
    edgels = edgels_of(gradient)
    half = np.asarray(cv2.resize(image, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA), dtype=np.uint8)
    coarse = _outlines(edgels_of(gradient_of(half)))
    quads = np.concatenate([_outlines(edgels), coarse * np.float32(2.0) + np.float32(0.5)])
    return Look(image=image, gradient=gradient, edgels=edgels, quads=quads)


def _outlines(edgels: Edgels) -> Quads:
    pieces = segments_of(edgels, chains_of(edgels), least_length_px=LEAST_SIDE_PX)
    return quads_of(np.concatenate([pieces, joined_segments(pieces)]))


def candidates_of(look: Look, templates: npt.NDArray[np.float32]) -> list[list[Candidate]]:
    """For each model (m, 4, cells) its candidates, the likeliest first, at most ten."""
    if len(look.quads) == 0:
        return [[] for _ in range(len(templates))]
    likeness = glance(look.image, look.quads, templates)
    return [_best(look.quads, likeness[:, m]) for m in range(len(templates))]


def _best(quads: Quads, likeness: npt.NDArray[np.float32]) -> list[Candidate]:
    """The likeliest outlines and turns (q, 4), each outline once."""
    order = np.argsort(-likeness, axis=None, kind="stable")
    best: list[Candidate] = []
    for flat in order[: 8 * MOST_CANDIDATES]:
        q, turn = divmod(int(flat), 4)
        worth = float(likeness[q, turn])
        if worth < LEAST_LIKENESS or len(best) >= MOST_CANDIDATES:
            break
        corners = np.roll(quads[q].astype(np.float64), turn, axis=0)
        same = SAME_OUTLINE_SIDE_RATIO * float(np.linalg.norm(np.diff(corners, axis=0), axis=1).mean())
        if all(float(np.abs(corners - other.corners_px).max()) > max(same, 1.0) for other in best):
            best.append(Candidate(corners_px=corners, likeness=worth))
    return best
