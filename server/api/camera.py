"""Calibrating the camera: views collected from the live images or sent, then the camera fitted and kept."""

import cv2
import numpy as np
import numpy.typing as npt
from anyio import to_thread
from fastapi import APIRouter, Request, Response

from server.api.camera_messages import (
    CalibrationRequest,
    CollectionMessage,
    CollectionRequest,
    board_of,
    collection_message,
)
from server.api.errors import refusals
from server.api.jobs import JobMessage, job_message
from server.api.uploads import received
from server.procedure.camera import CameraStep
from server.store import Home
from tracker.errors import InvalidInput

# A picture that its file says to turn must not be: the lens was not turned.
AS_THE_CAMERA_MADE_IT = cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION
LARGEST_IMAGE_BYTES = 64 * 2**20
IMAGE_TYPES: dict[str, dict[str, object]] = {"image/png": {}, "image/jpeg": {}}


def camera_router(step: CameraStep, home: Home) -> APIRouter:
    """Everything under `/api/camera`."""
    router = APIRouter(prefix="/api/camera", tags=["camera"])
    _add_collection(router, step, home)

    @router.post("/calibration", status_code=202, responses=refusals(409, 422, 503))
    def calibrate(asked: CalibrationRequest) -> JobMessage:
        """Fit the camera to the collected views; what passes the gate is kept in the open case.

        Answers the job; its result is the report, with the id of the document. The camera is used from the
        next image on.
        """
        return job_message(step.calibrate(made_by=asked.made_by))

    return router


def _add_collection(router: APIRouter, step: CameraStep, home: Home) -> None:
    @router.post("/collection", status_code=201, responses=refusals(422))
    def begin(asked: CollectionRequest) -> CollectionMessage:
        """Collect views of a board from the live images; one is taken when it holds still and adds something.

        What was collected before is thrown away.
        """
        return collection_message(step.begin(board_of(asked.board)))

    @router.get("/collection", responses=refusals(409))
    def progress() -> CollectionMessage:
        """How far it has come, what is missing, and where the board was seen just now."""
        return collection_message(step.collection)

    @router.delete("/collection", status_code=204)
    def end() -> Response:
        """Collect no more; what was collected is thrown away."""
        step.end()
        return Response(status_code=204)

    @router.post(
        "/collection/images",
        status_code=201,
        responses=refusals(409, 413, 422, 503, 507),
        openapi_extra={"requestBody": {"required": True, "content": IMAGE_TYPES}},
    )
    async def add_image(request: Request, name: str = "sent") -> CollectionMessage:
        """Add the view in an image, which is the body of the request (PNG or JPEG)."""
        collection = step.collection
        async with received(request, home, most_bytes=LARGEST_IMAGE_BYTES) as path:
            content = await to_thread.run_sync(path.read_bytes)
        await to_thread.run_sync(lambda: collection.add(_picture(content, name[:100]), name=name[:100]))
        return collection_message(collection)


def _picture(content: bytes, name: str) -> npt.NDArray[np.uint8]:
    picture = cv2.imdecode(np.frombuffer(content, dtype=np.uint8), AS_THE_CAMERA_MADE_IT)
    if picture is None:
        raise InvalidInput(
            "IMAGE_UNREADABLE",
            f"{name} is no picture ({len(content)} bytes)",
            "Send a PNG or JPEG as the camera made it, neither cut nor scaled.",
            {"image": name, "size_bytes": len(content)},
        )
    return np.asarray(picture, dtype=np.uint8)
