"""How long a line may take until it speaks TLS."""

import asyncio
from typing import Any

# A handshake is two ways there and back, on a thin line too. asyncio itself waits 60 s for it, and 30 s for
# the farewell: each such line holds a file of the process, and when those run out nobody is let in.
HANDSHAKE_WITHIN_S = 5.0
FAREWELL_WITHIN_S = 5.0


class ImpatientLoop(asyncio.SelectorEventLoop):
    """The event loop of the web server: whoever connects and does not finish the handshake is cut off."""

    async def create_server(self, *given: Any, **named: Any) -> asyncio.Server:  # noqa: ANN401  as its base
        """As ever, with our times where TLS is spoken."""
        if named.get("ssl") is not None:
            named.setdefault("ssl_handshake_timeout", HANDSHAKE_WITHIN_S)
            named.setdefault("ssl_shutdown_timeout", FAREWELL_WITHIN_S)
        return await super().create_server(*given, **named)
