"""Assessment of one marker: uniqueness against rotations, mirror image and background, and pose precision."""

from dataclasses import dataclass, replace

from tracker.design.background import Advance, Background, SearchResult, search_background
from tracker.design.correlation import own_correlation
from tracker.design.false_score import Distractor, FalseScore, distractors_of, own_false_scores
from tracker.design.precision import Precision, precision_of
from tracker.marker import MarkerModel, ScoreSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class MarkerAssessment:
    """Uniqueness and precision of a marker.

    Attributes:
        rotated: the best score of its edges on its own rotations by multiples of 90 degrees, at 27 px.
        mirrored: the same on its mirror image at all rotations.
        own_correlation: the best correlation with any of those, -1..1.
        nearest: the background squares with the highest scores, best first; empty without a background.
        search: result of the tracker's search in the background images.
        images: number of background images; 0 without a background.
        precision: Cramer-Rao bound of its pose.
    """

    rotated: FalseScore
    mirrored: FalseScore
    own_correlation: float
    nearest: tuple[Distractor, ...]
    search: SearchResult
    images: int
    precision: Precision

    @property
    def best_false_score_ratio(self) -> float:
        """Return the maximum false score over all tests, 0..1; lower is better."""
        return max(
            self.rotated.score_ratio,
            self.mirrored.score_ratio,
            *(place.score.score_ratio for place in self.nearest[:1]),
            self.search.best_score_ratio,
        )

    @property
    def unique(self) -> bool:
        """Return whether no rotation, mirror image or background place reaches the acceptance thresholds."""
        return not (
            self.search.claims
            or self.rotated.accepted
            or self.mirrored.accepted
            or any(place.score.accepted for place in self.nearest)
        )


NO_SEARCH = SearchResult(best_score_ratio=0.0, claims=())


def assess_marker(
    model: MarkerModel, background: Background | None, settings: ScoreSettings, *, advance: Advance
) -> MarkerAssessment:
    """Return the assessment of a marker; `advance` is called after each background image."""
    if background is None:
        return assess_without_search(model, None, settings)
    found = search_background([model], background, settings, advance=advance)[model.name]
    return replace(assess_without_search(model, background, settings), search=found)


def assess_without_search(
    model: MarkerModel, background: Background | None, settings: ScoreSettings
) -> MarkerAssessment:
    """Return the assessment without the search of whole images; takes about 0.1 s."""
    rotated, mirrored = own_false_scores(model, settings)
    nearest: list[Distractor] = []
    if background is not None:
        nearest = distractors_of(background.images, background.places, model, settings)
    return MarkerAssessment(
        rotated=rotated,
        mirrored=mirrored,
        own_correlation=own_correlation(model.square),
        nearest=tuple(nearest),
        search=NO_SEARCH,
        images=0 if background is None else len(background.images),
        precision=precision_of(model),
    )
