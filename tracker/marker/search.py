"""Candidate search: quads whose content matches a marker model.

The search runs in rounds of rising cost: dark regions with four sides first, then single corners, then
coarser and fainter pyramid levels. Four sides find a free-standing marker in a fifth of the time of
`cv2.aruco`; a corner and the side lengths that tilt allows find one of which a third is occluded. All rounds
together cost several times as much, so an idle search runs them in turn, one in an image.

Quads from a corner have errors of up to a tenth of their side, and under motion blur the coarse match then
ranks the true quad only about hundredth. Two least-squares steps take as long as that match and rank it among
the first few in nine of ten images. The second fitted quad is the best by local normalised cross-correlation:
it ranks the true quad first or second in shadow, glare and noise, but fails under motion blur, where the
first score is good.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage, chains_of, edgels_of, gradient_of, joined_segments, segments_of
from tracker.geometry import Array
from tracker.marker.photometric_fit import local_ncc_at
from tracker.marker.pyramid import MIN_LEVEL_PX, WINDOW_PX, ImagePyramid, PyramidLevel, first_level, softened
from tracker.marker.template_matching import (
    STEPS,
    Template,
    Templates,
    coarse_match,
    refine_quads,
    template_match,
)
from tracker.marker.template_matching.template_kernels import distinct
from tracker.quads import Quads, corner_quads_of, pair_quads_of
from tracker.regions import (
    Regions,
    border_segments,
    dark_mask,
    noise_grey,
    quads_of,
    regions_of_mask,
)

# A visible marker has 0.8 to 1 after refinement.
MIN_CORRELATION = 0.76
# Two outlines nearer than this at all corners are one.
SAME_OUTLINE_SIDE_RATIO = 0.06
MIN_PIECE_PX = 4.0
NOISE_SDS, MIN_DARKER_GREY = 3.0, 3.0
MIN_STEP_SDS, MIN_STEP_GREY = 1.5, 5.0
# Number of Gauss-Newton steps after which quads are ranked for a complete refinement.
FIRST_STEPS = 2
# Maximum error of a quad from a single corner, in sides.
MAX_BEYOND_SIDES = 0.1
# Maximum number of models among which the quads are shared.
MAX_SHARES = 4
# Quads from four sides are more accurate than from two, so fewer are refined.
MAX_REFINED_FOUR_SIDED = 8
# Number of quads among which the coarse match ranks the true one in nearly all images.
MAX_PARALLEL = 40
# A quad whose centre is nearer than this, in sides, to a marker that is seen lies on that marker.
SAME_PLACE_SIDES = 0.5
# Before refinement, an unoccluded marker has 0.88 or more at half size, other dark squares up to 0.84.
# Refinement and fit of those in each image would take longer than the search.
MIN_DISTINCT_CORRELATION = 0.86
# If the best quad reaches the first correlation, quads whose correlation is lower by the second are dropped.
CERTAIN_CORRELATION, MAX_CORRELATION_GAP = 0.94, 0.08


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """Number of quads retained for each model after each stage.

    Attributes:
        coarse: number of quads from a corner after the coarse match, shared by several models.
        refined: number after two Gauss-Newton steps.
        local_ncc: number after all steps.
        max_candidates: number of returned candidates.
        ranks_by_local_ncc: whether all candidates except the first are ranked by local NCC: each of the two
            scores is the better one in some images.
    """

    coarse: int
    refined: int
    local_ncc: int
    max_candidates: int
    ranks_by_local_ncc: bool = True

    def coarse_of(self, models: int) -> int:
        """Return the number of quads per model."""
        return self.coarse // min(models, MAX_SHARES)


# Under shadow, highlights, motion blur and noise together only the local NCC separates the marker from other
# shapes, and two steps rank it past the hundredth.
STANDARD = Effort(coarse=180, refined=12, local_ncc=8, max_candidates=4)
# An idle search fits each candidate once over many images, so the order matters little.
IDLE = replace(STANDARD, ranks_by_local_ncc=False)
THOROUGH = Effort(coarse=500, refined=140, local_ncc=100, max_candidates=6)


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidate:
    """A quad that may be an occurrence of one model.

    Attributes:
        corners_px: (4, 2), top-left, top-right, bottom-right, bottom-left of the printed face.
        correlation: normalised cross-correlation with the model, -1..1.
    """

    corners_px: Array
    correlation: float


def candidate_rounds(image: GreyImage, templates: Templates) -> Iterator[list[list[Candidate]]]:
    """Yield for each model (m) its next candidates, the best first, at increasing cost.

    The first round finds a free-standing marker in ordinary light; later rounds find blurred, partly
    occluded, dark or small ones. A caller that has found its marker stops iterating.

    Args:
        image: grey (h, w).
        templates: templates of the models.
    """
    return _rounds(image, templates, _match_stages, STANDARD)


def thorough_rounds(image: GreyImage, templates: Templates) -> Iterator[list[list[Candidate]]]:
    """Yield candidates like `candidate_rounds`, from far more quads at far higher cost.

    For shadow, highlights, motion blur and noise in combination.
    """
    return _rounds(image, templates, _thorough_match_stages, THOROUGH)


def four_sided_candidates(image: GreyImage, templates: Templates) -> list[list[Candidate]]:
    """Return for each model (m) the candidates of dark regions with four sides: free-standing markers."""
    return _joined(_rounds(image, templates, _match_quick_rounds, IDLE), templates)


def costly_candidates(image: GreyImage, templates: Templates, *, index: int) -> list[list[Candidate]]:
    """Return for each model (m) the candidates of one costly round, for blurred or occluded markers.

    `index` is below `COSTLY_ROUNDS`.
    """

    def stage(image: GreyImage, levels: ImagePyramid, templates: Templates) -> _Stage:
        return _COSTLY_ROUNDS[index](_Features(image, levels), templates)

    return _joined(_rounds(image, templates, stage, IDLE), templates)


def second_print_candidates(
    image: GreyImage, templates: Templates, *, seen_px: Array, thorough: bool
) -> list[list[Candidate]]:
    """Return for each model (m) the candidates of dark regions that are not on a marker that is seen.

    Args:
        image: grey (h, w).
        templates: of the models.
        seen_px: (n, 4, 2), corners of the markers that are seen in it.
        thorough: whether partly occluded and small prints are candidates too, at ten times the cost.
            Otherwise free-standing ones of 10 px or more at the level after the first are: at half size, or
            at a quarter in images of over a million pixels.
    """

    def stage(image: GreyImage, levels: ImagePyramid, templates: Templates) -> _Stage:
        features = _Features(image, levels)
        for one in (_match_occluded if thorough else _match_distinct)(features, templates):
            # Before they are ranked: next to the marker itself, an occluded print is no candidate.
            elsewhere = ~_are_on(one.level.image_from_level(one.quads), seen_px)
            yield one._replace(quads=one.quads[elsewhere], correlation=one.correlation[elsewhere])

    return _joined(_rounds(image, templates, stage, IDLE), templates)


def _match_occluded(features: "_Features", templates: Templates) -> "_Stage":
    for stage in (_match_four_sides, _match_border_corners, _match_full_size):
        yield from stage(features, templates)


def _match_distinct(features: "_Features", templates: Templates) -> "_Stage":
    level = features.half or features.first
    matched = _from_regions(level, _regions(level), templates)
    is_distinct = matched.correlation.max(axis=(1, 2), initial=-1.0) >= MIN_DISTINCT_CORRELATION
    yield matched._replace(quads=matched.quads[is_distinct], correlation=matched.correlation[is_distinct])


def _are_on(quads: Quads, seen_px: Array) -> npt.NDArray[np.bool_]:
    """Return which quads (q, 4, 2) have their centre on one of these squares (n, 4, 2)."""
    apart_px = np.linalg.norm(quads.mean(axis=1)[:, None] - seen_px.mean(axis=1), axis=2)
    return np.asarray((apart_px < SAME_PLACE_SIDES * _sides_px(seen_px)).any(axis=1))


def _joined(rounds: Iterator[list[list[Candidate]]], templates: Templates) -> list[list[Candidate]]:
    joined: list[list[Candidate]] = [[] for _ in templates.each]
    for candidates in rounds:
        for own, more in zip(joined, candidates, strict=True):
            own.extend(more)
    return joined


def _rounds(
    image: GreyImage,
    templates: Templates,
    stages: Callable[[GreyImage, ImagePyramid, Templates], "_Stage"],
    effort: Effort,
) -> Iterator[list[list[Candidate]]]:
    """Yield for each model the candidates of each stage; none is reported twice."""
    if min(image.shape) < MIN_LEVEL_PX or len(templates) == 0:
        return
    levels = ImagePyramid(first_level(image))
    reported = [np.empty((0, 4, 2), np.float32) for _ in templates.each]
    for level, quads, correlation, is_coarse in stages(image, levels, templates):
        fresh: list[list[Candidate]] = []
        for m, template in enumerate(templates.each):
            # A quad that correlates better with another model may still be this one: a coarse match is
            # unreliable.
            max_count = len(quads) if is_coarse else MAX_REFINED_FOUR_SIDED
            rotated = _top(
                level.image_from_level(quads), correlation[:, m], max_count, is_certain=not is_coarse
            )
            if is_coarse:
                rotated = _best_after_first_steps(levels, rotated, template, effort.refined)
            refined, ncc = _refined(levels, rotated, template)
            best = distinct(
                refined,
                ncc,
                np.argsort(-ncc, kind="stable"),
                reported[m],
                effort.local_ncc,
                MIN_CORRELATION,
                SAME_OUTLINE_SIDE_RATIO,
            )
            candidates = [_candidate(refined[k], ncc[k]) for k in best]
            if effort.ranks_by_local_ncc:
                candidates = _ranked_by_two_scores(image, candidates, template)
            selected = candidates[: effort.max_candidates]
            reported[m] = np.concatenate(
                [reported[m], *(one.corners_px[None].astype(np.float32) for one in selected)]
            )
            fresh.append(selected)
        yield fresh


def _candidate(corners_px: npt.NDArray[np.float32], correlation: np.float32) -> Candidate:
    return Candidate(corners_px=corners_px.astype(np.float64), correlation=float(correlation))


def _ranked_by_two_scores(
    image: GreyImage, candidates: list[Candidate], template: Template
) -> list[Candidate]:
    """Return the best candidate first, the others by local normalised cross-correlation."""
    if len(candidates) < 3:
        return candidates
    first, *others = candidates

    def local_ncc(one: Candidate) -> float:
        side_px = float(_sides_px(one.corners_px[None])[0])
        return local_ncc_at(image, template.pictures, one.corners_px, side_px=side_px)

    return [first, *sorted(others, key=local_ncc, reverse=True)]


class MatchedQuads(NamedTuple):
    """Quads (q, 4, 2) in px of a level, with their coarse or full template correlation (q, m, 4)."""

    level: PyramidLevel
    quads: Quads
    correlation: npt.NDArray[np.float32]
    is_coarse: bool


_Stage = Iterator[MatchedQuads]


class _Features:
    """Regions and edge segments of an image at the levels of its pyramid, computed on demand."""

    def __init__(self, image: GreyImage, levels: ImagePyramid) -> None:
        self._image, self._levels = image, levels

    @property
    def first(self) -> PyramidLevel:
        return self._levels[0]

    @property
    def half(self) -> PyramidLevel | None:
        """The level after the first; None for an image that is too small."""
        return self._levels[1] if min(self.first.image.shape) >= 2 * MIN_LEVEL_PX else None

    @cached_property
    def full(self) -> PyramidLevel | None:
        """The image itself where the first level is a smaller one, for small markers in large images."""
        if self.first.scale == 1:
            return None
        return PyramidLevel(image=self._image, scale=1, noise_grey=noise_grey(self._image))

    @cached_property
    def regions(self) -> Regions:
        """Dark regions of the first level."""
        return _regions(self.first)

    @cached_property
    def edges(self) -> npt.NDArray[np.float32]:
        """Edge segments of the first level."""
        return _edge_segments(self.first.image, MIN_PIECE_PX)


def _match_four_sides(features: _Features, templates: Templates) -> _Stage:
    yield _from_regions(features.first, features.regions, templates)


def _match_full_size(features: _Features, templates: Templates) -> _Stage:
    full = features.full
    if full is not None:
        yield _from_regions(full, _regions(full), templates)


def _match_border_corners(features: _Features, templates: Templates) -> _Stage:
    segments = border_segments(features.regions)
    yield _from_corners(features.first, segments, templates, STANDARD.coarse_of(len(templates)))


def _match_half_size(features: _Features, templates: Templates) -> _Stage:
    half = features.half
    if half is not None:
        yield _from_regions(half, _regions(half), templates)
        segments = _edge_segments(half.image, MIN_PIECE_PX)
        yield _from_corners(half, segments, templates, STANDARD.coarse_of(len(templates)))


def _match_edge_corners(features: _Features, templates: Templates) -> _Stage:
    yield _from_corners(features.first, features.edges, templates, STANDARD.coarse_of(len(templates)))


def _match_parallel_sides(features: _Features, templates: Templates) -> _Stage:
    yield _between_parallel_sides(features.first, features.edges, templates)


# The rounds with hypotheses from one corner or two sides; each takes several times as long as four sides.
_COSTLY_ROUNDS = (_match_border_corners, _match_half_size, _match_edge_corners, _match_parallel_sides)
COSTLY_ROUNDS = len(_COSTLY_ROUNDS)


def _match_stages(image: GreyImage, levels: ImagePyramid, templates: Templates) -> _Stage:
    """Yield matched quads stage by stage, at rising cost."""
    features = _Features(image, levels)
    yield from _match_four_sides(features, templates)
    yield from _match_border_corners(features, templates)
    yield from _match_half_size(features, templates)
    yield from _match_edge_corners(features, templates)
    yield from _match_parallel_sides(features, templates)
    yield from _match_full_size(features, templates)


def _match_quick_rounds(image: GreyImage, levels: ImagePyramid, templates: Templates) -> _Stage:
    """Yield matched quads of dark regions, at each level but the half size."""
    features = _Features(image, levels)
    yield from _match_four_sides(features, templates)
    yield from _match_full_size(features, templates)


def _thorough_match_stages(_image: GreyImage, levels: ImagePyramid, templates: Templates) -> _Stage:
    """Yield matched quads from single corners, also in smoothed images."""
    level, soft = levels[0], softened(levels[0])
    for seen, segments in (
        (level, border_segments(_regions(level))),
        (level, _edge_segments(level.image, MIN_PIECE_PX)),
        (soft, border_segments(_regions(soft))),
        (soft, _edge_segments(soft.image, MIN_PIECE_PX)),
    ):
        matched = _from_corners(seen, segments, templates, THOROUGH.coarse_of(len(templates)))
        within = _are_within(matched.quads, seen.image)
        yield matched._replace(quads=matched.quads[within], correlation=matched.correlation[within])


def _are_within(quads: Quads, image: GreyImage) -> npt.NDArray[np.bool_]:
    """Return which quads (q, 4, 2) lie in the image, up to their possible error.

    Among so many quads, some that the image border cuts correlate as well as the marker.
    """
    height, width = image.shape
    beyond = np.maximum(-quads, quads - np.array([width - 1, height - 1], np.float32)).max(axis=(1, 2))
    return np.asarray(beyond <= MAX_BEYOND_SIDES * _sides_px(quads))


def _regions(level: PyramidLevel) -> Regions:
    darker = max(NOISE_SDS * level.noise_grey, MIN_DARKER_GREY)
    return regions_of_mask(dark_mask(level.image, window_px=WINDOW_PX, darker_grey=darker))


def _from_regions(level: PyramidLevel, regions: Regions, templates: Templates) -> MatchedQuads:
    """Match quads of dark regions."""
    quads = quads_of(regions)
    return MatchedQuads(level, quads, template_match(level.image, quads, templates), is_coarse=False)


def _edge_segments(image: GreyImage, min_px: float) -> npt.NDArray[np.float32]:
    edgels = edgels_of(gradient_of(image))
    pieces = segments_of(edgels, chains_of(edgels), min_length_px=min_px)
    return np.concatenate([pieces, joined_segments(pieces)])


def _from_corners(
    level: PyramidLevel, segments: npt.NDArray[np.float32], templates: Templates, max_count: int
) -> MatchedQuads:
    """Match quads of which one corner is visible."""
    step = max(MIN_STEP_SDS * level.noise_grey, MIN_STEP_GREY)
    corners = corner_quads_of(level.image, segments, min_step_grey=step)
    return MatchedQuads(
        level, *coarse_match(level.soft, corners, templates, maximum=max_count), is_coarse=True
    )


def _between_parallel_sides(
    level: PyramidLevel, segments: npt.NDArray[np.float32], templates: Templates
) -> MatchedQuads:
    """Match quads of which two opposite sides are visible, the others blurred by motion along them."""
    quads = pair_quads_of(segments)
    return MatchedQuads(
        level,
        *coarse_match(level.soft, quads, templates, maximum=MAX_PARALLEL, motion_blurred=True),
        is_coarse=True,
    )


def _top(quads: Quads, correlation: npt.NDArray[np.float32], max_count: int, *, is_certain: bool) -> Quads:
    """Return the best quads and rotations (q, 4), each with the model's first corner first.

    `is_certain`: whether the correlation is reliable enough to drop those far below the best.
    """
    flat = correlation.ravel()
    best = np.argpartition(-flat, max_count)[:max_count] if len(flat) > max_count else np.arange(len(flat))
    if is_certain and len(best) and flat[best].max() > CERTAIN_CORRELATION:
        best = best[flat[best] > flat[best].max() - MAX_CORRELATION_GAP]
    q, rotation = np.divmod(best, 4)
    corner = (np.arange(4) - rotation[:, None]) % 4
    return np.ascontiguousarray(quads[q[:, None], corner])


def _best_after_first_steps(levels: ImagePyramid, quads: Quads, template: Template, max_count: int) -> Quads:
    """Return the quads with the highest correlation after the first steps, moved by them."""
    moved, ncc = _refined(levels, quads, template, steps=FIRST_STEPS)
    return moved[np.argsort(-ncc, kind="stable")[:max_count]]


def _refined(
    levels: ImagePyramid, quads: Quads, template: Template, *, steps: int = STEPS
) -> tuple[Quads, npt.NDArray[np.float32]]:
    """Return refined quads, in px of the full image, and their correlation."""
    which = np.array([levels.for_side(float(side)) for side in _sides_px(quads)], dtype=int)
    found, ncc = quads.copy(), np.zeros(len(quads), np.float32)
    for k in np.unique(which):
        own = which == k
        moved, ncc[own] = refine_quads(
            levels[k].image, levels[k].level_from_image(quads[own]), template, steps=steps
        )
        found[own] = levels[k].image_from_level(moved)
    return found, ncc


def _sides_px(quads: npt.NDArray[np.floating]) -> npt.NDArray[np.floating]:
    """Return the approximate side of each quad (q, 4, 2): the mean of three sides."""
    return np.asarray(np.linalg.norm(np.diff(quads, axis=1), axis=2).mean(axis=1))
