"""Parsing of the requests of a client from a byte stream."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from server.openigtlink_wire import ChecksumError, Message, MessageReader, WireError

# Requests have no body or a few bytes; longer messages are not supported.
MAX_BODY_BYTES = 4096
MAX_REQUESTS_PER_S, BURST = 20.0, 40.0


class TooManyRequestsError(WireError):
    """The client exceeds the rate limit."""


@dataclass(slots=True, kw_only=True)
class RequestReader:
    """Parses the bytes of one client. After a `WireError` the position in the stream is unknown.

    Attributes:
        damaged: Number of messages with a wrong checksum so far.
    """

    damaged: int = 0
    _messages: MessageReader = field(default_factory=lambda: MessageReader(max_body_bytes=MAX_BODY_BYTES))
    _allowance: float = BURST
    _fed_at_s: float | None = None

    def feed(self, content: bytes, *, now_s: float) -> Iterator[Message | ChecksumError]:
        """Yield each complete message, or the error of a message with a damaged body.

        Raises:
            WireError: The start of the next message is unknown.
            OversizeError: A header announces a body that is too long.
            TooManyRequestsError: More than 20 messages per second on average.
        """
        if self._fed_at_s is not None:
            self._allowance = min(BURST, self._allowance + (now_s - self._fed_at_s) * MAX_REQUESTS_PER_S)
        self._fed_at_s = now_s
        for message in self._messages.feed(content):
            self._allowance -= 1.0
            if self._allowance < 0.0:
                raise TooManyRequestsError(f"at most {MAX_REQUESTS_PER_S:g} messages per second are accepted")
            self.damaged += isinstance(message, ChecksumError)
            yield message
