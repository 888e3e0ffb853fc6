"""Latency measurement from exposure to display: codes on the page are read in the camera images and timed."""

import time

from fastapi import APIRouter, Response

from server.api.errors import rejections
from server.api.latency_messages import (
    LatencyCodesMessage,
    LatencyCodesRequest,
    LatencyConclusionRequest,
    LatencyMessage,
    LatencyReadingMessage,
    LatencyResultMessage,
    codes_message,
    page_times,
    reading_message,
    result_message,
)
from server.procedure.latency import LatencyStep


def latency_router(step: LatencyStep) -> APIRouter:
    """Return the router of `/api/latency`."""
    router = APIRouter(prefix="/api/latency", tags=["camera"])

    @router.get("", responses=rejections(503))
    def latency() -> LatencyMessage:
        """Return the last latency measurement of this camera."""
        result = step.newest()
        return LatencyMessage(
            measuring=step.is_collecting,
            result=None if result is None else result_message(result),
            applies=result is not None and step.applies(result),
        )

    @router.post("/measurement", status_code=201, responses=rejections(409, 422, 503))
    def begin(requested: LatencyCodesRequest) -> LatencyCodesMessage:
        """Start reading codes in the live images, and return the codes that the page has to show.

        A previous unconcluded measurement is discarded. The measurement ends when it is concluded or deleted,
        after 5 s without a progress request, and when the open case changes.
        """
        return codes_message(step.begin(requested.codes))

    @router.get("/measurement", responses=rejections(409))
    async def reading() -> LatencyReadingMessage:
        """Return the number of images with a code, and the clock of the server."""
        return reading_message(step.collection, now_s=time.monotonic())

    @router.delete("/measurement", status_code=204)
    def end() -> Response:
        """Stop reading and discard the measurement."""
        step.end()
        return Response(status_code=204)

    @router.post("/measurement/conclusion", status_code=201, responses=rejections(409, 422, 503, 507))
    def conclude(requested: LatencyConclusionRequest) -> LatencyResultMessage:
        """Compute the latency from the displayed codes and images, and store the result.

        Rejected if too few codes could be timed or too many images were skipped. The measurement ends in
        both cases.
        """
        return result_message(step.conclude(page_times(requested), made_by=requested.made_by))

    return router
