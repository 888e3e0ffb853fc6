"""Scene of the rehearsal in the tracking process, and its replacement by another one.

The next scene is prepared while the present one is played, in the same process, so that a whole procedure is
rehearsed with one camera, patient and store. The static background is rendered once for all scenes. The
ground truth of an image follows from its number and the first number of its scene. On a busy machine a scene
takes seconds to appear.
"""

import threading
from dataclasses import dataclass
from typing import TYPE_CHECKING

import structlog

from server.capture.rehearsal import PlayedScene, RehearsalSource
from server.config import RehearsalConfig
from server.priority import lower_thread_priority
from server.theatre import theatre_from_config

if TYPE_CHECKING:
    from tracker.rehearsal import Renderer
    from tracker.rehearsal.backdrop import StillStore
    from tracker.rehearsal.board_renderer import BoardRenderer

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneOrder:
    """An ordered scene.

    Attributes:
        number: number of the order in this run of the server, from 1.
        rehearsal: settings with the new scene, skill, board and events.
        first_number: number of its first image; None while it has not started.
    """

    number: int
    rehearsal: RehearsalConfig
    first_number: int | None = None

    def played_scene(self, next_number: int) -> PlayedScene:
        """Return the scene as a new process plays it: continued, or started with `next_number`."""
        first = next_number if self.first_number is None else self.first_number
        return PlayedScene(scene_number=self.number, first_number=first)


class Staging:
    """Prepares the next scene in a thread, while the present one is played.

    Args:
        source: the source that plays the scenes.
        renderer: its present renderer, whose static background is reused.
        store: stores the background over restarts; None without one.
    """

    def __init__(
        self,
        source: RehearsalSource,
        renderer: "Renderer | BoardRenderer",
        store: "StillStore | None" = None,
    ) -> None:
        self._source = source
        self._renderer = renderer
        self._store = store
        self._lock = threading.Lock()
        self._ordered: SceneOrder | None = None
        self._working = False

    @property
    def played_scene(self) -> PlayedScene:
        """The played scene."""
        return self._source.played_scene

    def order(self, order: SceneOrder) -> None:
        """Play this scene as soon as it is ready; the newest order wins."""
        with self._lock:
            self._ordered = order
            if self._working:
                return
            self._working = True
        threading.Thread(target=self._work, name="staging", daemon=True).start()

    def _work(self) -> None:
        lower_thread_priority()
        while True:
            with self._lock:
                order, self._ordered = self._ordered, None
                if order is None:
                    self._working = False
                    return
            try:
                self._play(order)
            except Exception:
                # The present scene continues; if this thread ended, no other scene could be prepared.
                log.exception("a scene of the rehearsal could not be prepared")

    def _play(self, order: SceneOrder) -> None:
        theatre = theatre_from_config(order.rehearsal)
        renderer = theatre.renderer(after=self._renderer, store=self._store)
        renderer.prepare()
        self._renderer = renderer
        self._source.play(renderer, scene_number=order.number, outages=theatre.settings.events)
        log.info("scene of the rehearsal changed", scene=order.rehearsal.scene)
