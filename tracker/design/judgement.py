"""Everything that is measured of one marker: what imitates it, and how well it tells its pose."""

from dataclasses import dataclass, replace

from tracker.design.background import Advance, Background, Searched, searched
from tracker.design.correlation import own_correlation
from tracker.design.false_score import FalseScore, ImitatingPlace, imitating_places, own_false_scores
from tracker.design.precision import Precision, precision_of
from tracker.marker import MarkerModel, ScoreSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class Judgement:
    """A marker's figures.

    Attributes:
        turned: the best score of its edges over its own quarter turns, 27 px wide.
        mirrored: the same over its mirror image at all turns.
        own_correlation: the best correlation with any of those, -1..1.
        nearest: the places of the background that come closest, the closest first; empty without one.
        search: what the tracker's search says in the images of the background.
        images: how many images those are; 0 where no background was given.
        precision: how well its edges tell its pose.
    """

    turned: FalseScore
    mirrored: FalseScore
    own_correlation: float
    nearest: tuple[ImitatingPlace, ...]
    search: Searched
    images: int
    precision: Precision

    @property
    def best_false_score_ratio(self) -> float:
        """The figure of merit, less is better: the best score anywhere that the marker is not, 0..1."""
        return max(
            self.turned.score_ratio,
            self.mirrored.score_ratio,
            *(place.score.score_ratio for place in self.nearest[:1]),
            self.search.best_score_ratio,
        )

    @property
    def unique(self) -> bool:
        """Whether nothing reaches acceptance: itself turned or mirrored, or anything in the background."""
        return not (
            self.search.claims
            or self.turned.accepted
            or self.mirrored.accepted
            or any(place.score.accepted for place in self.nearest)
        )


NOT_SEARCHED = Searched(best_score_ratio=0.0, claims=())


def judgement_of(
    model: MarkerModel, background: Background | None, settings: ScoreSettings, *, advance: Advance
) -> Judgement:
    """The figures of a marker; `advance` is called after each image of the background."""
    if background is None:
        return without_search(model, None, settings)
    found = searched([model], background, settings, advance=advance)[model.name]
    return replace(without_search(model, background, settings), search=found)


def without_search(model: MarkerModel, background: Background | None, settings: ScoreSettings) -> Judgement:
    """The figures that need no search of whole images: a tenth of a second."""
    turned, mirrored = own_false_scores(model, settings)
    nearest: list[ImitatingPlace] = []
    if background is not None:
        nearest = imitating_places(background.images, background.places, model, settings)
    return Judgement(
        turned=turned,
        mirrored=mirrored,
        own_correlation=own_correlation(model.square),
        nearest=tuple(nearest),
        search=NOT_SEARCHED,
        images=0 if background is None else len(background.images),
        precision=precision_of(model),
    )
