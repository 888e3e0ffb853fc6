"""The readout time of the camera's rows: measured with a moving board, or stated."""

from typing import Annotated

from fastapi import APIRouter, Response
from pydantic import Field

from server.api.camera_messages import BoardMessage, board_message, board_of
from server.api.doing import MadeBy
from server.api.errors import rejections
from server.api.jobs import JobMessage, job_message
from server.camera_file import LONGEST_READOUT_MS
from server.procedure.readout import FoundBy, ReadoutStep
from server.procedure.readout_collection import BURST_IMAGES, BurstStage, BurstStatus
from server.stream.messages import Message, ProblemMessage, problem_message


class ReadoutMessage(Message):
    """What is known of the readout, and whether a burst is held."""

    collecting: bool
    readout_ms: float | None
    """Tracked with; 0 of a global shutter. Null where the calibration has none: the settings' then counts."""
    sd_ms: float | None
    """Standard deviation of the measurement."""
    found_by: FoundBy | None


class StatedReadoutRequest(Message):
    """What a person says of the readout."""

    readout_ms: Annotated[float, Field(ge=0.0, le=LONGEST_READOUT_MS, allow_inf_nan=False)] | None
    """Out of the data sheet; 0 of a global shutter, null for not known."""
    made_by: MadeBy


class BurstRequest(Message):
    """The board that will be moved."""

    board: BoardMessage


class BurstMessage(Message):
    """How far a burst has come."""

    board: BoardMessage
    stage: BurstStage
    taken_images: int
    read_images: int
    found_images: int
    images: int
    """That a burst has."""
    problem: ProblemMessage | None


class ReadoutMeasureRequest(Message):
    """Who measures."""

    made_by: MadeBy


def readout_router(step: ReadoutStep) -> APIRouter:
    """Everything under `/api/camera/readout`."""
    router = APIRouter(prefix="/api/camera/readout", tags=["camera"])

    @router.get("", responses=rejections(422, 503))
    def readout() -> ReadoutMessage:
        """What the calibration of the open case says of it."""
        return _message(step)

    @router.put("", responses=rejections(409, 422, 503, 507))
    def state(asked: StatedReadoutRequest) -> ReadoutMessage:
        """Keep a readout time out of the data sheet with the calibration, or that it is not known.

        This is a new version of the calibration: what stands on the one before is out of date.
        """
        step.state(asked.readout_ms, made_by=asked.made_by)
        return _message(step)

    @router.post("/collection", status_code=201, responses=rejections(409, 422, 503))
    def begin(asked: BurstRequest) -> BurstMessage:
        """Wait for this board to be moved quickly, take a burst of images, and look for the board in them."""
        return _burst(step.begin(board_of(asked.board)).status)

    @router.get("/collection", responses=rejections(409))
    def progress() -> BurstMessage:
        """How far it has come."""
        return _burst(step.collection.status)

    @router.delete("/collection", status_code=204)
    def end() -> Response:
        """Take no more; what was taken is thrown away."""
        step.end()
        return Response(status_code=204)

    @router.post("/measurement", status_code=202, responses=rejections(409, 422, 503))
    def measure(asked: ReadoutMeasureRequest) -> JobMessage:
        """Fit the readout to the burst, and keep it with the calibration where the motion determines it.

        Answers the job; its result is the readout with its standard deviation.
        """
        return job_message(step.measure(made_by=asked.made_by))

    return router


def _message(step: ReadoutStep) -> ReadoutMessage:
    kept = step.kept()
    return ReadoutMessage(
        collecting=step.is_collecting,
        readout_ms=None if kept is None else kept.readout_ms,
        sd_ms=None if kept is None else kept.sd_ms,
        found_by=None if kept is None else kept.found_by,
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
