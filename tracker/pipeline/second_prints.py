"""Second prints: two indistinguishable squares of the same shape in view.

Tracking only examines the region around the predicted pose. One image in 32 is therefore searched at half
size for dark regions with four sides, which finds an unoccluded second print. One in 256 is searched
thoroughly, also from single corners and at full size, which finds a partly occluded or small print and takes
as long as several steps. The image in which a marker comes into view is also searched thoroughly, because
there one print may be mistaken for another; a tracked marker cannot change to another print.

While two prints are in view, and until one was alone for a second, the marker has no pose. Meanwhile the
second print is tracked, and more images are searched.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import NamedTuple

import numpy as np

from tracker.marker import Candidate, MarkerModel, Templates, second_print_candidates
from tracker.pipeline.fitter import MAX_FITS, Fitter
from tracker.pipeline.idle_search import matches_no_better
from tracker.pose import ImageContext, Prior, Seen, Sighting, Unseen, UnseenReason, is_same_square

# Period of the searches and of the thorough searches in images, while the marker is alone, and of the
# searches during and shortly after the presence of a second print.
PERIOD_IMAGES, THOROUGH_PERIOD_IMAGES, TWICE_PERIOD_IMAGES = 32, 256, 8
# A marker has a pose again after it was alone for this time and this number of images.
MIN_ALONE_S, MIN_ALONE_IMAGES = 1.0, 16
# A rejected candidate at the same position is fitted again after this number of images.
REFIT_IMAGES = 128


class _Rejection(NamedTuple):
    """A candidate of a model that was fitted and is no second print."""

    name: str
    image_number: int
    candidate: Candidate


@dataclass(slots=True)
class _SecondPrint:
    """The second print of a marker; time and number are those of the last image in which both were seen."""

    seen_at_s: float
    image_number: int
    prior: Prior = field(default_factory=Prior)


class SecondPrints:
    """Withholds the pose of a marker while two prints of it are in view. Mutable.

    Args:
        fitter: fits the candidates.
        templates_of: returns the templates of some models.
    """

    def __init__(self, fitter: Fitter, templates_of: Callable[[Sequence[MarkerModel]], Templates]) -> None:
        self._fitter, self._templates_of = fitter, templates_of
        self._image_number = 0
        self._twice: dict[str, _SecondPrint] = {}
        self._rejections: list[_Rejection] = []
        # Names of the markers that were seen in the last image.
        self._seen: set[str] = set()

    def withhold_duplicates(
        self,
        pixels: ImageContext,
        models: Sequence[MarkerModel],
        sightings: Mapping[str, Sighting],
        at_s: float,
        *,
        full_search: bool,
    ) -> dict[str, Sighting]:
        """Return the sightings of an image, with markers of which two are in view as `MARKER_TWICE`.

        Args:
            pixels: the image.
            models: all models.
            sightings: the sighting of each model in this image, by name.
            at_s: capture time.
            full_search: whether to search this image thoroughly, at any cost.
        """
        self._image_number += 1
        self._forget(at_s)
        tracked = {model.name for model in models if self._is_tracked(pixels, model, sightings, at_s)}
        due = [
            model for model in models if isinstance(sightings[model.name], Seen) and model.name not in tracked
        ]
        thorough = full_search or self._is_thorough_due(due)
        if due and (thorough or self._image_number % PERIOD_IMAGES == 0):
            for name, second in self._found(pixels, due, sightings, thorough=thorough):
                self._twice[name] = _SecondPrint(at_s, self._image_number)
                self._twice[name].prior.update(second, at_s)
                tracked.add(name)
        self._seen = {name for name, one in sightings.items() if isinstance(one, Seen)}
        return {
            name: _twice_in_view(one)
            if name in self._twice and (isinstance(one, Seen) or name in tracked)
            else one
            for name, one in sightings.items()
        }

    def _forget(self, at_s: float) -> None:
        """Remove second prints that have been absent for long enough, and old rejections."""
        self._twice = {
            name: one
            for name, one in self._twice.items()
            if at_s > one.seen_at_s
            and (
                at_s - one.seen_at_s < MIN_ALONE_S
                or self._image_number - one.image_number <= MIN_ALONE_IMAGES
            )
        }
        self._rejections = [
            one for one in self._rejections if self._image_number - one.image_number < REFIT_IMAGES
        ]

    def _is_tracked(
        self, pixels: ImageContext, model: MarkerModel, sightings: Mapping[str, Sighting], at_s: float
    ) -> bool:
        """Return whether the second print of this model is seen again at its predicted pose."""
        twice = self._twice.get(model.name)
        expected = None if twice is None else twice.prior.predict(at_s)
        if twice is None or expected is None:
            return False
        second = self._fitter.near(pixels, model, expected, found_by="track")
        if not isinstance(second, Seen) or _is_on_any(second, sightings):
            twice.prior = Prior()
            return False
        twice.prior.update(second, at_s)
        if isinstance(sightings[model.name], Seen):
            twice.seen_at_s, twice.image_number = at_s, self._image_number
        return True

    def _is_thorough_due(self, due: Sequence[MarkerModel]) -> bool:
        """Return whether the thorough search is due in this image, or a marker comes into view."""
        is_twice = any(model.name in self._twice for model in due)
        period = TWICE_PERIOD_IMAGES if is_twice else THOROUGH_PERIOD_IMAGES
        return self._image_number % period == 0 or any(model.name not in self._seen for model in due)

    def _found(
        self,
        pixels: ImageContext,
        models: Sequence[MarkerModel],
        sightings: Mapping[str, Sighting],
        *,
        thorough: bool,
    ) -> Iterator[tuple[str, Seen]]:
        """Yield the second prints of these models that a search of this image finds."""
        candidates = second_print_candidates(
            pixels.image,
            self._templates_of(models),
            seen_px=np.array([one.corners_px for one in sightings.values() if isinstance(one, Seen)]),
            thorough=thorough,
        )
        self._fitter.stages.end("candidates")
        for model, own in zip(models, candidates, strict=True):
            rejected = [one.candidate for one in self._rejections if one.name == model.name]
            fresh = (one for one in own if not matches_no_better(one, rejected))
            for candidate in islice(fresh, MAX_FITS if thorough else 1):
                second = next(self._fitter.fit_candidates(pixels, model, [candidate], maximum=1), None)
                if isinstance(second, Seen) and not _is_on_any(second, sightings):
                    yield model.name, second
                    break
                self._rejections.append(_Rejection(model.name, self._image_number, candidate))


def _is_on_any(second: Seen, sightings: Mapping[str, Sighting]) -> bool:
    """Return whether a sighting lies on a marker that is seen."""
    return any(isinstance(one, Seen) and is_same_square(one, second) for one in sightings.values())


def _twice_in_view(sighting: Sighting) -> Unseen:
    score = sighting.score_ratio if isinstance(sighting, Seen) else sighting.best_score_ratio
    return Unseen(reason=UnseenReason.MARKER_TWICE, best_score_ratio=score)
