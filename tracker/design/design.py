"""Selection among proposed shapes: first by correlation, then by score and precision, then by tracker search.

The correlation with all squares of a background is one matrix product for hundreds of shapes. The tracker
searches only for the last twelve, so that the reported score is that of the tracker. The result is the best
of the proposals and not an optimum; it depends on the seed.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tracker.design.assessment import MarkerAssessment, assess_without_search
from tracker.design.background import Advance, Background, search_background
from tracker.design.correlation import background_correlation, own_correlation, rotated_rows
from tracker.design.places import concatenated
from tracker.design.shape import Shape, rendered_face
from tracker.marker import MarkerModel, ScoreSettings

COARSE_PX, MODEL_PX = 100, 800
MAX_SCORED, MAX_SEARCHED = 40, 12


@dataclass(frozen=True, slots=True, kw_only=True)
class Design:
    """A proposed marker with its assessment.

    Attributes:
        shape: the printed face.
        model: the tracker's model of it.
        assessment: its figures.
    """

    shape: Shape
    model: MarkerModel
    assessment: MarkerAssessment


def best_design(
    shapes: Sequence[Shape],
    background: Background | None,
    settings: ScoreSettings,
    *,
    side_mm: float,
    name: str,
    advance: Advance,
) -> Design:
    """Return the unique shape whose edges determine the pose best and whose false score is lowest.

    Selects 40 by correlation, of these the unique ones, of those the more precise half, and by score at most
    12, which the tracker searches for in every image. `advance` is called after each background image.
    """
    scored = [
        _scored(shape, background, settings, side_mm=side_mm, name=name)
        for shape in _with_lowest_correlation(shapes, background)
    ]
    unique = [one for one in scored if one.assessment.unique] or scored
    precise = sorted(unique, key=lambda one: one.assessment.precision.tilt_sd_deg)[: -(-len(unique) // 2)]
    finalists = sorted(precise, key=_merit)[:MAX_SEARCHED]
    if background is not None:
        found = [search_background([one.model], background, settings, advance=advance) for one in finalists]
        finalists = [
            replace(one, assessment=replace(one.assessment, search=own[name]))
            for one, own in zip(finalists, found, strict=True)
        ]
    return min(finalists, key=_merit)


def _with_lowest_correlation(shapes: Sequence[Shape], background: Background | None) -> list[Shape]:
    """Return the shapes with the lowest correlation to their rotations, mirror image and background."""
    squares = [rendered_face(shape, COARSE_PX) for shape in shapes]
    places = concatenated([]) if background is None else background.places
    theirs = background_correlation(np.stack([rotated_rows(square) for square in squares]), places)
    worst = np.maximum([own_correlation(square) for square in squares], theirs)
    return [shapes[int(k)] for k in np.argsort(worst, kind="stable")[:MAX_SCORED]]


def _scored(
    shape: Shape, background: Background | None, settings: ScoreSettings, *, side_mm: float, name: str
) -> Design:
    model = MarkerModel.from_image(rendered_face(shape, MODEL_PX), side_mm=side_mm, name=name)
    return Design(shape=shape, model=model, assessment=assess_without_search(model, background, settings))


def _merit(one: Design) -> tuple[bool, float]:
    """Return the sort key: unique markers first, then the lowest false score."""
    return not one.assessment.unique, one.assessment.best_false_score_ratio
