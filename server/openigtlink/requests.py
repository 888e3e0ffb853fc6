"""What a client sends, out of a stream of bytes: requests, and damage with its consequence."""

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

# A request has no body, or a few bytes; longer messages are none that are known here.
MAX_BODY_BYTES = 4096
MAX_REQUESTS_PER_S, BURST = 20.0, 40.0


class OversizeError(WireError):
    """A body is longer than a client may send."""


class TooManyRequestsError(WireError):
    """A client sends more messages than it may."""


@dataclass(slots=True, kw_only=True)
class RequestReader:
    """Parses the bytes of one client. After a `WireError` its stream has no known place any more.

    Attributes:
        damaged: messages with a wrong checksum so far.
    """

    damaged: int = 0
    _waiting: bytearray = field(default_factory=bytearray)
    _header: Header | None = None
    _allowance: float = BURST
    _fed_at_s: float | None = None

    def feed(self, content: bytes, *, now_s: float) -> Iterator[Message | ChecksumError]:
        """Yield each message that is complete now, or the error of one whose body was damaged on the way.

        Raises:
            WireError: where the next message begins is unknown.
            OversizeError: a header announces a body that is too long; it is never waited for.
            TooManyRequestsError: more than 20 messages a second on average.
        """
        if self._fed_at_s is not None:
            self._allowance = min(BURST, self._allowance + (now_s - self._fed_at_s) * MAX_REQUESTS_PER_S)
        self._fed_at_s = now_s
        self._waiting += content
        while (message := self._next()) is not None:
            self._allowance -= 1.0
            if self._allowance < 0.0:
                raise TooManyRequestsError(f"at most {MAX_REQUESTS_PER_S:g} messages a second are taken")
            yield message

    def _next(self) -> Message | ChecksumError | None:
        if self._header is None:
            if len(self._waiting) < HEADER_BYTES:
                return None
            header = unpack_header(self._taken(HEADER_BYTES))
            if header.body_bytes > MAX_BODY_BYTES:
                raise OversizeError(f"a body of {header.body_bytes} bytes, allowed {MAX_BODY_BYTES}")
            self._header = header
        if len(self._waiting) < self._header.body_bytes:
            return None
        header, self._header = self._header, None
        try:
            return unpack(header, self._taken(header.body_bytes))
        except ChecksumError as error:
            # Its length was right, so that the next message begins where it should.
            self.damaged += 1
            return error

    def _taken(self, count: int) -> bytes:
        taken = bytes(self._waiting[:count])
        del self._waiting[:count]
        return taken
