"""Requests of supervisors through the hub: what they are on the wire, and how the theatre answers them.

Authority stays in the theatre. A request names no person: it carries the token of a session that the
supervisor has started at the theatre itself, with an invitation of the theatre, and passes the theatre's own
access rules and audit log. Whoever controls the hub can therefore do what the supervisors signed in through
it may do, until the theatre ends their sessions, and nothing else.

A request that changes something needs a ticket, which the theatre has issued within the last seconds by its
own clock: it is refused later, wherever it was delayed, and no clocks are compared. A ticket is used once. A
request that is delivered again gets the first answer.
"""

import asyncio
import json
import re
import secrets
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Any

import structlog
from nats.aio.msg import Msg

from server.clock import elapsed_s
from server.hub.connection import LOST, HubAddress, HubError

MAX_AGE_S = 5.0
# Longer than a hub repeats a request.
ANSWERS_LAST_S = 60.0
MAX_TICKETS = 256
MAX_AT_ONCE = 32
# The hub sends an answer to the browser from its own address: HTML or a script of a theatre would run there
# with the rights at all other theatres.
CONTENT_TYPES = frozenset({"application/json", "image/png", "application/octet-stream"})
TOKEN_SHAPE = re.compile(r"[A-Za-z0-9._-]{0,128}")
CONNECT_AGAIN_S = 1.0
log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class HubRequest:
    """A request of a supervisor, as HTTP.

    Attributes:
        method: HTTP method.
        path: Decoded path at the theatre.
        query: Query string.
        token: Of the supervisor's session at this theatre; empty before sign-in.
        language: Value of `Accept-Language`.
        body: JSON; empty without one.
    """

    method: str
    path: str
    query: str = ""
    token: str = ""
    language: str = "en"
    body: str = ""

    @property
    def needs_ticket(self) -> bool:
        """Whether it may change something."""
        return self.method != "GET"

    def packed(self, ticket: str) -> bytes:
        """Return it for the wire."""
        members = {
            "method": self.method,
            "path": self.path,
            "query": self.query,
            "token": self.token,
            "language": self.language,
            "body": self.body,
            "ticket": ticket,
        }
        return json.dumps(members, ensure_ascii=False).encode()

    def __repr__(self) -> str:
        """Without token and body, which must not be logged."""
        return f"HubRequest({self.method} {self.path})"


def request_from(message: bytes) -> tuple[HubRequest, str]:
    """Return a request from the wire, and its ticket.

    Raises:
        ValueError: it is none.
    """
    try:
        members: dict[str, Any] = json.loads(message)
        ticket = str(members.pop("ticket"))
        return HubRequest(**{name: str(value) for name, value in members.items()}), ticket
    except (TypeError, KeyError, AttributeError, RecursionError) as error:
        raise ValueError(f"the request is not valid: {error}") from None


@dataclass(frozen=True, slots=True, kw_only=True)
class HubAnswer:
    """The theatre's answer.

    Attributes:
        status: HTTP status.
        content_type: Of the body.
        token: Of a session that has just started; empty for one that has ended; None for no change.
        body: The body.
    """

    status: int
    content_type: str
    token: str | None
    body: bytes

    def packed(self) -> bytes:
        """Return it for the wire: a line of JSON, and the body."""
        members = {"status": self.status, "content_type": self.content_type, "token": self.token}
        return json.dumps(members).encode() + b"\n" + self.body


def answer_from(message: bytes) -> HubAnswer:
    """Return an answer from the wire.

    Raises:
        ValueError: it is none, or a theatre does not give such an answer.
    """
    line, _, body = message.partition(b"\n")
    try:
        members: dict[str, Any] = json.loads(line)
        token = members["token"]
        answer = HubAnswer(
            status=int(members["status"]),
            content_type=str(members["content_type"]),
            token=None if token is None else str(token),
            body=body,
        )
    except (TypeError, KeyError, OverflowError, RecursionError) as error:
        raise ValueError(f"the answer is not valid: {error}") from None
    is_known = answer.content_type in CONTENT_TYPES and 200 <= answer.status < 600
    if not (is_known and TOKEN_SHAPE.fullmatch(answer.token or "")):
        raise ValueError(f"the answer is not one of a theatre: {answer.status} {answer.content_type[:80]}")
    return answer


class HubRequestOld(HubError):
    """A request without a ticket of the last seconds; nothing was done."""


