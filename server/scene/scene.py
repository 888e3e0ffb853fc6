"""The scene in the application: routes, update task and viewers."""

import asyncio
import contextlib
import time
from collections.abc import Callable, MutableMapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import cache
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

import structlog
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response
from starlette.routing import BaseRoute, Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from server.live import Instant, LiveHub
from server.scene.gate import SUBPROTOCOL, Gate, Verdict
from server.security import Person, person_of
from server.security.hosts import is_same_origin
from tracker.errors import NavigationError
from tracker.navigation import Setup
from tracker.plan import Surface

if TYPE_CHECKING:
    from server.scene.door import Door
    from server.scene.marks import Mark
    from server.scene.page import Page
    from server.scene.stage import Stage

# A viewer to which nothing can be sent for 2 s is disconnected; a slow connection gets more time per message.
SEND_TIMEOUT_S = 2.0
THINNEST_LINE_BYTES_PER_S = 50_000
# Above the rate of any camera; a pause of a full period would miss images of a camera at 60 Hz.
MIN_INTERVAL_S = 1 / 100
# The scene sends a message at least once in the time after which it counts as stale. A page that receives
# nothing for much longer reconnects.
MIN_SILENCE_MS = 6000.0

GOING_AWAY, REJECTED, CROWDED = 1001, 1008, 1013

_log = structlog.get_logger(__name__)


Cut: TypeAlias = Callable[[MutableMapping[str, Any]], None]
# Registers a viewer for the duration of its connection; raises a NavigationError if it is not admitted.
Admit: TypeAlias = Callable[[Person], AbstractContextManager[object]]


# Returns the marks on cuts that are shown now; called in the event loop.
CutMarks: TypeAlias = "Callable[[], Sequence[Mark]]"


def no_marks() -> "Sequence[Mark]":
    """Return no mark; used without a room."""
    return ()


def anybody(_person: Person) -> AbstractContextManager[object]:
    """Admit everybody; used if viewers are not limited."""
    return nullcontext()


class Application(Protocol):
    """The required part of a Starlette or FastAPI application."""

    router: Any
    state: Any


