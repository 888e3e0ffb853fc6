"""3-D scenes of recorded instants, beside the scene of the newest image."""

import asyncio
from itertools import count
from pathlib import Path

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
    """One scene, with the recording that it shows."""

    def __init__(self, recording: Path, *, admit: Admit, cut: Cut | None) -> None:
        self.recording = recording
        self.hub = LiveHub()
        self.scene = Scene(hub=self.hub, stale_after_ms=STALE_AFTER_MS, admit=admit, cut=cut)
        self.surface_id = ""
        self._sequences = count(1)

    def show(self, recorded: RecordedScene) -> None:
        self.recording = recorded.recording
        instant = Instant(
            sequence=next(self._sequences), source=SOURCE, process=PROCESS, snapshot=recorded.snapshot
        )
        self.hub.publish(instant)


class ReviewScenes:
    """The scenes of all reviews. For one event loop, except for its constructor.

    The page of a review chooses a random key, under which it requests instants and shows the scene in a
    frame. Of more than `MAX_SCENES` the one whose last request is oldest is closed, and all are closed when
    their case is.
    """

    def __init__(
        self, review: RecordingReview, store: CaseStore, *, admit: Admit, cut: Cut | None = None
    ) -> None:
        self._review, self._store = review, store
        self._admit, self._cut = admit, cut
        self._scenes: dict[str, _ReviewScene] = {}
        self._requests = count(1)
        self._newest: dict[str, int] = {}
        self._loop: asyncio.AbstractEventLoop | None = None
        self._closing: set[asyncio.Task[None]] = set()
        store.add_commit_listener(self._note_change)

    async def show(self, key: str, name: str, number: int) -> int:
        """Show an image of a recording, `number` from 0; return the camera's number of the image.

        If another image is requested meanwhile, this one is not drawn. Raises the same errors as
        `RecordingReview.scene`.
        """
        self._loop = asyncio.get_running_loop()
        request = self._newest[key] = next(self._requests)
        try:
            recorded = await asyncio.to_thread(self._review.scene, name, number)
            surface_id = recorded.surface_id
            before = self._scenes.get(key)
            surface = None
            if surface_id and (before is None or before.surface_id != surface_id):
                surface = await asyncio.to_thread(self._surface, surface_id)
            if self._newest.get(key) == request:
                one = await self._scene(key, recorded.recording)
                if one.surface_id != surface_id:
                    # One that could not be read is tried again with the next instant.
                    one.surface_id = "" if surface is None else surface_id
                    one.scene.show_surface(surface)
                one.show(recorded)
        finally:
            if self._newest.get(key) == request:
                self._newest.pop(key)
        return recorded.snapshot.image_number

    def get(self, key: str) -> Scene | None:
        """Return a scene; None if there is none, or it was closed."""
        one = self._scenes.get(key)
        return None if one is None or not self._is_of_open_case(one) else one.scene

    async def stop(self) -> None:
        """Close all scenes."""
        while self._scenes:
            await self._scenes.pop(next(iter(self._scenes))).scene.stop()

    async def _scene(self, key: str, recording: Path) -> _ReviewScene:
        one = self._scenes.pop(key, None)
        if one is None:
            one = _ReviewScene(recording, admit=self._admit, cut=self._cut)
            await one.scene.start()
        # The last one is the one that was requested last.
        self._scenes[key] = one
        while len(self._scenes) > MAX_SCENES:
            await self._scenes.pop(next(iter(self._scenes))).scene.stop()
        return one

    def _surface(self, document_id: str) -> Surface | None:
        case = self._store.get_open_case()
        if case is None:
            return None
        try:
            return read_surface(self._store, self._store.document(case.id, document_id))
        except NotFound:
            return None

    def _is_of_open_case(self, one: _ReviewScene) -> bool:
        case = self._store.get_open_case()
        # <cases>/<id>/recordings/<name>
        return case is not None and one.recording.parents[1].name == case.id and one.recording.exists()

    def _note_change(self) -> None:
        """Close the scenes of another case; called in the thread that changed the store."""
        if self._scenes and self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._close_others)

    def _close_others(self) -> None:
        for key in [key for key, one in self._scenes.items() if not self._is_of_open_case(one)]:
            task = asyncio.create_task(self._scenes.pop(key).scene.stop())
            self._closing.add(task)
            task.add_done_callback(self._closing.discard)
