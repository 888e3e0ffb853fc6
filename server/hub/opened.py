"""Opened theatres: their live messages are received while at least one page shows them."""

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from server.hub.connection import HubAddress
from server.hub.subjects import Leaf
from server.hub.watcher import Received, Watcher


@dataclass(slots=True, kw_only=True)
class _Opened:
    watcher: Watcher
    running: asyncio.Task[None]
    pages: int = 0


class OpenedTheatres:
    """Receives the live messages of opened theatres. For one event loop.

    Args:
        address: The NATS server.
        clock_of: The hub whose beats measure the delays.
    """

    def __init__(self, address: HubAddress, *, clock_of: Watcher) -> None:
        self._address = address
        self._clock_of = clock_of
        self._opened: dict[str, _Opened] = {}

    @contextmanager
    def watching(self, theatre: str) -> Iterator[Watcher]:
        """Receive the live messages of a theatre for the duration of the block."""
        opened = self._opened.get(theatre)
        if opened is None:
            watcher = Watcher(self._address, (Leaf.LIVE,), theatre=theatre, clock_of=self._clock_of)
            running = asyncio.get_running_loop().create_task(watcher.run(), name=f"theatre {theatre}")
            opened = self._opened[theatre] = _Opened(watcher=watcher, running=running)
        opened.pages += 1
        try:
            yield opened.watcher
        finally:
            opened.pages -= 1
            if opened.pages == 0:
                del self._opened[theatre]
                opened.running.cancel()

    def newest(self, theatre: str) -> Received | None:
        """Return the newest live message of a theatre; None if nobody has opened it, or nothing has come."""
        opened = self._opened.get(theatre)
        return None if opened is None else opened.watcher.newest.get((theatre, Leaf.LIVE))
