"""Where in an image the markers could be: dark squares whose inside looks like them at a glance."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage, chains_of, edgels_of, gradient_of, joined_segments, segments_of
from tracker.geometry import Array
from tracker.marker.glance import glance, glance_past_cover, likely, nudged
from tracker.outlines import Quads, corner_quads_of
from tracker.regions import dark_mask, even_image, noise_grey, quads_of_mask

# An image over a megapixel is first looked at at half its size.
MOST_PIXELS_AT_ONCE = 1_000_000
LEAST_LEVEL_PX = 12
# At a glance (cells of a twelfth of the side, corners off by a pixel or two) a marker in sight has 0.8 to 1.
LEAST_LIKENESS = 0.76
MOST_CANDIDATES = 4
# Two outlines nearer than this at all corners are one.
SAME_OUTLINE_SIDE_RATIO = 0.06
WINDOW_PX = 21
LEAST_PIECE_PX = 4.0
NOISE_SDS, LEAST_DARKER_GREY = 3.0, 3.0
LEAST_STEP_SDS, LEAST_STEP_GREY = 1.5, 5.0
# Of many models each has its share, so that they cost little more than one.
MOST_PEEKED, LEAST_PEEKED = 100, 40
MOST_NUDGED, LEAST_NUDGED = 8, 4
NUDGES = (0.07, 0.035)


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidate:
    """An outline that could be one model's.

    Attributes:
        corners_px: (4, 2), top-left, top-right, bottom-right, bottom-left of the printed face.
        likeness: correlation of its inside with the model's, -1..1.
    """

    corners_px: Array
    likeness: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Level:
    """The image at a half, a quarter of its size, or as it is.

    Attributes:
        image: (h, w).
        scale: how many pixels of the whole image one of its pixels is wide.
        noise_grey: sd of its noise.
    """

    image: GreyImage
    scale: int
    noise_grey: float

    def full_px(self, quads: Quads) -> Quads:
        """Points of this level in px of the whole image."""
        return np.asarray(quads * np.float32(self.scale) + np.float32(0.5 * (self.scale - 1)), np.float32)


def candidate_rounds(image: GreyImage, templates: npt.NDArray[np.float32]) -> Iterator[list[list[Candidate]]]:
    """For each model (m, ...) of the templates its next candidates, the likeliest first, at rising cost.

    The first round finds a marker that stands free in ordinary light; the later ones are for what is blurred,
    partly covered, in the dark, small. Who has found its marker stops asking.

    Args:
        image: grey (h, w).
        templates: as `templates_of` makes them.
    """
    given: list[list[Candidate]] = [[] for _ in range(len(templates))]
    for level, quads, likeness in _looks(image, templates):
        full = level.full_px(quads)
        fresh = [_best(full, likeness[:, m], known) for m, known in enumerate(given)]
        for known, new in zip(given, fresh, strict=True):
            known.extend(new)
        yield fresh


Look: TypeAlias = tuple[Level, Quads, npt.NDArray[np.float32]]


def _looks(image: GreyImage, templates: npt.NDArray[np.float32]) -> Iterator[Look]:
    """Outlines (q, 4, 2) in px of a level and their likeness (q, m, 4), look after look."""
    if min(image.shape) < LEAST_LEVEL_PX or len(templates) == 0:
        return
    level = first_level(image)
    dark = _by_darkness(level)
    yield level, dark, glance(level.image, dark, templates)
    if min(level.image.shape) < 2 * LEAST_LEVEL_PX:
        yield _at_corners(level, _edge_segments(level.image), templates)
        return
    yield _at_corners(level, _edge_segments(level.image), templates)
    half = halved(level)
    dark = _by_darkness(half)
    yield half, dark, glance(half.image, dark, templates)
    if level.scale > 1:
        # What is small in a large image.
        whole = Level(image=image, scale=1, noise_grey=noise_grey(image))
        dark = _by_darkness(whole)
        yield whole, dark, glance(whole.image, dark, templates)
    both = np.concatenate([_edge_segments(half.image), _dark_segments(half)])
    yield _at_corners(half, both, templates)
    yield _at_corners(level, _dark_segments(level), templates)


def first_level(image: GreyImage) -> Level:
    """The image at the size at which it is looked at first."""
    level = Level(image=image, scale=1, noise_grey=0.0)
    if image.size > MOST_PIXELS_AT_ONCE:
        return halved(level)
    return Level(image=image, scale=1, noise_grey=noise_grey(image))


def halved(level: Level) -> Level:
    """The same at half the size: a pixel is the mean of four."""
    height, width = level.image.shape
    even = level.image[: height // 2 * 2, : width // 2 * 2]
    half = np.asarray(cv2.resize(even, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA), dtype=np.uint8)
    return Level(image=half, scale=2 * level.scale, noise_grey=noise_grey(half))


def _by_darkness(level: Level) -> Quads:
    return quads_of_mask(_dark_mask(level))


def _dark_mask(level: Level) -> npt.NDArray[np.uint8]:
    darker = max(NOISE_SDS * level.noise_grey, LEAST_DARKER_GREY)
    return dark_mask(level.image, window_px=WINDOW_PX, darker_grey=darker)


def _edge_segments(image: GreyImage) -> npt.NDArray[np.float32]:
    edgels = edgels_of(gradient_of(image))
    pieces = segments_of(edgels, chains_of(edgels), least_length_px=LEAST_PIECE_PX)
    return np.concatenate([pieces, joined_segments(pieces)])


def _dark_segments(level: Level) -> npt.NDArray[np.float32]:
    """The straight pieces of the dark regions' outlines: they stand where edges are too faint to follow."""
    light = cv2.blur(cv2.bitwise_not(_dark_mask(level)), (3, 3))
    return _edge_segments(np.asarray(light, dtype=np.uint8))


