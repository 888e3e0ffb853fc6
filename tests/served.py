"""An application served on a free port, in its own thread."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager

import uvicorn
from fastapi import FastAPI

from server.security.tls import Tls
from server.stream.connection import uvicorn_config

PATIENCE_S = 30.0


class _Announced(uvicorn.Server):
    """A server that signals when it listens."""

    def __init__(self, config: uvicorn.Config) -> None:
        super().__init__(config)
        self.listening = threading.Event()

    async def startup(self, sockets: list[object] | None = None) -> None:  # pyrefly: ignore[bad-override]  # unused
        await super().startup(None)
        assert sockets is None
        self.listening.set()


@contextmanager
def served(app: FastAPI, *, begun: bool = False, tls: Tls | None = None) -> Iterator[int]:
    """Serve the application during the block; yield the port. `begun`: its parts are managed elsewhere."""
    config = uvicorn_config(app, host="127.0.0.1", port=0)
    if tls is not None:
        config.ssl_certfile, config.ssl_keyfile = str(tls.certificate), str(tls.key)
    config.lifespan = "off" if begun else "auto"
    server = _Announced(config)
    thread = threading.Thread(target=server.run, name="web server", daemon=True)
    thread.start()
    try:
        assert server.listening.wait(PATIENCE_S)
        yield int(server.servers[0].sockets[0].getsockname()[1])
    finally:
        server.should_exit = True
        thread.join(PATIENCE_S)
        assert not thread.is_alive(), "the server does not end"
