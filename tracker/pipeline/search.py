"""The search of one image, round after round of candidates at rising cost."""

from collections.abc import Callable, Sequence

from tracker.marker import Candidate, MarkerModel, Templates, candidate_rounds, thorough_rounds
from tracker.pipeline.fitter import Fitter, is_certain
from tracker.pose import Pixels, Seen, Sighting, Unseen, UnseenReason, worth_of


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

    def go_on(self) -> bool:
        """Make a part of it: a round's candidates, or a look at those of one model; False at the end."""
        if not self._waiting:
            candidates = next(self._rounds, None)
            self._fitter.stages.end("candidates")
            self._waiting = [pair for pair in zip(self._models, candidates or [], strict=False) if pair[1]]
            return candidates is not None
        model, own = self._waiting.pop(0)
        if not is_certain(self.best[model.name]):
            found = self._fitter.best_of(self._pixels, model, own)
            self.best[model.name] = max(self.best[model.name], found, key=worth_of)
        return True

    def to_the_end(self, *, thorough: bool = False) -> dict[str, Sighting]:
        """Make the rest of it, as long as it can find something better; what it says of each marker.

        `thorough`: whether what is not seen is looked for once more, at far more cost.
        """
        self._go_on_until(is_certain)
        unseen = [k for k, model in enumerate(self._models) if not _is_seen(self.best[model.name])]
        if thorough and unseen:
            self._models = [self._models[k] for k in unseen]
            self._rounds = thorough_rounds(self._pixels.image, self._templates[unseen])
            self._go_on_until(_is_seen)
        return self.best

    def _go_on_until(self, enough: Callable[[Sighting], bool]) -> None:
        while self.go_on():
            if all(enough(self.best[model.name]) for model in self._models):
                break
        self._waiting = []


def _is_seen(sighting: Sighting) -> bool:
    return isinstance(sighting, Seen)
