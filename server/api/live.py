"""The newest live message by HTTP."""

import time

from fastapi import APIRouter

from server.api.errors import NotYetAvailable, rejections
from server.live import LiveHub
from server.stream.messages import LiveMessage, live_message


def live_router(hub: LiveHub) -> APIRouter:
    """Return the router of `GET /api/live`."""
    router = APIRouter(prefix="/api", tags=["live"])

    @router.get("/live", responses=rejections(503))
    async def live() -> LiveMessage:
        """Return the state of source and tracking process, and the poses and numbers of the newest image.

        The same message is sent for each instant on `WS /ws/live`, and as header of each image on
        `WS /ws/view`.
        """
        instant = hub.newest
        if instant is None:
            raise NotYetAvailable(
                "NOTHING_YET",
                "the tracking process has sent no message since the server started",
                "Try again in a second; if the error persists, check /health and the server log.",
            )
        return live_message(instant, now_s=time.monotonic())

    return router
