"""Parsing of the requests of a client from a byte stream."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from server.openigtlink.wire import (
    HEADER_BYTES,
    ChecksumError,
    Header,
    Message,
    WireError,
    unpack,
    unpack_header,
)

# Requests have no body or a few bytes; longer messages are not supported.
MAX_BODY_BYTES = 4096
MAX_REQUESTS_PER_S, BURST = 20.0, 40.0


class OversizeError(WireError):
    """The body exceeds the maximum size."""


class TooManyRequestsError(WireError):
    """The client exceeds the rate limit."""


@dataclass(slots=True, kw_only=True)
class RequestReader:
    """Parses the bytes of one client. After a `WireError` the position in the stream is unknown.

    Attributes:
        damaged: Number of messages with a wrong checksum so far.
    """

    damaged: int = 0
    _waiting: bytearray = field(default_factory=bytearray)
    _header: Header | None = None
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
        self._waiting += content
        while (message := self._next()) is not None:
            self._allowance -= 1.0
            if self._allowance < 0.0:
                raise TooManyRequestsError(f"at most {MAX_REQUESTS_PER_S:g} messages per second are accepted")
            yield message

    def _next(self) -> Message | ChecksumError | None:
        if self._header is None:
            if len(self._waiting) < HEADER_BYTES:
                return None
            header = unpack_header(self._taken(HEADER_BYTES))
            if header.body_bytes > MAX_BODY_BYTES:
                raise OversizeError(
                    f"the body has {header.body_bytes} bytes, the maximum is {MAX_BODY_BYTES}"
                )
            self._header = header
        if len(self._waiting) < self._header.body_bytes:
            return None
        header, self._header = self._header, None
        try:
            return unpack(header, self._taken(header.body_bytes))
        except ChecksumError as error:
            # The length was correct, so that the start of the next message is known.
            self.damaged += 1
            return error

    def _taken(self, count: int) -> bytes:
        taken = bytes(self._waiting[:count])
        del self._waiting[:count]
        return taken
