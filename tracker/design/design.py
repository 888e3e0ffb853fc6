"""The best of many proposed shapes, in three sieves: likeness, then score and precision, then the tracker.

Most of many random shapes are discarded. Correlation with all squares of a background is one matrix product
for hundreds of shapes; the tracker itself judges only the last twelve, so that the printed figure is the
tracker's own. The result is no optimum: shapes are polygons, and the seed decides.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tracker.design.background import Advance, Background, searched
from tracker.design.correlation import background_correlation, own_correlation, turned_rows
from tracker.design.judgement import Judgement, without_search
from tracker.design.places import joined
from tracker.design.shape import Shape, picture_of
from tracker.marker import MarkerModel, ScoreSettings

GLANCE_PX, MODEL_PX = 100, 800
SCORED, SEARCHED = 40, 12


@dataclass(frozen=True, slots=True, kw_only=True)
class Design:
    """A proposed marker.

    Attributes:
        shape: what is printed.
        model: the same as the tracker takes it.
        judgement: its figures.
    """

    shape: Shape
    model: MarkerModel
    judgement: Judgement


def best_design(
    shapes: Sequence[Shape],
    background: Background | None,
    settings: ScoreSettings,
    *,
    side_mm: float,
    name: str,
    advance: Advance,
) -> Design:
    """The shape that nothing imitates, of those whose edges tell the pose best.

    By likeness 40 are kept, of these the ones that nothing reaches, of those the half that tells its pose
    better, and by score twelve at most, which the tracker searches for in every image. `advance` is called
    after each image of the background.
    """
    scored = [
        _scored(shape, background, settings, side_mm=side_mm, name=name)
        for shape in _min_alike(shapes, background)
    ]
    unique = [one for one in scored if one.judgement.unique] or scored
    precise = sorted(unique, key=lambda one: one.judgement.precision.tilt_sd_deg)[: -(-len(unique) // 2)]
    finalists = sorted(precise, key=_merit)[:SEARCHED]
    if background is not None:
        found = [searched([one.model], background, settings, advance=advance) for one in finalists]
        finalists = [
            replace(one, judgement=replace(one.judgement, search=own[name]))
            for one, own in zip(finalists, found, strict=True)
        ]
    return min(finalists, key=_merit)


def _min_alike(shapes: Sequence[Shape], background: Background | None) -> list[Shape]:
    """Those that look least like themselves turned or mirrored, and like the background."""
    squares = [picture_of(shape, GLANCE_PX) for shape in shapes]
    places = joined([]) if background is None else background.places
    theirs = background_correlation(np.stack([turned_rows(square) for square in squares]), places)
    worst = np.maximum([own_correlation(square) for square in squares], theirs)
    return [shapes[int(k)] for k in np.argsort(worst, kind="stable")[:SCORED]]


def _scored(
    shape: Shape, background: Background | None, settings: ScoreSettings, *, side_mm: float, name: str
) -> Design:
    model = MarkerModel.from_image(picture_of(shape, MODEL_PX), side_mm=side_mm, name=name)
    return Design(shape=shape, model=model, judgement=without_search(model, background, settings))


def _merit(one: Design) -> tuple[bool, float]:
    """Sorts what nothing imitates first, then the least false score."""
    return not one.judgement.unique, one.judgement.best_false_score_ratio
