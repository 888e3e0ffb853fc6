"""3-D scenes of recorded instants, beside the scene of the newest image."""

import asyncio
from itertools import count

from server.live import Instant, LiveHub, ProcessState, ProcessStatus, SourceState, SourceStatus
from server.procedure.scene_bone import read_surface
from server.recording.review import RecordedScene, RecordingReview
from server.scene import Admit, Cut, Scene
from server.store import CaseStore, NotFound
from tracker.plan import Surface

MAX_SCENES = 8
# A recorded instant is not replaced by newer ones, so it does not become stale.
STALE_AFTER_MS = 1e9

SOURCE = SourceStatus(name="recording", state=SourceState.RUNNING)
PROCESS = ProcessStatus(state=ProcessState.RUNNING)


class _ReviewScene:
    """One scene, with the instant that it shows."""

    def __init__(self, *, admit: Admit, cut: Cut | None) -> None:
        self.hub = LiveHub()
        self.scene = Scene(hub=self.hub, stale_after_ms=STALE_AFTER_MS, admit=admit, cut=cut)
        self.surface_id = ""
        self._sequences = count(1)

    def show(self, recorded: RecordedScene) -> None:
        instant = Instant(
            sequence=next(self._sequences), source=SOURCE, process=PROCESS, snapshot=recorded.snapshot
        )
        self.hub.publish(instant)


class ReviewScenes:
    """The scenes of all reviews. For one event loop, except for its constructor.

    The page of a review chooses a random key, under which it requests instants and shows the scene in a
    frame. Of more than `MAX_SCENES` the one that was used least recently is closed.
    """

    def __init__(
        self, review: RecordingReview, store: CaseStore, *, admit: Admit, cut: Cut | None = None
    ) -> None:
        self._review, self._store = review, store
        self._admit, self._cut = admit, cut
        self._scenes: dict[str, _ReviewScene] = {}

    async def show(self, key: str, name: str, number: int) -> int:
        """Show an image of a recording, `number` from 0; return the camera's number of the image.

        Raises the same errors as `RecordingReview.scene`.
        """
        recorded = await asyncio.to_thread(self._review.scene, name, number)
        one = await self._scene(key)
        if recorded.surface_id != one.surface_id:
            surface = await asyncio.to_thread(self._surface, recorded.surface_id)
            one.surface_id = recorded.surface_id
            one.scene.show_surface(surface)
        one.show(recorded)
        return recorded.snapshot.image_number

    def get(self, key: str) -> Scene | None:
        """Return a scene; None if there is none, or it was closed."""
        one = self._scenes.get(key)
        return None if one is None else one.scene

    async def stop(self) -> None:
        """Close all scenes."""
        while self._scenes:
            await self._scenes.pop(next(iter(self._scenes))).scene.stop()

    async def _scene(self, key: str) -> _ReviewScene:
        one = self._scenes.pop(key, None)
        if one is None:
            one = _ReviewScene(admit=self._admit, cut=self._cut)
            await one.scene.start()
        # The last one is the one that was used last.
        self._scenes[key] = one
        while len(self._scenes) > MAX_SCENES:
            await self._scenes.pop(next(iter(self._scenes))).scene.stop()
        return one

    def _surface(self, document_id: str) -> Surface | None:
        case = self._store.get_open_case()
        if not document_id or case is None:
            return None
        try:
            return read_surface(self._store, self._store.document(case.id, document_id))
        except NotFound:
            return None
