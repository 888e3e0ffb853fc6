"""An event loop with simulated time, and connections of any bandwidth in it."""

import asyncio
import json
import selectors
from collections.abc import Coroutine, Mapping
from typing import Any, cast

from server.stream.connection import STATE_KEY, Connection


class Leaping(asyncio.SelectorEventLoop):
    """A selector that never waits: it advances the clock instead."""

    def __init__(self) -> None:
        self._now_s = 0.0
        super().__init__(_Impatient(self))

    def time(self) -> float:
        """Simulated time, starting at 0."""
        return self._now_s

    def leap(self, by_s: float) -> None:
        """Advance the clock."""
        self._now_s += by_s


class _Impatient(selectors.DefaultSelector):
    def __init__(self, loop: Leaping) -> None:
        super().__init__()
        self._loop = loop

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        if timeout is not None and timeout > 0.0:
            self._loop.leap(timeout)
        return super().select(0.0)


class LoopTime:
    """Replaces the module `time` where simulated time is read."""

    @staticmethod
    def monotonic() -> float:
        """Time of the running loop, in seconds."""
        return asyncio.get_running_loop().time()


def run_in_made_time(main: Coroutine[Any, Any, None]) -> None:
    """Run to completion without waiting."""
    with asyncio.Runner(loop_factory=Leaping) as runner:
        runner.run(main)


class Wire:
    """A transport with this many bytes per second; 0 is a viewer that reads nothing."""

    def __init__(self, bytes_per_s: float) -> None:
        self._bytes_per_s = bytes_per_s
        self._since_s, self._unsent = 0.0, 0.0
        self.cut_at_s: float | None = None
        self.connection = Connection(cast("asyncio.Transport", cast("Any", self)))

    async def carry(self, size: int) -> None:
        """Accept a message, and become free when it has been sent."""
        loop = asyncio.get_running_loop()
        self._since_s, self._unsent = loop.time(), float(size)
        if self._bytes_per_s == float("inf"):
            self._unsent = 0.0
            return
        self.connection.is_writable.clear()
        if self._bytes_per_s > 0.0:
            loop.call_later(size / self._bytes_per_s, self._end)

    def get_write_buffer_size(self) -> int:
        """Bytes not sent yet."""
        gone = (
            self._bytes_per_s * (asyncio.get_running_loop().time() - self._since_s) if self._unsent else 0.0
        )
        return max(0, round(self._unsent - gone))

    def is_closing(self) -> bool:
        """Whether it was aborted."""
        return self.cut_at_s is not None

    def get_extra_info(self, _name: str) -> None:
        """There is no socket."""

    def abort(self) -> None:
        """End it."""
        self.cut_at_s = asyncio.get_running_loop().time()
        self.connection.is_writable.set()

    def _end(self) -> None:
        self._unsent = 0.0
        self.connection.is_writable.set()


class Page:
    """The WebSocket of a viewer that requests the next image after each one, or only listens."""

    def __init__(self, bytes_per_s: float = float("inf"), *, asks: bool = True) -> None:
        self._asks = asks
        self.wire = Wire(bytes_per_s)
        self.scope: Mapping[str, Any] = {"state": {STATE_KEY: self.wire.connection}}
        self.came: list[tuple[float, dict[str, Any]]] = []
        self._requested = False

    async def accept(self) -> None:
        """Let in."""

    async def receive(self) -> dict[str, Any]:
        """The next request, after the last answer has been transmitted."""
        if not self._asks:
            await asyncio.Event().wait()
        if not self._requested:
            self._requested = True
            return {"type": "websocket.receive", "text": '{"next": true}'}
        await self._answered()
        return {"type": "websocket.receive", "text": '{"next": true}'}

    async def _answered(self) -> None:
        before = len(self.came)
        while len(self.came) == before or self.wire.get_write_buffer_size() > 0:
            await asyncio.sleep(0.001)

    async def send_bytes(self, content: bytes) -> None:
        """An image with its message."""
        length = int.from_bytes(content[:4], "little")
        self._take(json.loads(content[4 : 4 + length]))
        await self.wire.carry(len(content))

    async def send_text(self, text: str) -> None:
        """A message alone."""
        self._take(json.loads(text))
        await self.wire.carry(len(text))

    def _take(self, message: dict[str, Any]) -> None:
        self.came.append((asyncio.get_running_loop().time(), message))
