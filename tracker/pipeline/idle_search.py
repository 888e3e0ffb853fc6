"""Search for markers that are out of view, at a bounded cost per image.

A complete search of an image without a marker takes many times as long as a tracking step, and such images
are usual while the drill is put away. Each image therefore runs a part of the search: every second image the
dark regions with four sides, which find an unoccluded marker, and every fourth image one of the costly rounds
in turn. While another marker is tracked, costly rounds run less often. One candidate is fitted per image. A
candidate that was rejected at the same position some images ago, and does not correlate better now, is not
fitted again, so that a fixed background costs little.

A candidate found this way is confirmed only by a complete search of the same image, which also compares the
alternatives.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from tracker.marker import (
    COSTLY_ROUNDS,
    SAME_OUTLINE_SIDE_RATIO,
    Candidate,
    MarkerModel,
    Templates,
    costly_candidates,
    four_sided_candidates,
)
from tracker.pipeline.fitter import Fitter
from tracker.pose import ImageContext, Seen, Sighting, Unseen, UnseenReason, rank_score, side_px_of

# Period of the costly rounds in images, without and with another marker in view.
IDLE_PERIOD_IMAGES, TRACKING_PERIOD_IMAGES = 4, 8
# A rejected candidate at the same position is fitted again after this number of images, or when its
# correlation has increased by this amount, as that of a marker that comes to rest.
REFIT_IMAGES, MIN_GAIN = 10, 0.02
NO_CANDIDATE = Unseen(reason=UnseenReason.NO_CANDIDATE, best_score_ratio=None)


class _Rejection(NamedTuple):
    """A reason why a marker was not seen in an image.

    `candidate` was fitted; None after a complete search.
    """

    name: str
    image_number: int
    candidate: Candidate | None
    unseen: Unseen


class IdleSearch:
    """Searches images in parts for markers that are out of view. Mutable.

    Args:
        fitter: fits the candidates.
        templates_of: returns the templates of some models.
    """

    def __init__(self, fitter: Fitter, templates_of: Callable[[Sequence[MarkerModel]], Templates]) -> None:
        self._fitter, self._templates_of = fitter, templates_of
        self._image_number = self._costly_rounds = 0
        self._rejections: list[_Rejection] = []

    def seems_in_view(
        self, pixels: ImageContext, models: Sequence[MarkerModel], *, is_tracking: bool
    ) -> bool:
        """Search a part of this image; return whether one of these markers seems to be in it.

        Args:
            pixels: the image.
            models: of the markers that are out of view.
            is_tracking: whether another marker is in view, whose pose must not wait.
        """
        self._image_number += 1
        self._rejections = [
            one for one in self._rejections if self._image_number - one.image_number < REFIT_IMAGES
        ]
        candidates = self._candidates(pixels, models, is_tracking=is_tracking)
        self._fitter.stages.end("candidates")
        fresh = [
            (rank, -candidate.correlation, k)
            for k, own in enumerate(candidates)
            for rank, candidate in enumerate(own)
            if not self._is_rejected(models[k], candidate)
        ]
        if not fresh:
            return False
        # The first candidates of all models come before the second of any.
        rank, _, k = min(fresh)
        model, candidate = models[k], candidates[k][rank]
        sighting = next(self._fitter.fit_candidates(pixels, model, [candidate], maximum=1), NO_CANDIDATE)
        # Also record a detection: if a complete search does not confirm it, it must not be searched again at
        # once.
        unseen = NO_CANDIDATE if isinstance(sighting, Seen) else sighting
        self._rejections.append(_Rejection(model.name, self._image_number, candidate, unseen))
        return isinstance(sighting, Seen)

    def record(self, sightings: Mapping[str, Sighting]) -> None:
        """Record the result of a complete search of this image."""
        self._rejections += [
            _Rejection(name, self._image_number, None, one)
            for name, one in sightings.items()
            if isinstance(one, Unseen)
        ]

    def unseen(self, models: Sequence[MarkerModel]) -> dict[str, Sighting]:
        """Return each of these markers as `Unseen` with the reason of its best candidate in the last images.

        The score is None, because it may be that of another image.
        """
        return {
            model.name: replace(
                max(
                    (one.unseen for one in self._rejections if one.name == model.name),
                    key=rank_score,
                    default=NO_CANDIDATE,
                ),
                best_score_ratio=None,
            )
            for model in models
        }

    def _candidates(
        self, pixels: ImageContext, models: Sequence[MarkerModel], *, is_tracking: bool
    ) -> list[list[Candidate]]:
        """Return the candidates of each model in this image's part of the search."""
        if self._image_number % 2 == 1:
            return four_sided_candidates(pixels.image, self._templates_of(models))
        if self._image_number % (TRACKING_PERIOD_IMAGES if is_tracking else IDLE_PERIOD_IMAGES):
            return []
        index, self._costly_rounds = self._costly_rounds % COSTLY_ROUNDS, self._costly_rounds + 1
        return costly_candidates(pixels.image, self._templates_of(models), index=index)

    def _is_rejected(self, model: MarkerModel, candidate: Candidate) -> bool:
        """Return whether a candidate at this place that matched as well was fitted some images ago."""
        return matches_no_better(
            candidate,
            (
                one.candidate
                for one in self._rejections
                if one.name == model.name and one.candidate is not None
            ),
        )


def matches_no_better(candidate: Candidate, rejected: Iterable[Candidate]) -> bool:
    """Return whether one of the rejected candidates of its model has the same place and matched as well."""
    reach_px = SAME_OUTLINE_SIDE_RATIO * side_px_of(candidate.corners_px)
    return any(
        candidate.correlation < one.correlation + MIN_GAIN
        and float(np.abs(one.corners_px - candidate.corners_px).max()) < reach_px
        for one in rejected
    )