class Scene:
    """Shows the newest instant to any number of viewers.

    Attributes:
        routes: `GET /scene/` and `WS /scene`.
        viewers: Present number of viewers.
        counts: Number of messages from viewers by verdict, since the start.
        slow_viewers: Number of viewers disconnected because nothing could be sent to them for 2 s.
    """

    def __init__(
        self,
        *,
        hub: LiveHub,
        setup: Setup | None = None,
        surface: Surface | None = None,
        stale_after_ms: float = 500.0,
        admit: Admit = anybody,
        cut: Cut | None = None,
        marks: CutMarks = no_marks,
    ) -> None:
        self._hub = hub
        self._marks = marks
        self._admit = admit
        self._cut = cut
        self._setup = setup
        self._surface = surface
        self._loop: asyncio.AbstractEventLoop | None = None
        self._stale_after_s = stale_after_ms / 1000
        self._is_running = False
        self._opening = asyncio.Lock()
        self._page: Page | None = None
        self._door: Door | None = None
        self._stage: Stage | None = None
        self._instant: Instant | None = None
        self._update_task: asyncio.Task[None] | None = None
        self.viewers = 0
        self.slow_viewers = 0
        self.counts: dict[Verdict, int] = dict.fromkeys(Verdict, 0)
        self.routes: list[BaseRoute] = [
            Route("/scene", lambda _: RedirectResponse("scene/"), methods=["GET"]),
            Route("/scene/", self.answer, methods=["GET"]),
            WebSocketRoute("/scene", self.watch),
            WebSocketRoute("/scene/", self.watch),
        ]

    async def start(self) -> None:
        """Start the update task. Call it in the application's event loop."""
        self._loop = asyncio.get_running_loop()
        self._is_running = True
        self._update_task = asyncio.create_task(self._update(), name="scene update")
        self._update_task.add_done_callback(_log_end)

    async def _opened_page(self) -> "Page":
        """Return the page; the first call imports viser and creates the stage.

        Imported on demand, because it takes an eighth of the start and many servers never show a scene.
        """
        async with self._opening:
            if self._page is None:
                self._page = await asyncio.to_thread(_loaded_page, self._stale_after_s * 1000)
            if self._door is None and self._is_running:
                from server.scene.door import Door  # noqa: PLC0415  loaded by now
                from server.scene.stage import Stage  # noqa: PLC0415

                self._door = Door()
                self._stage = Stage(self._door, setup=self._setup, surface=self._surface)
            return self._page

    def show_surface(self, surface: Surface | None) -> None:
        """Show this bone, or none, from now on. From any thread."""
        self._surface = surface
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._take_surface)

    def _take_surface(self) -> None:
        if self._stage is not None:
            self._stage.show_surface(self._surface)

    async def stop(self) -> None:
        """Disconnect the viewers and stop the update task."""
        self._is_running = False
        if self._update_task is not None:
            self._update_task.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._update_task
        if self._door is not None:
            self._door.stop()
        self._door = self._stage = self._update_task = None

    async def _update(self) -> None:
        sequence = -1
        while True:
            try:
                async with asyncio.timeout(self._stale_after_s):
                    instant = await self._hub.next_after(sequence)
            except TimeoutError:
                # Without updates the content of the scene is no longer valid.
                self._instant = None
                if self._stage is not None:
                    self._stage.show_nothing()
                continue
            sequence, self._instant = instant.sequence, instant
            if self.viewers > 0 and self._stage is not None:
                self._draw(self._stage, instant)
            await asyncio.sleep(MIN_INTERVAL_S)

    def _draw(self, stage: "Stage", instant: Instant) -> None:
        try:
            stage.show(instant, self._marks())
        except Exception:  # noqa: BLE001 one bad instant must not freeze the scene for ever
            _log.exception("scene_instant_failed", sequence=instant.sequence)
            stage.show_nothing()

    async def answer(self, request: Request) -> Response:
        """Return the page of viser."""
        return (await self._opened_page()).answer(request)

    async def watch(self, websocket: WebSocket) -> None:
        """Serve one viewer from the handshake to the end of its connection."""
        rejection = self._rejection(websocket)
        if rejection is None:
            await self._opened_page()
        door = self._door
        if door is None or rejection is not None:
            _log.info("scene_viewer_rejected", reason=rejection or "not running")
            await websocket.close(REJECTED)
            return
        try:
            with self._admit(person_of(websocket.scope)):
                await self._show(door, websocket)
        except NavigationError as full:
            _log.info("scene_viewer_rejected", reason=full.message)
            await websocket.close(CROWDED)

    async def _show(self, door: "Door", websocket: WebSocket) -> None:
        """Serve an admitted viewer."""
        self.viewers += 1
        if self.viewers == 1 and self._stage is not None and self._instant is not None:
            # Nothing is drawn without viewers.
            self._draw(self._stage, self._instant)
        try:
            await websocket.accept(subprotocol=SUBPROTOCOL)
            code = await self._serve(door, websocket)
            if code is not None:
                async with asyncio.timeout(SEND_TIMEOUT_S):
                    await websocket.close(code)
        except (TimeoutError, WebSocketDisconnect):
            _log.info("scene_viewer_gone")
        finally:
            self.viewers -= 1
            if self.viewers == 0 and self._stage is not None:
                # The content is no longer updated, and the next viewer must not see it.
                self._stage.show_nothing()

    async def _serve(self, door: "Door", websocket: WebSocket) -> int | None:
        """Send and receive until one of both ends; return the close code, or None after a disconnect."""
        tasks = [
            asyncio.create_task(self._speak(door, websocket)),
            asyncio.create_task(self._listen(websocket)),
        ]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
            # Not gather(): it would hide from an outer cancel scope the origin of its cancellation.
            await asyncio.wait(tasks)
        return next((code for code in [task.result() for task in done] if code is not None), None)

    def _rejection(self, websocket: WebSocket) -> str | None:
        headers = websocket.headers
        # Checked here as well, so that the scene is also safe in an application without the guard.
        if not is_same_origin(origin=headers.get("origin"), host=headers.get("host", "")):
            return "from another page"
        if SUBPROTOCOL not in websocket.scope.get("subprotocols", []):
            return f"does not speak {SUBPROTOCOL}"
        return None

    async def _speak(self, door: "Door", websocket: WebSocket) -> int | None:
        """Send the scene; return the close code, or None after a disconnect."""
        underway_bytes = 0

        async def send(message: bytes) -> None:
            nonlocal underway_bytes
            async with asyncio.timeout(SEND_TIMEOUT_S + underway_bytes / THINNEST_LINE_BYTES_PER_S):
                await websocket.send_bytes(message)
            underway_bytes = len(message)

        try:
            await door.serve(send)
        except TimeoutError:
            self.slow_viewers += 1
            _log.info("scene_viewer_dropped", blocked_s=SEND_TIMEOUT_S)
            if self._cut is not None:
                # A close frame would wait forever behind data that the viewer does not read.
                self._cut(websocket.scope)
            return None
        except WebSocketDisconnect:
            return None
        return GOING_AWAY

    async def _listen(self, websocket: WebSocket) -> int | None:
        """Filter received messages; return the close code for an abusive viewer, None after a disconnect."""
        gate = Gate(counts=self.counts)
        while True:
            message = await websocket.receive()
            if message["type"] == "websocket.disconnect":
                return None
            gate.judge(message.get("bytes") or message.get("text"), now_s=time.monotonic())
            if gate.goodbye:
                _log.warning("scene_viewer_misbehaves", rejections=gate.rejections)
                return REJECTED


@cache
def _loaded_page(stale_after_ms: float) -> "Page":
    """Import viser, and return its page."""
    import server.scene.stage  # noqa: PLC0415, F401  loaded when somebody comes to look
    from server.scene.page import make_page  # noqa: PLC0415

    return make_page(stale_after_ms=stale_after_ms, silent_after_ms=max(MIN_SILENCE_MS, 6 * stale_after_ms))


def _log_end(task: asyncio.Task[None]) -> None:
    """Log an unexpected end of the update task, which leaves every viewer with a stale scene."""
    if not task.cancelled() and (error := task.exception()) is not None:
        _log.critical("scene_update_died", exc_info=error)


def mount_scene(
    app: Application,
    *,
    hub: LiveHub,
    setup: Setup | None,
    surface: Surface | None,
    stale_after_ms: float = 500.0,
    admit: Admit = anybody,
    cut: Cut | None = None,
    marks: CutMarks = no_marks,
) -> None:
    """Add `GET /scene/` and `WS /scene`, and put the scene at `app.state.scene`.

    The application's lifespan calls `app.state.scene.start()` and `.stop()`. The routes are inserted first,
    so that a catch-all route of the page does not hide them. `admit` registers a viewer or rejects it; `cut`
    aborts the connection of a stalled viewer; `marks` returns the marks on cuts.
    """
    scene = Scene(
        hub=hub,
        setup=setup,
        surface=surface,
        stale_after_ms=stale_after_ms,
        admit=admit,
        cut=cut,
        marks=marks,
    )
    app.state.scene = scene
    app.router.routes[:0] = scene.routes
