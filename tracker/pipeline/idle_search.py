"""Incremental search for markers out of view while others are tracked, at a part of a search's cost.

One image is searched in parts over several steps. If a marker is found in it, the current image is searched
completely.

A part runs in two of five images; an occluded marker may take up to a second to be found again. Lost markers,
and all markers when none is in view, are searched for at once.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from tracker.marker import MarkerModel
from tracker.pipeline.search import Search
from tracker.pose import ImageContext, Seen, Sighting, Unseen, UnseenReason

# Number of images with a part of a search, of how many: most images cost no more than tracking.
SEARCHED_IMAGES, OF_IMAGES = 2, 5


class IdleSearch:
    """Searches for markers out of view over several images. Mutable.

    `begin` returns a new search of an image for some markers.
    """

    def __init__(self, begin: Callable[[ImageContext, Sequence[MarkerModel]], Search]) -> None:
        self._begin = begin
        # The search of an image that may be some images old, and the number of images since it began.
        self._search: Search | None = None
        self._images = 0
        # The result of the last complete search for each marker that it did not find.
        self._unseen: dict[str, Unseen] = {}

    def record(self, sightings: Mapping[str, Sighting]) -> None:
        """Record the result of a complete search."""
        self._unseen.update({name: one for name, one in sightings.items() if isinstance(one, Unseen)})

    def step(self, pixels: ImageContext, models: Sequence[MarkerModel]) -> dict[str, Sighting]:
        """Advance the search; return a sighting of each of these markers, which are out of view."""
        if not models:
            self._search = None
            return {}
        if self._search is None or list(self._search.best) != [model.name for model in models]:
            # Copy, because the caller may write the next image into the same buffer.
            self._search = self._begin(replace(pixels, image=pixels.image.copy()), models)
            self._images = 0
        search = self._search
        is_turn = SEARCHED_IMAGES * self._images % OF_IMAGES < SEARCHED_IMAGES
        self._images += 1
        is_over = is_turn and not search.advance()
        if is_over:
            self.record(search.best)
        nothing = Unseen(reason=UnseenReason.NO_CANDIDATE)
        # The last known reason; the score is left out, because it belongs to another image.
        sightings: dict[str, Sighting] = {
            model.name: replace(self._unseen.get(model.name, nothing), best_score_ratio=None)
            for model in models
        }
        found = [model for model in models if isinstance(search.best[model.name], Seen)]
        if found:
            sightings |= self._begin(pixels, found).run()
        if is_over or found:
            self._search = None
        return sightings
