"""The rehearsal as the server knows it: what is played, and what is true of an image."""

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

from server.capture.rehearsal import Begun
from server.config import RehearsalConfig
from server.loop.staging import SceneOrder
from server.theatre import theatre_of

if TYPE_CHECKING:
    from tracker.rehearsal import Theatre, Truth


class Rehearsed:
    """Orders scenes, and works out the truth of an image from its number. From any thread.

    Args:
        settings: what is played first.
        play: hands an order to the tracking process.
        begun: what that process plays, as last reported.
    """

    def __init__(
        self,
        settings: RehearsalConfig,
        *,
        play: Callable[[SceneOrder], None],
        begun: Callable[[], Begun | None],
    ) -> None:
        self._settings = settings
        self._play = play
        self._begun = begun
        self._number = 0
        self._lock = threading.Lock()
        self._theatre: Theatre | None = None

    @property
    def settings(self) -> RehearsalConfig:
        """What was ordered last."""
        return self._settings

    @property
    def first_number(self) -> int | None:
        """Of the image that showed the beginning of what was ordered last; None while it has not begun."""
        begun = self._begun()
        return None if begun is None or begun.scene_number != self._number else begun.first_number

    @property
    def theatre(self) -> "Theatre":
        """Its truth."""
        with self._lock:
            if self._theatre is None:
                self._theatre = theatre_of(self._settings)
            return self._theatre

    def play(self, settings: RehearsalConfig) -> None:
        """Play this scene, from its beginning, as soon as it is ready.

        Raises:
            InvalidInput: REHEARSAL_SETTING_INVALID.
        """
        theatre = theatre_of(settings)
        with self._lock:
            self._number += 1
            self._settings, self._theatre = settings, theatre
            self._play(SceneOrder(number=self._number, rehearsal=settings))

    def truth_of(self, image_number: int) -> "Truth | None":
        """What is true of this image; None for one from before the scene began."""
        first = self.first_number
        if first is None or image_number < first:
            return None
        return self.theatre.truth_at((image_number - first) / self._settings.rate_hz)
