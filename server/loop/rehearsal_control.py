"""Control of the rehearsal: the played scene, and the ground truth of an image."""

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

from server.capture.rehearsal import PlayedScene
from server.config import RehearsalConfig
from server.loop.staging import SceneOrder
from server.theatre import theatre_from_config

if TYPE_CHECKING:
    from tracker.rehearsal import Theatre, Truth


class RehearsalControl:
    """Orders scenes, and computes the ground truth of an image from its number. Thread-safe.

    Args:
        settings: the first scene.
        play: sends an order to the tracking process.
        played_scene: returns the played scene, as last reported.
    """

    def __init__(
        self,
        settings: RehearsalConfig,
        *,
        play: Callable[[SceneOrder], None],
        played_scene: Callable[[], PlayedScene | None],
    ) -> None:
        self._settings = settings
        self._play = play
        self._played_scene = played_scene
        self._number = 0
        self._lock = threading.Lock()
        self._theatre: Theatre | None = None

    @property
    def settings(self) -> RehearsalConfig:
        """The settings ordered last."""
        return self._settings

    @property
    def first_number(self) -> int | None:
        """Number of the first image of the ordered scene; None while it has not started."""
        played_scene = self._played_scene()
        return (
            None
            if played_scene is None or played_scene.scene_number != self._number
            else played_scene.first_number
        )

    @property
    def theatre(self) -> "Theatre":
        """Ground truth of the ordered scene."""
        with self._lock:
            if self._theatre is None:
                self._theatre = theatre_from_config(self._settings)
            return self._theatre

    def play(self, settings: RehearsalConfig) -> None:
        """Play this scene from its beginning, as soon as it is ready.

        Raises:
            InvalidInput: REHEARSAL_SETTING_INVALID.
        """
        theatre = theatre_from_config(settings)
        with self._lock:
            self._number += 1
            self._settings, self._theatre = settings, theatre
            self._play(SceneOrder(number=self._number, rehearsal=settings))

    def truth_of(self, image_number: int) -> "Truth | None":
        """Return the ground truth of an image; None for one from before the scene started."""
        first = self.first_number
        if first is None or image_number < first:
            return None
        return self.theatre.truth_at((image_number - first) / self._settings.rate_hz)
