"""Routes of the hub: the list of theatres, and the live messages and pictures of an opened one.

Below `/at/{theatre}` are the same addresses as at a theatre itself, so that the page shows an opened theatre
by the same code.
"""

import asyncio
import json
from collections import deque
from collections.abc import Callable, Coroutine, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from typing import Any

from fastapi import APIRouter, Request, Response, WebSocket
from starlette.requests import HTTPConnection

from server.api.dashboard import DashboardMessage
from server.api.errors import NotYetAvailable, rejections
from server.api.hub_cookies import theatre_cookie, token_at
from server.api.hub_messages import HubTheatreMessage, HubTheatresMessage
from server.clock import elapsed_s
from server.config import Config
from server.hub.connection import HubAddress, HubError
from server.hub.opened import OpenedTheatres
from server.hub.pictures import picture_packed, picture_unpacked
from server.hub.relay import relayed
from server.hub.requester import RequestLine, request_line
from server.hub.requests import HubAnswer, HubRequest
from server.hub.subjects import Leaf, is_theatre_name
from server.hub.theatres import STALE_AFTER_MS, theatre_rows
from server.hub.watcher import Received, Watcher
from server.security import person_of
from server.security.access_rules import THROUGH_HUB_KEYS
from server.security.rejections import AddressUnknown
from server.stream.connection import connection_of
from server.stream.errors import TooManyViewers
from server.stream.messages import translated_problem
from server.stream.socket import REJECTED, TRY_LATER, ProtocolViolation, reject_viewer, run_duplex
from server.stream.tasks import run_until_first_ends
from server.stream.viewers import ViewerKind, Viewers
from server.texts import requested_language

AT = "/at/{theatre}"
AGE_HEADER = "X-Coaxial-Age-Ms"
# A theatre without pictures sends its message alone: the page claims nothing before a first one.
MAX_WAIT_S = 1.0
ROOM_PERIOD_S = 1.0
MAX_MARKS = 64
RESTARTED = "the theatre was started again"


@dataclass(frozen=True, slots=True, kw_only=True)
class HubContext:
    """What the routes of the hub use.

    Attributes:
        address: The NATS server.
        watcher: Receives state and pictures of all theatres.
        opened: Receives live messages of opened theatres.
        viewers: Open pages.
        config: The settings.
        dashboard: Start-up data of the page of an opened theatre.
    """

    address: HubAddress
    watcher: Watcher
    opened: OpenedTheatres
    viewers: Viewers
    config: Config
    dashboard: DashboardMessage

    @classmethod
    def of(cls, config: Config, address: HubAddress, dashboard: DashboardMessage) -> "HubContext":
        """Return the parts of these settings; nothing is received until the watcher runs."""
        watcher = Watcher(address, (Leaf.STATE, Leaf.PICTURE), creates_storage=True)
        return cls(
            address=address,
            watcher=watcher,
            opened=OpenedTheatres(address, clock_of=watcher),
            viewers=Viewers(maximum=config.video.max_viewers),
            config=config,
            dashboard=dashboard,
        )

    def sees(self, asking: HTTPConnection) -> Sequence[str]:
        """Return the names of theatres, with `*`, that the settings grant to this person."""
        return self.config.hub.sees.get(person_of(asking.scope).name, [])

    def is_seen(self, theatre: str, asking: HTTPConnection) -> bool:
        """Return whether this person sees a theatre."""
        return is_theatre_name(theatre) and any(
            fnmatchcase(theatre, pattern) for pattern in self.sees(asking)
        )

    def reject_unseen(self, theatre: str, request: Request) -> None:
        """Raise unless this person sees a theatre. Whether another one exists is not told.

        Raises:
            AddressUnknown: NOT_FOUND.
        """
        if not self.is_seen(theatre, request):
            raise AddressUnknown.at(request.url.path)


def hub_router(hub: HubContext) -> APIRouter:
    """Return the router of the hub."""
    router = APIRouter(tags=["hub"])
    _add_list(router, hub)
    _add_opened(router, hub)
    _add_requests(router, hub)
    return router


def _add_requests(router: APIRouter, hub: HubContext) -> None:
    """Pass what supervisors do in a theatre on to the theatre, with their session there."""

    async def forward(theatre: str, request: Request) -> Response:
        hub.reject_unseen(theatre, request)
        asked = HubRequest(
            method=request.method,
            path=str(request.scope["path"]).removeprefix(f"/at/{theatre}"),
            query=request.url.query,
            token=token_at(theatre, request),
            language=requested_language(),
            body=(await request.body()).decode(errors="replace"),
        )
        async with request_line(hub.address, theatre) as line:
            answer = await line.ask(asked)
        # Without a session there, the person still has one here.
        status = 403 if answer.status == 401 else answer.status
        response = Response(answer.body, status_code=status, media_type=answer.content_type)
        if answer.token is not None:
            response.headers.append("Set-Cookie", theatre_cookie(theatre, answer.token, request))
        return response

    for method, path in THROUGH_HUB_KEYS:
        router.add_api_route(AT + path, forward, methods=[method], include_in_schema=False)

    @router.websocket(AT + "/ws/room")
    async def room(websocket: WebSocket, theatre: str) -> None:
        await _serve(websocket, theatre, hub, ViewerKind.ROOM, _send_room)


