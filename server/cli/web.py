"""Serve the web application on a socket that is already listening.

uvloop is not used: it saves less than a fifth of the load, and the server needs a sixth of a core.
"""

import logging
import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import uvicorn
from starlette.types import ASGIApp

from server.cli.stop_signal import StopSignal
from server.security.tls import Tls
from server.stream.connection import uvicorn_config


class WebServer(uvicorn.Server):
    """uvicorn server without its own signal handlers, with a callback when it is ready."""

    def __init__(self, config: uvicorn.Config, *, on_ready: Callable[[], None]) -> None:
        super().__init__(config)
        self._on_ready = on_ready

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Leave the signals to `StopSignal`, which handles them from program start to exit."""
        yield

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Start uvicorn, then call `on_ready`."""
        await super().startup(sockets)
        self._on_ready()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Shut uvicorn down without a traceback for each stream that is closed."""
        logging.getLogger("uvicorn.error").setLevel(logging.CRITICAL)
        await super().shutdown(sockets)

    def request_stop(self) -> None:
        """Finish open requests; on the second call close all connections at once."""
        self.force_exit = self.should_exit
        self.should_exit = True


def serve_until(
    app: ASGIApp,
    listener: socket.socket,
    stopping: StopSignal,
    *,
    on_ready: Callable[[], None],
    tls: Tls | None = None,
) -> None:
    """Serve until a stop signal."""
    host, port = listener.getsockname()[:2]
    config = uvicorn_config(app, host=host, port=port)
    if tls is not None:
        config.ssl_certfile, config.ssl_keyfile = str(tls.certificate), str(tls.key)
    server = WebServer(config, on_ready=on_ready)
    stopping.on_stop(server.request_stop)
    server.run(sockets=[listener])
