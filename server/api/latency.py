"""Measuring the latency from light to page: codes on the page, read in the camera's images, and timed."""

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
    """Everything under `/api/latency`."""
    router = APIRouter(prefix="/api/latency", tags=["camera"])

    @router.get("", responses=rejections(503))
    def latency() -> LatencyMessage:
        """The latency as it was measured last with this camera."""
        result = step.newest()
        return LatencyMessage(
            measuring=step.is_measuring, result=None if result is None else result_message(result)
        )

    @router.post("/measurement", status_code=201, responses=rejections(422, 503))
    def begin(asked: LatencyCodesRequest) -> LatencyCodesMessage:
        """Read codes in the live images from now on, and say which codes the page is to show.

        What was measured before and not concluded is thrown away. It ends with a conclusion, when it is
        deleted, when nobody asks after it for 5 s, and when the open case changes.
        """
        return codes_message(step.begin(asked.codes))

    @router.get("/measurement", responses=rejections(409))
    async def reading() -> LatencyReadingMessage:
        """In how many images a code was read, and the server's clock."""
        return reading_message(step.measurement, now_s=time.monotonic())

    @router.delete("/measurement", status_code=204)
    def end() -> Response:
        """Read no more; what was read is thrown away."""
        step.end()
        return Response(status_code=204)

    @router.post("/measurement/conclusion", status_code=201, responses=rejections(409, 422, 503, 507))
    def conclude(asked: LatencyConclusionRequest) -> LatencyResultMessage:
        """Time the codes that the page painted by the images that it showed, and keep the result.

        Refused where too few codes could be timed or too many images were skipped; the measurement ends in
        either case.
        """
        return result_message(step.conclude(page_times(asked), made_by=asked.made_by))

    return router