def _add_list(router: APIRouter, hub: HubContext) -> None:
    @router.get("/api/theatres")
    async def theatres(request: Request) -> HubTheatresMessage:
        """Return the theatres that this account may see; a theatre that is not live has its age only."""
        rows = theatre_rows(hub.watcher.newest, now_s=elapsed_s(), language=requested_language())
        problem = hub.watcher.problem
        return HubTheatresMessage(
            theatres=[
                HubTheatreMessage.model_validate(row, from_attributes=True)
                for row in rows
                if hub.is_seen(row.name, request)
            ],
            sees=list(hub.sees(request)),
            stale_after_ms=STALE_AFTER_MS,
            problem=None if problem is None else translated_problem(problem),
        )

    @router.get(
        "/api/theatres/{theatre}/picture",
        response_class=Response,
        responses={200: {"content": {"image/jpeg": {}}}, **rejections(404, 503)},
    )
    async def picture(theatre: str, request: Request) -> Response:
        """Return the newest small picture, without figures.

        The header `X-Coaxial-Age-Ms` is the age of its image at the sending, at most.
        """
        hub.reject_unseen(theatre, request)
        received = hub.watcher.newest.get((theatre, Leaf.PICTURE))
        age_ms = None if received is None else received.arrival.image_age_ms(now_s=elapsed_s())
        if received is None or age_ms is None or age_ms > STALE_AFTER_MS:
            raise _nothing_recent(theatre)
        try:
            _, jpeg = picture_unpacked(received.content)
        except ValueError:
            raise _nothing_recent(theatre) from None
        return Response(jpeg, media_type="image/jpeg", headers={AGE_HEADER: f"{age_ms:.1f}"})


def _add_opened(router: APIRouter, hub: HubContext) -> None:
    @router.get(AT + "/api/dashboard", include_in_schema=False, responses=rejections(404))
    async def dashboard(theatre: str, request: Request) -> DashboardMessage:
        """Return the start-up data of the page of a theatre, with the limits of this hub."""
        hub.reject_unseen(theatre, request)
        return hub.dashboard

    @router.get(AT + "/api/live", include_in_schema=False, responses=rejections(404, 503))
    async def live(theatre: str, request: Request) -> Response:
        """Return the newest live message of a theatre that this page has opened, on the clock of the hub."""
        hub.reject_unseen(theatre, request)
        received = hub.opened.newest(theatre)
        text = None if received is None else _text_of(received)
        if text is None:
            raise _nothing_recent(theatre)
        return Response(text, media_type="application/json")

    @router.websocket(AT + "/ws/live")
    async def messages(websocket: WebSocket, theatre: str) -> None:
        await _serve(websocket, theatre, hub, ViewerKind.LIVE, _send_messages)

    @router.websocket(AT + "/ws/view")
    async def view(websocket: WebSocket, theatre: str) -> None:
        await _serve(websocket, theatre, hub, ViewerKind.VIEW, _send_pictures)


def _nothing_recent(theatre: str) -> NotYetAvailable:
    return NotYetAvailable(
        "THEATRE_SILENT",
        f"nothing recent was received from {theatre}",
        "See its state in the list of theatres; the people in the theatre have their own screen.",
        {"theatre": theatre[:80]},
    )


def _text_of(received: Received) -> str | None:
    """Return a live message as sent now; None if it is too old, of unknown age, or not valid."""
    try:
        return relayed(received.content, received.arrival).text(now_s=elapsed_s())
    except ValueError:
        return None


class _Marks:
    """Marks of a page that wait for the theatre. Of two positions of the pointer only the newer one waits.

    Attributes:
        passed: Set when the theatre has one more.
    """

    def __init__(self) -> None:
        self.passed = asyncio.Event()
        self._waiting: deque[dict[str, Any]] = deque(maxlen=MAX_MARKS)
        self._added = asyncio.Event()

    def add(self, message: dict[str, Any]) -> None:
        if "point" in message and self._waiting and "point" in self._waiting[-1]:
            self._waiting.pop()
        self._waiting.append(message)
        self._added.set()

    async def next(self) -> dict[str, Any]:
        while not self._waiting:
            self._added.clear()
            await self._added.wait()
        return self._waiting.popleft()


@dataclass(frozen=True, slots=True, kw_only=True)
class _Page:
    """One socket of a page that shows a theatre."""

    websocket: WebSocket
    theatre: str
    hub: HubContext
    watcher: Watcher
    requested: asyncio.Event
    marks: _Marks

    async def send(self, message: str | bytes) -> None:
        is_text = isinstance(message, str)
        sending = self.websocket.send_text(message) if is_text else self.websocket.send_bytes(message)
        await self.hub.viewers.send(sending, connection_of(self.websocket.scope))


