"""All sinks of the settings."""

import threading
import time
from collections.abc import Sequence

from server.live import Instant, LiveHub
from server.logs import LogSettings
from server.sinks.sink import Sink, SinkStatus
from server.stream.scaling.message_cache import MessageCache


class Sinks:
    """Starts and stops the sinks, and serialises each message once for all of them."""

    def __init__(self, names: Sequence[str], hub: LiveHub, settings: LogSettings) -> None:
        self._texts = MessageCache()
        self._lock = threading.Lock()
        self._sinks = [Sink(name, hub, write=self._text, settings=settings) for name in dict.fromkeys(names)]

    def start(self) -> None:
        """Start all of them; returns at once."""
        for sink in self._sinks:
            sink.start()

    def stop(self) -> None:
        """Stop all of them concurrently."""
        for sink in self._sinks:
            sink.request_stop()
        for sink in self._sinks:
            sink.stop()

    @property
    def status(self) -> list[SinkStatus]:
        """Return the state of each sink, in the order of the settings."""
        return [sink.status for sink in self._sinks]

    def _text(self, instant: Instant) -> str:
        with self._lock:
            return self._texts.of(instant, now_s=time.monotonic())