def is_old(answer: HubAnswer) -> bool:
    """Return whether the theatre rejected this delivery with HUB_REQUEST_OLD."""
    try:
        return answer.status >= 400 and json.loads(answer.body)["code"] == "HUB_REQUEST_OLD"
    except (ValueError, TypeError, KeyError, RecursionError):
        return False


class Tickets:
    """Performs each ticketed request at most once, and within seconds. For one event loop.

    Args:
        perform: Does what is requested.
        clock: Monotonic clock.
    """

    def __init__(
        self, perform: Callable[[HubRequest], Awaitable[HubAnswer]], *, clock: Callable[[], float] = elapsed_s
    ) -> None:
        self._perform = perform
        self._clock = clock
        self._issued: dict[str, float] = {}
        self._answers: dict[str, tuple[float, asyncio.Future[HubAnswer]]] = {}

    def issue(self) -> str:
        """Return a new ticket; above the maximum the oldest one is not valid any more."""
        now_s = self._clock()
        self._answers = {
            ticket: one for ticket, one in self._answers.items() if now_s - one[0] <= ANSWERS_LAST_S
        }
        ticket = secrets.token_urlsafe(16)
        self._issued[ticket] = now_s
        for tickets in (self._issued, self._answers):
            if len(tickets) > MAX_TICKETS:
                del tickets[next(iter(tickets))]
        return ticket

    async def answer(self, request: HubRequest, ticket: str) -> HubAnswer:
        """Perform a request, or return the answer to the first delivery of it.

        Raises:
            HubRequestOld: HUB_REQUEST_OLD.
        """
        if not request.needs_ticket:
            return await self._perform(request)
        if ticket not in self._answers:
            issued_s = self._issued.pop(ticket, None)
            now_s = self._clock()
            if issued_s is None or now_s - issued_s > MAX_AGE_S:
                raise HubRequestOld(
                    "HUB_REQUEST_OLD",
                    f"the request reached the theatre more than {MAX_AGE_S:g} s after it was announced, or "
                    "was announced to another run of it; nothing was done",
                    "Look at the state of the theatre, then ask again.",
                    {"allowed_s": MAX_AGE_S},
                )
            self._answers[ticket] = (now_s, asyncio.ensure_future(self._perform(request)))
        # The first delivery may be cancelled with its connection; what it began is done all the same.
        return await asyncio.shield(self._answers[ticket][1])


class RequestServer:
    """Receives requests for a theatre in its web process, and answers them; connects again when it is lost.

    Args:
        address: The NATS server.
        theatre: Name of this theatre.
        perform: Does what is requested.
        is_published: Returns whether this theatre publishes under its name now: another theatre of the same
            name must not answer in its place.
        rejected: Makes an answer of an error.
    """

    def __init__(
        self,
        address: HubAddress,
        theatre: str,
        *,
        perform: Callable[[HubRequest], Awaitable[HubAnswer]],
        is_published: Callable[[], bool],
        rejected: Callable[[HubError, str], HubAnswer],
    ) -> None:
        self._address = address
        self._theatre = theatre
        self._tickets = Tickets(perform)
        self._is_published = is_published
        self._rejected = rejected
        self._answering: set[asyncio.Task[None]] = set()

    async def run(self) -> None:
        """Answer until cancelled. Why there is no connection is reported by the publisher."""
        while True:
            try:
                async with self._address.connected(f"{self._theatre}-requests") as link:
                    subject = link.address.hospital.requests(self._theatre)
                    await link.client.subscribe(subject, cb=self._receive)
                    await link.until_lost()
            except (HubError, *LOST) as error:
                log.debug("no requests from the hub", why=str(error))
            await asyncio.sleep(CONNECT_AGAIN_S)

    async def _receive(self, message: Msg) -> None:
        if not self._is_published() or len(self._answering) >= MAX_AT_ONCE:
            return
        answering = asyncio.create_task(self._answer(message))
        self._answering.add(answering)
        answering.add_done_callback(self._answering.discard)

    async def _answer(self, message: Msg) -> None:
        try:
            if message.data == b"":
                await message.respond(self._tickets.issue().encode())
                return
            request, ticket = request_from(message.data)
            try:
                answer = await self._tickets.answer(request, ticket)
            except HubError as error:
                answer = self._rejected(error, request.language)
            await message.respond(answer.packed())
        except (ValueError, *LOST) as error:
            # Not a request; or the answer was lost or is too long, and the hub asks again for it.
            log.warning("a request of the hub was not answered", why=str(error))
        except Exception:
            log.exception("a request of the hub failed")