async def _serve(
    websocket: WebSocket,
    theatre: str,
    hub: HubContext,
    kind: ViewerKind,
    send: Callable[[_Page], Coroutine[None, None, None]],
) -> None:
    await websocket.accept()
    if not hub.is_seen(theatre, websocket):
        await websocket.close(REJECTED, "this account does not see this theatre")
        return
    requested, marks = asyncio.Event(), _Marks()

    def receive(text: str) -> None:
        # Sizes and rates that the page asks for do not apply to small pictures; only the room has marks.
        with suppress(ValueError, RecursionError):
            message = json.loads(text)
            if isinstance(message, dict):
                if message.get("next") is True:
                    requested.set()
                else:
                    marks.add(message)
                return
        raise ProtocolViolation(REJECTED, "messages are JSON objects")

    try:
        with (
            hub.viewers.register(kind, person=person_of(websocket.scope)),
            hub.opened.watching(theatre) as watcher,
        ):
            page = _Page(
                websocket=websocket,
                theatre=theatre,
                hub=hub,
                watcher=watcher,
                requested=requested,
                marks=marks,
            )
            await run_duplex(websocket, hub.viewers, send=lambda: send(page), receive_text=receive)
    except TooManyViewers as full:
        await reject_viewer(websocket, full)
    except HubError as error:
        await websocket.close(TRY_LATER, error.code)


async def _send_room(page: _Page) -> None:
    """Send the state of the room on request, once a second and after a mark; pass marks on to the theatre."""
    asking = HubRequest(
        method="GET",
        path="/api/supervision/room",
        token=token_at(page.theatre, page.websocket),
        language=page.websocket.query_params.get("lang", "en"),
    )

    async def ask(line: RequestLine, request: HubRequest) -> HubAnswer:
        answer = await line.ask(request)
        if not 200 <= answer.status < 300:
            raise ProtocolViolation(TRY_LATER, f"the theatre answered {answer.status}")
        return answer

    async def send_state(line: RequestLine) -> None:
        while True:
            await page.requested.wait()
            page.requested.clear()
            page.marks.passed.clear()
            await page.send((await ask(line, asking)).body.decode())
            with suppress(TimeoutError):
                await asyncio.wait_for(page.marks.passed.wait(), ROOM_PERIOD_S)

    async def send_marks(line: RequestLine) -> None:
        while True:
            marked = await page.marks.next()
            received = page.hub.opened.newest(page.theatre)
            body = None if received is None else _mark_at(marked, received)
            if body is not None:
                path = "/api/supervision/marks"
                await ask(line, replace(asking, method="POST", path=path, body=body))
                page.marks.passed.set()

    async with request_line(page.hub.address, page.theatre) as line:
        await run_until_first_ends(send_state(line), send_marks(line))


def _mark_at(marked: dict[str, Any], received: Received) -> str | None:
    """Return a mark with the time of the newest image by the theatre's clock; None without an image.

    The page has the time of its image by the hub's clock, which means nothing at the theatre.
    """
    try:
        captured_at_s = relayed(received.content, received.arrival).captured_at_s
    except ValueError:
        return None
    if captured_at_s is None:
        return None
    at = {
        kind: one | {"captured_at_s": captured_at_s}
        for kind in ("point", "draw")
        if isinstance(one := marked.get(kind), dict)
    }
    return json.dumps(marked | at)


async def _send_messages(page: _Page) -> None:
    """Send each live message, the newest first; end with the run of the theatre.

    A theatre that was started again counts its messages from zero, and the page takes only growing numbers:
    it forgets them with the connection.
    """
    received: Received | None = None
    run: str | None = None
    while True:
        received = await page.watcher.next_after(page.theatre, Leaf.LIVE, received)
        if run not in {None, received.run}:
            raise ProtocolViolation(TRY_LATER, RESTARTED)
        run = received.run
        text = _text_of(received)
        if text is not None:
            await page.send(text)


async def _send_pictures(page: _Page) -> None:
    """Answer each request with the next picture and the message of its image.

    Without a picture for a second the newest message is sent alone.
    """
    pictures = page.hub.watcher
    picture: Received | None = None
    run: str | None = None
    while True:
        await page.requested.wait()
        live = await page.watcher.next_after(page.theatre, Leaf.LIVE, None)
        if run not in {None, live.run}:
            raise ProtocolViolation(TRY_LATER, RESTARTED)
        run = live.run
        try:
            async with asyncio.timeout(MAX_WAIT_S):
                picture = await pictures.next_after(page.theatre, Leaf.PICTURE, picture)
            frame = _frame_of(picture) if picture.run == run else None
        except TimeoutError:
            newest = page.hub.opened.newest(page.theatre)
            text = None if newest is None or newest.run != run else _text_of(newest)
            frame = None if text is None else picture_packed(text, b"")
        if frame is not None:
            page.requested.clear()
            await page.send(frame)


def _frame_of(picture: Received) -> bytes | None:
    try:
        live, jpeg = picture_unpacked(picture.content)
        text = relayed(live, picture.arrival, has_picture=True).text(now_s=elapsed_s())
    except ValueError:
        return None
    return None if text is None else picture_packed(text, jpeg)
