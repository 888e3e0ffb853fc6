"""Readout time of a rolling shutter: measured with a moving board, or taken from the data sheet."""

from typing import Annotated

from fastapi import APIRouter, Response
from pydantic import Field

from server.api.camera_messages import BoardMessage, board_message, board_of
from server.api.errors import rejections
from server.api.jobs import JobMessage, job_message
from server.api.requester import MadeBy
from server.camera_file import MAX_READOUT_MS
from server.procedure.readout import ReadoutSource, ReadoutStep
from server.procedure.readout_collection import BURST_IMAGES, BurstStage, BurstStatus
from server.stream.messages import Message, ProblemMessage, problem_message


class ReadoutMessage(Message):
    """Known readout time, and whether a burst of images exists."""

    collecting: bool
    readout_ms: float | None
    """Value in use; 0 for a global shutter. null if the calibration has none: the settings apply."""
    sd_ms: float | None
    """Standard deviation of the measurement."""
    found_by: ReadoutSource | None


class StatedReadoutRequest(Message):
    """Readout time from the data sheet."""

    readout_ms: Annotated[float, Field(ge=0.0, le=MAX_READOUT_MS, allow_inf_nan=False)] | None
    """0 for a global shutter, null for unknown."""
    made_by: MadeBy


class BurstRequest(Message):
    """The board to be moved."""

    board: BoardMessage


class BurstMessage(Message):
    """Progress of a burst."""

    board: BoardMessage
    stage: BurstStage
    taken_images: int
    read_images: int
    found_images: int
    images: int
    """Number of images of a burst."""
    problem: ProblemMessage | None


class ReadoutMeasureRequest(Message):
    """Who measures."""

    made_by: MadeBy


def readout_router(step: ReadoutStep) -> APIRouter:
    """Return the router of `/api/camera/readout`."""
    router = APIRouter(prefix="/api/camera/readout", tags=["camera"])

    @router.get("", responses=rejections(422, 503))
    def readout() -> ReadoutMessage:
        """Return the readout time of the calibration in the open case."""
        return _message(step)

    @router.put("", responses=rejections(409, 422, 503, 507))
    def state(requested: StatedReadoutRequest) -> ReadoutMessage:
        """Store a readout time from the data sheet, or that it is unknown, with the calibration.

        This creates a version of the calibration; documents depending on the previous one become out of date.
        """
        step.state(requested.readout_ms, made_by=requested.made_by)
        return _message(step)

    @router.post("/collection", status_code=201, responses=rejections(409, 422, 503))
    def begin(requested: BurstRequest) -> BurstMessage:
        """Wait for quick motion of this board, record a burst of images, and detect the board in them."""
        return _burst(step.begin(board_of(requested.board)).status)

    @router.get("/collection", responses=rejections(409))
    def progress() -> BurstMessage:
        """Return the progress of the burst."""
        return _burst(step.collection.status)

    @router.delete("/collection", status_code=204)
    def end() -> Response:
        """Stop and discard the burst."""
        step.end()
        return Response(status_code=204)

    @router.post("/measurement", status_code=202, responses=rejections(409, 422, 503))
    def measure(requested: ReadoutMeasureRequest) -> JobMessage:
        """Fit the readout time to the burst and store it with the calibration if the motion determines it.

        Returns the job; its result is the readout time with its standard deviation.
        """
        return job_message(step.measure(made_by=requested.made_by))

    return router


def _message(step: ReadoutStep) -> ReadoutMessage:
    stored = step.stored_readout()
    return ReadoutMessage(
        collecting=step.is_collecting,
        readout_ms=None if stored is None else stored.readout_ms,
        sd_ms=None if stored is None else stored.sd_ms,
        found_by=None if stored is None else stored.found_by,
    )


def _burst(status: BurstStatus) -> BurstMessage:
    return BurstMessage(
        board=board_message(status.board),
        stage=status.stage,
        taken_images=status.taken_images,
        read_images=status.read_images,
        found_images=status.found_images,
        images=BURST_IMAGES,
        problem=problem_message(status.problem),
    )
