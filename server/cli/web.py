"""Serves the web application on a socket that is already listening.

uvloop is not used: it saves under a fifth of a server that takes a sixth of a core.
"""

import logging
import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import uvicorn
from starlette.types import ASGIApp

from server.cli.stopping import Stopping
from server.security.tls import Tls
from server.stream.connection import uvicorn_config


class WebServer(uvicorn.Server):
    """uvicorn that leaves the signals to us, and says when it answers."""

    def __init__(self, config: uvicorn.Config, *, on_ready: Callable[[], None]) -> None:
        super().__init__(config)
        self._on_ready = on_ready

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """They are caught outside, from the program's first line to its last."""
        yield

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """As uvicorn does, then tell."""
        await super().startup(sockets)
        self._on_ready()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """As uvicorn does, without a traceback for each stream that is cut off, which is what we want."""
        logging.getLogger("uvicorn.error").setLevel(logging.CRITICAL)
        await super().shutdown(sockets)

    def ask_to_stop(self) -> None:
        """Once: finish; twice: drop everything."""
        self.force_exit = self.should_exit
        self.should_exit = True


def serve_until(
    app: ASGIApp,
    listener: socket.socket,
    stopping: Stopping,
    *,
    on_ready: Callable[[], None],
    tls: Tls | None = None,
) -> None:
    """Serve until asked to stop."""
    host, port = listener.getsockname()[:2]
    config = uvicorn_config(app, host=host, port=port)
    if tls is not None:
        config.ssl_certfile, config.ssl_keyfile = str(tls.certificate), str(tls.key)
    server = WebServer(config, on_ready=on_ready)
    stopping.call_when_asked(server.ask_to_stop)
    server.run(sockets=[listener])
