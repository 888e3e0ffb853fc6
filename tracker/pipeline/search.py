"""Search of one image in rounds of candidates of increasing cost.

If the search of a single image finds nothing, a second search ranks five hundred quads by local NCC
(`thorough_rounds`). Under shadow, highlight, motion blur and noise together the true quad ranks below the
hundredth by every other score, and first in two of three images by this one. More quads are fitted, because
no score is reliable there. The second search is omitted if one marker was found with certainty, since the
illumination is then not poor, and in `Tracker.step`, where another image follows. It triples the time of a
search that finds nothing.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from tracker.marker import Candidate, MarkerModel, Templates, candidate_rounds, thorough_rounds
from tracker.pipeline.fitter import MAX_FITS, MAX_THOROUGH_FITS, Fitter, is_certain
from tracker.pose import (
    ImageContext,
    Seen,
    Sighting,
    Unseen,
    UnseenReason,
    Window,
    differ_by_rotation,
    rank_score,
)


class Search:
    """A search of one image, or of a window of it, for some markers. Mutable.

    Attributes:
        best: the best sighting of each marker so far, by name.
    """

    def __init__(
        self,
        pixels: ImageContext,
        models: Sequence[MarkerModel],
        templates: Templates,
        *,
        fitter: Fitter,
        window: Window | None = None,
    ) -> None:
        self.best: dict[str, Sighting] = {
            model.name: Unseen(reason=UnseenReason.NO_CANDIDATE) for model in models
        }
        self._pixels, self._models, self._templates = pixels, models, templates
        self._fitter = fitter
        self._image, self._corner_px = pixels.image, np.zeros(2)
        if window is not None:
            left, top, right, bottom = window
            self._image = np.ascontiguousarray(pixels.image[top:bottom, left:right])
            self._corner_px = np.array([left, top], dtype=np.float64)
        # Names of markers in the image whose rotation about the normal is ambiguous.
        self._undecided: set[str] = set()
        # Maximum number of fitted candidates per model and round.
        self._max_fits = MAX_FITS

    def _take(self, name: str, found: Sighting) -> None:
        """Store the better sighting, or `Unseen` where both differ by a rotation and neither is certain."""
        best, worse = sorted((self.best[name], found), key=rank_score, reverse=True)
        if differ_by_rotation(best, worse) and not is_certain(best):
            self._undecided.add(name)
            score = max(one.score_ratio for one in (best, worse) if isinstance(one, Seen))
            best = Unseen(reason=UnseenReason.SHAPE_DIFFERS, best_score_ratio=score)
        self.best[name] = best

    def _is_over(self, model: MarkerModel, enough: Callable[[Sighting], bool]) -> bool:
        """Return whether the search for this model is complete."""
        return model.name in self._undecided or enough(self.best[model.name])

    def run(self, *, thorough: bool = False) -> dict[str, Sighting]:
        """Search while that can improve the result; return the best sighting of each marker.

        `thorough`: search again for unseen markers at far higher cost, unless another marker was found with
        certainty, since the illumination is then not poor.
        """
        self._search_until(is_certain, candidate_rounds(self._image, self._templates))
        unseen = [k for k, model in enumerate(self._models) if not self._is_over(model, _is_seen)]
        if thorough and unseen and not any(is_certain(one) for one in self.best.values()):
            self._models, self._max_fits = [self._models[k] for k in unseen], MAX_THOROUGH_FITS
            self._search_until(_is_seen, thorough_rounds(self._image, self._templates[unseen]))
        return self.best

    def _search_until(
        self, enough: Callable[[Sighting], bool], rounds: Iterator[list[list[Candidate]]]
    ) -> None:
        """Fit the candidates of each round, until the best sighting of each marker is good enough."""
        for candidates in rounds:
            self._fitter.stages.end("candidates")
            for model, own in zip(self._models, candidates, strict=True):
                if own and not self._is_over(model, is_certain):
                    self._fit(model, own)
                if all(self._is_over(one, enough) for one in self._models):
                    return
        self._fitter.stages.end("candidates")

    def _fit(self, model: MarkerModel, candidates: Sequence[Candidate]) -> None:
        """Fit candidates in px of the window; a certain sighting ends the search for this model."""
        own = [replace(one, corners_px=one.corners_px + self._corner_px) for one in candidates]
        for found in self._fitter.fit_candidates(self._pixels, model, own, maximum=self._max_fits):
            self._take(model.name, found)
            if self._is_over(model, is_certain):
                return


def _is_seen(sighting: Sighting) -> bool:
    return isinstance(sighting, Seen)
