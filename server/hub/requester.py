"""The hub's side of requests to theatres (`requests.py`)."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass

from nats.errors import NoRespondersError
from nats.errors import TimeoutError as NatsTimeoutError

from server.hub.connection import REQUEST_TIMEOUT_S, HubAddress, HubError, Link
from server.hub.requests import HubAnswer, HubRequest, answer_from, is_old

DELIVERIES = 3


@dataclass(frozen=True, slots=True, kw_only=True)
class RequestLine:
    """A connection for requests to one theatre.

    Attributes:
        link: The connection.
        theatre: Name of the theatre.
    """

    link: Link
    theatre: str

    async def ask(self, request: HubRequest) -> HubAnswer:
        """Return the theatre's answer. A request without an answer is delivered again, and done once.

        Raises:
            HubError: HUB_REQUESTS_OFF, HUB_NOT_CONFIRMED.
        """
        ticket = (await self._send(b"")).decode() if request.needs_ticket else ""
        packed = request.packed(ticket)
        reason: Exception | None = None
        for delivery in range(DELIVERIES):
            try:
                answer = answer_from(await self._send(packed))
            except (_Unanswered, ValueError) as error:
                reason = error
            else:
                # An earlier delivery may have been done by the run that the theatre ended then.
                if delivery > 0 and is_old(answer):
                    break
                return answer
        if not request.needs_ticket:
            raise self._unanswered() from reason
        raise HubError(
            "HUB_NOT_CONFIRMED",
            f"{self.theatre} has not confirmed the request; it is not known whether it was done",
            "Look at the state of the theatre, or call it, before you ask again.",
            {"theatre": self.theatre},
        ) from reason

    async def _send(self, content: bytes) -> bytes:
        subject = self.link.address.hospital.requests(self.theatre)
        try:
            reply = await self.link.client.request(subject, content, timeout=REQUEST_TIMEOUT_S)
        except (NoRespondersError, NatsTimeoutError) as error:
            raise self._unanswered() from error
        return reply.data

    def _unanswered(self) -> "_Unanswered":
        return _Unanswered(
            "HUB_REQUESTS_OFF",
            f"{self.theatre} takes no requests through the hub now",
            "Use the theatre's own page, or call it. The theatre takes requests while it is connected and "
            "hub.requests is true in its settings.",
            {"theatre": self.theatre},
        )


class _Unanswered(HubError):
    """Nobody answers for this theatre."""


@asynccontextmanager
async def request_line(address: HubAddress, theatre: str) -> AsyncIterator[RequestLine]:
    """Connect for requests to a theatre.

    Raises:
        HubError: HUB_UNREACHABLE.
    """
    async with address.connected("hub-requests") as link:
        yield RequestLine(link=link, theatre=theatre)
