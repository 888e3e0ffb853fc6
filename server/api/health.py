"""Whether all is well, for a container's health check and for a person."""

import time
from enum import StrEnum

from fastapi import APIRouter, Request, Response

from server.live import Instant, LiveHub, ProcessState, SourceState
from server.security import NOBODY, person_of
from server.stream.messages import Message, ProcessMessage, SourceMessage, process_message, source_message


class HealthState(StrEnum):
    """In one word."""

    OK = "ok"  # images come and are tracked
    DEGRADED = "degraded"  # not now, but the server goes on trying, or a file has come to its end
    FAILED = "failed"  # it does not try any more: only a restart helps


class HealthMessage(Message):
    """Whether all is well, and what is not."""

    status: HealthState
    process: ProcessMessage | None
    """Null before the tracking process has said anything."""
    source: SourceMessage | None
    image_age_ms: float | None
    """Age of the newest image; null when there is none."""


def health_message(instant: Instant | None, *, now_s: float, stale_after_ms: float) -> HealthMessage:
    """Health at monotonic time `now_s`; images older than `stale_after_ms` are not well."""
    if instant is None:
        return HealthMessage(status=HealthState.DEGRADED, process=None, source=None, image_age_ms=None)
    snapshot = instant.snapshot
    age_ms = None if snapshot is None else (now_s - snapshot.captured_at_s) * 1000.0
    is_well = (
        instant.process.state is ProcessState.RUNNING
        and instant.source.state is SourceState.RUNNING
        and instant.process.problem is None
        and instant.source.problem is None
        and age_ms is not None
        and age_ms <= stale_after_ms
    )
    status = HealthState.OK if is_well else HealthState.DEGRADED
    if instant.process.state is ProcessState.GIVEN_UP:
        status = HealthState.FAILED
    return HealthMessage(
        status=status,
        process=process_message(instant.process),
        source=source_message(instant.source),
        image_age_ms=age_ms,
    )


def health_router(hub: LiveHub, *, stale_after_ms: float) -> APIRouter:
    """`GET /health`."""
    router = APIRouter(tags=["health"])

    @router.get(
        "/health",
        responses={503: {"model": HealthMessage, "description": "Tracking has been given up."}},
    )
    async def health(request: Request, response: Response) -> HealthMessage:
        """Whether all is well: `ok`, `degraded` (it goes on trying) or `failed`.

        Answers 200 as long as the server works and the tracking process lives or is being restarted: a
        camera that is unplugged is not mended by restarting the container. 503 when it was given up.
        Who is not signed in is told the one word alone.
        """
        message = health_message(hub.newest, now_s=time.monotonic(), stale_after_ms=stale_after_ms)
        response.status_code = 503 if message.status is HealthState.FAILED else 200
        response.headers["Cache-Control"] = "no-store"
        if person_of(request.scope) == NOBODY:
            return HealthMessage(status=message.status, process=None, source=None, image_age_ms=None)
        return message

    return router
