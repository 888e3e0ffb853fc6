"""Where in an image the markers could be: dark squares whose inside looks like them at a glance.

The search runs in rounds of rising cost: the four sides of dark regions first, then single corners, then
coarser and fainter levels. Four sides find a marker that stands free in a fifth of the time of `cv2.aruco`;
a corner and the side lengths that tilt allows find one of which a third is covered. An image without a
marker costs several times as much, because whatever resembles the marker is fitted before it is rejected.

Outlines from a corner are off by up to a tenth of their side, where a coarse match ranks the true one
hundredth under motion blur. Two least-squares steps cost as much as that match and rank it among the first
few in nine of ten images. The second outline that is fitted is the best by part-by-part correlation: it
ranks first or second in shadow, glare and noise, and fails under motion blur, where the first one is good.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage, chains_of, edgels_of, gradient_of, joined_segments, segments_of
from tracker.geometry import Array
from tracker.marker.explanation import correlation_part_by_part
from tracker.marker.levels import MIN_LEVEL_PX, WINDOW_PX, Level, Levels, first_level, softened
from tracker.marker.looks import (
    STEPS,
    Template,
    Templates,
    glance,
    likely,
    looked_closer,
)
from tracker.marker.looks.kernels import distinct
from tracker.outlines import Quads, corner_quads_of, pair_quads_of
from tracker.regions import (
    Regions,
    border_segments,
    dark_mask,
    noise_grey,
    quads_of,
    regions_of_mask,
)

# At a closer look a marker in sight has 0.8 to 1.
MIN_CORRELATION = 0.76
# Two outlines nearer than this at all corners are one.
SAME_OUTLINE_SIDE_RATIO = 0.06
MIN_PIECE_PX = 4.0
NOISE_SDS, MIN_DARKER_GREY = 3.0, 3.0
MIN_STEP_SDS, MIN_STEP_GREY = 1.5, 5.0
# A corner says little of where the others are: two steps tell which outlines are worth all of them.
FIRST_STEPS = 2
# By so much of its side an outline of which a corner is seen may be off.
MAX_BEYOND_SIDES = 0.1
# So many models share; more cost more.
MAX_SHARES = 4
# Of four sides, where they are is known better than of two.
MAX_CLOSER_OF_FOUR = 8
# A peek ranks the true one of these first in nearly all images.
MAX_SMEARED = 40
# Where one outline is as like as this, those that are so far behind are not it.
SURE_CORRELATION, FAR_BEHIND = 0.94, 0.08


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """How many outlines are kept for each model, look after look.

    Attributes:
        peeked: of those of which a corner is seen, after a peek. Of many models each has its share, so that
            they cost little more than one.
        closer: after two steps.
        part_by_part: after all of them.
        given: as candidates.
    """

    peeked: int
    closer: int
    part_by_part: int
    given: int

    def peeked_of(self, models: int) -> int:
        """The share of each of so many models."""
        return self.peeked // min(models, MAX_SHARES)


# Where shadow, highlights, smear and noise come together, the look part by part alone tells the marker from
# other shapes, and two steps rank it up to past the hundredth.
USUAL = Effort(peeked=180, closer=12, part_by_part=8, given=4)
THOROUGH = Effort(peeked=500, closer=140, part_by_part=100, given=6)


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidate:
    """An outline that could be one model's.

    Attributes:
        corners_px: (4, 2), top-left, top-right, bottom-right, bottom-left of the printed face.
        likeness: correlation of its inside with the model's, -1..1.
    """

    corners_px: Array
    correlation: float


def candidate_rounds(image: GreyImage, templates: Templates) -> Iterator[list[list[Candidate]]]:
    """For each model (m) of the templates its next candidates, the likeliest first, at rising cost.

    The first round finds a marker that stands free in ordinary light; the later ones are for what is blurred,
    partly covered, in the dark, small. Who has found its marker stops asking.

    Args:
        image: grey (h, w).
        templates: as `templates_of` makes them.
    """
    return _rounds(image, templates, _looks, USUAL)


def thorough_rounds(image: GreyImage, templates: Templates) -> Iterator[list[list[Candidate]]]:
    """Candidates as `candidate_rounds` gives them, of far more outlines, at far more cost.

    Where a shadow, highlights, smear and noise come together.
    """
    return _rounds(image, templates, _thorough_looks, THOROUGH)


def _rounds(
    image: GreyImage,
    templates: Templates,
    looks: Callable[[GreyImage, Levels, Templates], Iterator["Look"]],
    effort: Effort,
) -> Iterator[list[list[Candidate]]]:
    """For each model its candidates of look after look; what was given once is not given again."""
    if min(image.shape) < MIN_LEVEL_PX or len(templates) == 0:
        return
    levels = Levels(first_level(image))
    given = [np.empty((0, 4, 2), np.float32) for _ in templates.each]
    for level, quads, correlation, is_peek in looks(image, levels, templates):
        fresh: list[list[Candidate]] = []
        for m, template in enumerate(templates.each):
            # What another model was the likelier for may still be this one: a peek tells little.
            most = len(quads) if is_peek else MAX_CLOSER_OF_FOUR
            turned = _top(level.full_px(quads), correlation[:, m], most, is_sure=not is_peek)
            if is_peek:
                turned = _worth_all_steps(levels, turned, template, effort.closer)
            closer, alike = _closer(levels, turned, template)
            best = distinct(
                closer,
                alike,
                np.argsort(-alike, kind="stable"),
                given[m],
                effort.part_by_part,
                MIN_CORRELATION,
                SAME_OUTLINE_SIDE_RATIO,
            )
            candidates = [_candidate(closer[k], alike[k]) for k in best]
            kept = _by_two_looks(image, candidates, template)[: effort.given]
            given[m] = np.concatenate([given[m], *(one.corners_px[None].astype(np.float32) for one in kept)])
            fresh.append(kept)
        yield fresh


def _candidate(corners_px: npt.NDArray[np.float32], correlation: np.float32) -> Candidate:
    return Candidate(corners_px=corners_px.astype(np.float64), correlation=float(correlation))


def _by_two_looks(image: GreyImage, candidates: list[Candidate], template: Template) -> list[Candidate]:
    """The likeliest first, then those that are likeliest part by part.

    Each look is the better one in some images, and few candidates are fitted.
    """
    if len(candidates) < 3:
        return candidates
    first, *others = candidates

    def part_by_part(one: Candidate) -> float:
        side_px = float(_sides_px(one.corners_px[None])[0])
        return correlation_part_by_part(image, template.pictures, one.corners_px, side_px=side_px)

    return [first, *sorted(others, key=part_by_part, reverse=True)]


class Look(NamedTuple):
    """Outlines (q, 4, 2) in px of a level, and their likeness (q, m, 4), at a glance or at a mere peek."""

    level: Level
    quads: Quads
    correlation: npt.NDArray[np.float32]
    is_peek: bool


def _looks(image: GreyImage, levels: Levels, templates: Templates) -> Iterator[Look]:
    """Look after look, at rising cost."""
    level, most = levels[0], USUAL.peeked_of(len(templates))
    regions = _regions(level)
    yield _of_four_sides(level, regions, templates)
    yield _at_corners(level, border_segments(regions), templates, most)
    if min(level.image.shape) >= 2 * MIN_LEVEL_PX:
        half = levels[1]
        regions = _regions(half)
        yield _of_four_sides(half, regions, templates)
        yield _at_corners(half, _edge_segments(half.image, MIN_PIECE_PX), templates, most)
    edges = _edge_segments(level.image, MIN_PIECE_PX)
    yield _at_corners(level, edges, templates, most)
    yield _smeared(level, edges, templates)
    if level.scale > 1:
        # What is small in a large image.
        whole = Level(image=image, scale=1, noise_grey=noise_grey(image))
        yield _of_four_sides(whole, _regions(whole), templates)


def _thorough_looks(_image: GreyImage, levels: Levels, templates: Templates) -> Iterator[Look]:
    """Outlines of which a corner is seen, in noise too."""
    level, soft = levels[0], softened(levels[0])
    for seen, segments in (
        (level, border_segments(_regions(level))),
        (level, _edge_segments(level.image, MIN_PIECE_PX)),
        (soft, border_segments(_regions(soft))),
        (soft, _edge_segments(soft.image, MIN_PIECE_PX)),
    ):
        look = _at_corners(seen, segments, templates, THOROUGH.peeked_of(len(templates)))
        within = _are_within(look.quads, seen.image)
        yield look._replace(quads=look.quads[within], correlation=look.correlation[within])


def _are_within(quads: Quads, image: GreyImage) -> npt.NDArray[np.bool_]:
    """Which outlines (q, 4, 2) lie in the image, but for as much as they may be off.

    Of so many, some that the border cuts are as like the marker in what is left of them as itself.
    """
    height, width = image.shape
    beyond = np.maximum(-quads, quads - np.array([width - 1, height - 1], np.float32)).max(axis=(1, 2))
    return np.asarray(beyond <= MAX_BEYOND_SIDES * _sides_px(quads))


def _regions(level: Level) -> Regions:
    darker = max(NOISE_SDS * level.noise_grey, MIN_DARKER_GREY)
    return regions_of_mask(dark_mask(level.image, window_px=WINDOW_PX, darker_grey=darker))


def _of_four_sides(level: Level, regions: Regions, templates: Templates) -> Look:
    """Outlines that dark regions fill."""
    quads = quads_of(regions)
    return Look(level, quads, glance(level.image, quads, templates), is_peek=False)


def _edge_segments(image: GreyImage, min_px: float) -> npt.NDArray[np.float32]:
    edgels = edgels_of(gradient_of(image))
    pieces = segments_of(edgels, chains_of(edgels), min_length_px=min_px)
    return np.concatenate([pieces, joined_segments(pieces)])


def _at_corners(level: Level, segments: npt.NDArray[np.float32], templates: Templates, most: int) -> Look:
    """Outlines of which a corner is seen, and of the rest as much as is not covered."""
    step = max(MIN_STEP_SDS * level.noise_grey, MIN_STEP_GREY)
    corners = corner_quads_of(level.image, segments, min_step_grey=step)
    return Look(level, *likely(level.soft, corners, templates, most=most), is_peek=True)


def _smeared(level: Level, segments: npt.NDArray[np.float32], templates: Templates) -> Look:
    """Outlines of which two sides are seen: motion along them smears the others."""
    quads = pair_quads_of(segments)
    return Look(level, *likely(level.soft, quads, templates, most=MAX_SMEARED, smeared=True), is_peek=True)


def _top(quads: Quads, correlation: npt.NDArray[np.float32], most: int, *, is_sure: bool) -> Quads:
    """The likeliest outlines and turns (q, 4), each with the model's own first corner first.

    `is_sure`: whether a likeness tells enough to let go what is far behind the likeliest.
    """
    flat = correlation.ravel()
    best = np.argpartition(-flat, most)[:most] if len(flat) > most else np.arange(len(flat))
    if is_sure and len(best) and flat[best].max() > SURE_CORRELATION:
        best = best[flat[best] > flat[best].max() - FAR_BEHIND]
    q, turn = np.divmod(best, 4)
    corner = (np.arange(4) - turn[:, None]) % 4
    return np.ascontiguousarray(quads[q[:, None], corner])


def _worth_all_steps(levels: Levels, quads: Quads, template: Template, most: int) -> Quads:
    """The outlines that are likest after the first steps, moved by them."""
    moved, alike = _closer(levels, quads, template, steps=FIRST_STEPS)
    return moved[np.argsort(-alike, kind="stable")[:most]]


def _closer(
    levels: Levels, quads: Quads, template: Template, *, steps: int = STEPS
) -> tuple[Quads, npt.NDArray[np.float32]]:
    """Outlines moved to where they fit, all in px of the whole image, and how like the model each is."""
    which = np.array([levels.for_side(float(side)) for side in _sides_px(quads)], dtype=int)
    found, alike = quads.copy(), np.zeros(len(quads), np.float32)
    for k in np.unique(which):
        own = which == k
        moved, alike[own] = looked_closer(
            levels[k].image, levels[k].own_px(quads[own]), template, steps=steps
        )
        found[own] = levels[k].full_px(moved)
    return found, alike


def _sides_px(quads: npt.NDArray[np.floating]) -> npt.NDArray[np.floating]:
    """About how wide each outline (q, 4, 2) is: the mean of three of its sides."""
    return np.asarray(np.linalg.norm(np.diff(quads, axis=1), axis=2).mean(axis=1))
