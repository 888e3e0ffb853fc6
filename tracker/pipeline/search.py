"""The search of one image, round after round of candidates at rising cost.

A search of a single image that finds nothing runs a second time over five hundred outlines ranked part by
part (`thorough_rounds`): in shadow, highlight, motion blur and noise together the true outline is past the
hundredth in every other ranking, and first in two of three images in this one. More outlines are fitted,
because no ranking is reliable there. It is skipped as soon as one marker was found with certainty, since
the light is then not poor, and in `Tracker.step`, where another image follows. A search that finds nothing
takes three times as long because of it.
"""

from collections.abc import Callable, Sequence

from tracker.marker import Candidate, MarkerModel, Templates, candidate_rounds, thorough_rounds
from tracker.pipeline.fitter import MAX_FITS, MAX_THOROUGH_FITS, Fitter, is_certain
from tracker.pose import Pixels, Seen, Sighting, Unseen, UnseenReason, are_turned, worth_of


class Search:
    """A search of one image for some markers, that can be made in parts. Mutable.

    Attributes:
        best: what was made of each marker until now, by name.
    """

    def __init__(
        self,
        pixels: Pixels,
        models: Sequence[MarkerModel],
        templates: Templates,
        *,
        fitter: Fitter,
    ) -> None:
        self.best: dict[str, Sighting] = {
            model.name: Unseen(reason=UnseenReason.NO_CANDIDATE) for model in models
        }
        self._pixels, self._models, self._templates = pixels, models, templates
        self._fitter = fitter
        self._rounds = candidate_rounds(pixels.image, templates)
        # Models whose candidates of this round have not been looked at.
        self._waiting: list[tuple[MarkerModel, list[Candidate]]] = []
        # Names of those that are in the image, and two ways up of which explain as much as the other.
        self._undecided: set[str] = set()
        # So many candidates of each model and round are fitted.
        self._max_fits = MAX_FITS

    def go_on(self) -> bool:
        """Make a part of it: a round's candidates, or a look at those of one model; False at the end."""
        if not self._waiting:
            candidates = next(self._rounds, None)
            self._fitter.stages.end("candidates")
            self._waiting = [pair for pair in zip(self._models, candidates or [], strict=False) if pair[1]]
            return candidates is not None
        model, own = self._waiting.pop(0)
        if not self._is_over(model, is_certain):
            for found in self._fitter.each_of(self._pixels, model, own, most=self._max_fits):
                self._take(model.name, found)
                # One that leaves nothing open ends it.
                if self._is_over(model, is_certain):
                    break
        return True

    def _take(self, name: str, found: Sighting) -> None:
        """Keep the better one; none, where what was found says that the marker is another way up."""
        best, worse = sorted((self.best[name], found), key=worth_of, reverse=True)
        if are_turned(best, worse) and not is_certain(best):
            self._undecided.add(name)
            score = max(one.score_ratio for one in (best, worse) if isinstance(one, Seen))
            best = Unseen(reason=UnseenReason.SHAPE_DIFFERS, best_score_ratio=score)
        self.best[name] = best

    def _is_over(self, model: MarkerModel, enough: Callable[[Sighting], bool]) -> bool:
        """Whether nothing more need be looked for, or would help."""
        return model.name in self._undecided or enough(self.best[model.name])

    def to_the_end(self, *, thorough: bool = False) -> dict[str, Sighting]:
        """Make the rest of it, as long as it can find something better; what it says of each marker.

        `thorough`: whether what is not seen is looked for once more, at far more cost, where the light may be
        poor: it is not where another marker was found for certain.
        """
        self._go_on_until(is_certain)
        unseen = [k for k, model in enumerate(self._models) if not self._is_over(model, _is_seen)]
        if thorough and unseen and not any(is_certain(one) for one in self.best.values()):
            self._models, self._max_fits = [self._models[k] for k in unseen], MAX_THOROUGH_FITS
            self._rounds = thorough_rounds(self._pixels.image, self._templates[unseen])
            self._go_on_until(_is_seen)
        return self.best

    def _go_on_until(self, enough: Callable[[Sighting], bool]) -> None:
        while self.go_on():
            if all(self._is_over(model, enough) for model in self._models):
                break
        self._waiting = []


def _is_seen(sighting: Sighting) -> bool:
    return isinstance(sighting, Seen)
