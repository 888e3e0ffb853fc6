"""What of the rehearsal is played in the tracking process, and how another scene takes its place.

The next scene is prepared beside the running one in the same process, so a whole procedure is rehearsed
with one camera, patient and store. Still scenery is rendered once for all scenes. The truth of an image
follows from its number and the first number of its scene. On a busy machine a scene takes seconds to
appear.
"""

import threading
from dataclasses import dataclass
from typing import TYPE_CHECKING

import structlog

from server.capture.rehearsal import Begun, RehearsalSource
from server.config import RehearsalConfig
from server.theatre import theatre_of

if TYPE_CHECKING:
    from tracker.rehearsal import Renderer
    from tracker.rehearsal.backdrop import StillStore
    from tracker.rehearsal.board_renderer import BoardRenderer

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneOrder:
    """A scene that shall be played.

    Attributes:
        number: counts such orders while the server runs, from 1.
        rehearsal: the settings, whose scene, skill, board and events are new.
        first_number: of the image that showed its beginning; None while it has not begun.
    """

    number: int
    rehearsal: RehearsalConfig
    first_number: int | None = None

    def begun(self, next_number: int) -> Begun:
        """Where a new process goes on with it, or begins it with the image of this number."""
        first = next_number if self.first_number is None else self.first_number
        return Begun(scene_number=self.number, first_number=first)


class Staging:
    """Makes the next scene ready in a thread, while the one before goes on.

    Args:
        source: what plays.
        renderer: that it plays with now; what stands still is kept for the next one.
        store: what keeps it over starts, if anything does.
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
    def begun(self) -> Begun:
        """What is played now."""
        return self._source.begun

    def order(self, order: SceneOrder) -> None:
        """Play this as soon as it is ready; newest wins."""
        with self._lock:
            self._ordered = order
            if self._working:
                return
            self._working = True
        threading.Thread(target=self._work, name="staging", daemon=True).start()

    def _work(self) -> None:
        while True:
            with self._lock:
                order, self._ordered = self._ordered, None
                if order is None:
                    self._working = False
                    return
            try:
                self._play(order)
            except Exception:
                # The scene before goes on; a thread that ends here would never make another one ready.
                log.exception("a scene of the rehearsal could not be made ready")

    def _play(self, order: SceneOrder) -> None:
        theatre = theatre_of(order.rehearsal)
        renderer = theatre.renderer(after=self._renderer, store=self._store)
        renderer.prepare()
        self._renderer = renderer
        self._source.play(renderer, scene_number=order.number, silences=theatre.settings.events)
        log.info("the rehearsal plays another scene", scene=order.rehearsal.scene)
