"""The look-out for markers that are out of view while others are tracked, for a part of a search's cost.

An image is searched part after part while others pass. What is found in it has come into view: only then the
image at hand is searched as a whole.

This runs in two of five images; a covered marker may take up to a second to be found again. Lost markers,
and all markers when none is in view, are searched for at once.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from tracker.marker import MarkerModel
from tracker.pipeline.search import Search
from tracker.pose import Pixels, Seen, Sighting, Unseen, UnseenReason

# A part of a search is made in so many of so many images: most cost no more than what is in view.
SEARCHED_IMAGES, OF_IMAGES = 2, 5


class LookOut:
    """Looks out for markers from image to image. Mutable.

    `begin` makes a search of an image for some markers.
    """

    def __init__(self, begin: Callable[[Pixels, Sequence[MarkerModel]], Search]) -> None:
        self._begin = begin
        # A search of an image that may be some images old, and how many have passed since it began.
        self._search: Search | None = None
        self._images = 0
        # What the last whole search said of each marker that it did not find.
        self._unseen: dict[str, Unseen] = {}

    def hear(self, said: Mapping[str, Sighting]) -> None:
        """Take in what a whole search said."""
        self._unseen.update({name: one for name, one in said.items() if isinstance(one, Unseen)})

    def look(self, pixels: Pixels, models: Sequence[MarkerModel]) -> dict[str, Sighting]:
        """What can be said of these markers, which are not expected in this image."""
        if not models:
            self._search = None
            return {}
        if self._search is None or list(self._search.best) != [model.name for model in models]:
            # The caller may write the next image into the same memory.
            self._search = self._begin(replace(pixels, image=pixels.image.copy()), models)
            self._images = 0
        search = self._search
        is_turn = SEARCHED_IMAGES * self._images % OF_IMAGES < SEARCHED_IMAGES
        self._images += 1
        is_over = is_turn and not search.go_on()
        if is_over:
            self.hear(search.best)
        nothing = Unseen(reason=UnseenReason.NO_CANDIDATE)
        # The reason is the last one that is known; a score would be another image's.
        said: dict[str, Sighting] = {
            model.name: replace(self._unseen.get(model.name, nothing), best_score_ratio=None)
            for model in models
        }
        found = [model for model in models if isinstance(search.best[model.name], Seen)]
        if found:
            said |= self._begin(pixels, found).to_the_end()
        if is_over or found:
            self._search = None
        return said
