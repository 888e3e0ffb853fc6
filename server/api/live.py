"""What is true now, as an answer."""

import time

from fastapi import APIRouter

from server.api.errors import NothingYet, rejections
from server.live import LiveHub
from server.stream.messages import LiveMessage, live_message


def live_router(hub: LiveHub) -> APIRouter:
    """`GET /api/live`."""
    router = APIRouter(prefix="/api", tags=["live"])

    @router.get("/live", responses=rejections(503))
    async def live() -> LiveMessage:
        """What is true now: source, tracking process, and the newest image's poses and numbers.

        The same message is sent for each instant on `WS /ws/live`, and as the header of each image on
        `WS /ws/view`.
        """
        instant = hub.newest
        if instant is None:
            raise NothingYet(
                "NOTHING_YET",
                "the tracking process has not said anything since the server started",
                "Ask again in a second; if it stays so, look at /health and at the server's log.",
            )
        return live_message(instant, now_s=time.monotonic())

    return router