def _at_corners(level: Level, segments: npt.NDArray[np.float32], templates: npt.NDArray[np.float32]) -> Look:
    """Outlines of which a corner is seen, and of the rest as much as is not covered."""
    step = max(LEAST_STEP_SDS * level.noise_grey, LEAST_STEP_GREY)
    corners = corner_quads_of(level.image, segments, least_step_grey=step)
    even = even_image(level.image, window_px=WINDOW_PX, noise_grey=level.noise_grey)
    most = max(MOST_PEEKED // len(templates), LEAST_PEEKED)
    quads = likely(even, corners, templates, most=most)
    likeness = glance_past_cover(level.image, quads, templates)
    # The best ones are moved until they sit.
    for share in NUDGES:
        quads = nudged(_top(quads, likeness), share)
        likeness = glance_past_cover(level.image, quads, templates)
    return level, quads, likeness


def _top(quads: Quads, likeness: npt.NDArray[np.float32]) -> Quads:
    """The likeliest outlines of each model."""
    most = max(MOST_NUDGED // likeness.shape[1], LEAST_NUDGED)
    if len(quads) <= most:
        return quads
    best = np.argpartition(-likeness.max(axis=2), most, axis=0)[:most]
    return quads[np.unique(best)]


def _best(quads: Quads, likeness: npt.NDArray[np.float32], known: list[Candidate]) -> list[Candidate]:
    """The likeliest outlines and turns (q, 4) that are not known yet, each once."""
    order = np.argsort(-likeness, axis=None, kind="stable")
    best: list[Candidate] = []
    for flat in order[: 8 * MOST_CANDIDATES]:
        q, turn = divmod(int(flat), 4)
        worth = float(likeness[q, turn])
        if worth < LEAST_LIKENESS or len(best) >= MOST_CANDIDATES:
            break
        corners = np.roll(quads[q].astype(np.float64), turn, axis=0)
        same = SAME_OUTLINE_SIDE_RATIO * float(np.linalg.norm(np.diff(corners, axis=0), axis=1).mean())
        others = (*known, *best)
        if all(float(np.abs(corners - other.corners_px).max()) > max(same, 1.0) for other in others):
            best.append(Candidate(corners_px=corners, likeness=worth))
    return best
