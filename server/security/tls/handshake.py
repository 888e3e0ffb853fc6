"""Timeouts of TLS handshakes."""

import asyncio
from typing import Any

# A handshake needs two round trips, also on a slow network. asyncio itself waits 60 s for it, and 30 s for
# the shutdown: each such connection needs a file descriptor, and when those run out nobody can connect.
HANDSHAKE_TIMEOUT_S = 5.0
SHUTDOWN_TIMEOUT_S = 5.0


class HandshakeTimeoutLoop(asyncio.SelectorEventLoop):
    """Event loop of the web server with short TLS timeouts."""

    async def create_server(self, *given: Any, **named: Any) -> asyncio.Server:  # noqa: ANN401  as its base
        """As its base, with these timeouts under TLS."""
        if named.get("ssl") is not None:
            named.setdefault("ssl_handshake_timeout", HANDSHAKE_TIMEOUT_S)
            named.setdefault("ssl_shutdown_timeout", SHUTDOWN_TIMEOUT_S)
        return await super().create_server(*given, **named)
