"""Health of the server, for container health checks and for people."""

import time
from collections.abc import Callable, Sequence
from enum import StrEnum

from fastapi import APIRouter, Request, Response

from server.live import Instant, LiveHub, ProcessState, SourceState
from server.security import ANONYMOUS, person_of
from server.sinks import SinkStatus
from server.stream.messages import (
    Message,
    ProblemMessage,
    ProcessMessage,
    SourceMessage,
    problem_message,
    process_message,
    source_message,
)


class HealthState(StrEnum):
    """Overall health."""

    OK = "ok"  # images arrive and are tracked
    DEGRADED = "degraded"  # no tracking now, but the server keeps trying; or a file has ended
    FAILED = "failed"  # no further attempts: a restart is needed


class SinkMessage(Message):
    """State of a plug-in that receives each message. Navigation does not depend on it."""

    name: str
    problem: ProblemMessage | None
    """null while it works."""
    messages: int
    """Number of messages sent to it."""
    skipped: int
    """Number of instants not sent to it because it was not ready."""


class HealthMessage(Message):
    """Health of the server, with the state of tracking process and image source."""

    status: HealthState
    process: ProcessMessage | None
    """null before the first message of the tracking process."""
    source: SourceMessage | None
    image_age_ms: float | None
    """Age of the newest image; null if there is none."""
    sinks: list[SinkMessage]
    """Plug-ins that receive each message; they do not change `status`."""


def health_message(
    instant: Instant | None, *, now_s: float, stale_after_ms: float, sinks: Sequence[SinkStatus] = ()
) -> HealthMessage:
    """Return the health at monotonic time `now_s`; images older than `stale_after_ms` degrade it."""
    stated = [
        SinkMessage(
            name=sink.name,
            problem=problem_message(sink.problem),
            messages=sink.messages,
            skipped=sink.skipped,
        )
        for sink in sinks
    ]
    if instant is None:
        return HealthMessage(
            status=HealthState.DEGRADED, process=None, source=None, image_age_ms=None, sinks=stated
        )
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
        sinks=stated,
    )


def health_router(
    hub: LiveHub, *, stale_after_ms: float, sinks: Callable[[], Sequence[SinkStatus]] = lambda: ()
) -> APIRouter:
    """Return the router of `GET /health`."""
    router = APIRouter(tags=["health"])

    @router.get(
        "/health",
        responses={503: {"model": HealthMessage, "description": "All restarts of tracking have failed."}},
    )
    async def health(request: Request, response: Response) -> HealthMessage:
        """Return the health: `ok`, `degraded` (the server keeps trying) or `failed`.

        200 while the tracking process runs or is being restarted, because a restart of the container does not
        repair an unplugged camera; 503 after the restarts have failed. Without sign-in only the status is
        returned.
        """
        message = health_message(
            hub.newest, now_s=time.monotonic(), stale_after_ms=stale_after_ms, sinks=sinks()
        )
        response.status_code = 503 if message.status is HealthState.FAILED else 200
        response.headers["Cache-Control"] = "no-store"
        if person_of(request.scope) == ANONYMOUS:
            return HealthMessage(
                status=message.status, process=None, source=None, image_age_ms=None, sinks=[]
            )
        return message

    return router
