"""Calibrating the camera: views collected from the live images or sent, then the camera fitted and kept."""

import numpy as np
import numpy.typing as npt
from anyio import to_thread
from fastapi import APIRouter, Request, Response

from server.api.camera_messages import (
    AccuracyRequest,
    BoardFileRequest,
    CalibrationRequest,
    CameraStepMessage,
    CollectionMessage,
    CollectionRequest,
    board_of,
    collection_message,
)
from server.api.case_messages import DocumentMessage, document_message
from server.api.errors import rejections
from server.api.jobs import JobMessage, job_message
from server.api.uploads import received
from server.picture_file import decoded
from server.printing import board_sheet, pdf_from_sheet, svg_from_sheet
from server.procedure.camera import ACCURACY, MAIN_CAMERA, CameraStep
from server.store import Current, DocumentKind, Home
from tracker.errors import InvalidInput

LARGEST_IMAGE_BYTES = 64 * 2**20
IMAGE_TYPES: dict[str, dict[str, object]] = {"image/png": {}, "image/jpeg": {}}


def camera_router(step: CameraStep, home: Home) -> APIRouter:
    """Everything under `/api/camera`."""
    router = APIRouter(prefix="/api/camera", tags=["camera"])

    @router.get("", responses=rejections(503))
    def camera() -> CameraStepMessage:
        """What the open case has of the camera, and whether views are being collected."""
        return CameraStepMessage(
            collecting=step.is_collecting,
            calibration=_newest(step, DocumentKind.CAMERA, MAIN_CAMERA),
            accuracy=_newest(step, DocumentKind.CHECK, ACCURACY),
        )

    _add_collection(router, step, home)
    _add_calibration(router, step)

    @router.post(
        "/board",
        response_class=Response,
        responses={200: {"content": {"application/pdf": {}, "image/svg+xml": {}}}, **rejections(422)},
    )
    def board(asked: BoardFileRequest) -> Response:
        """A board as a page to print at 100 %, with rulers to check the printer."""
        sheet = board_sheet(board_of(asked.board), paper=asked.paper)
        if asked.file == "svg":
            return Response(svg_from_sheet(sheet), media_type="image/svg+xml")
        return Response(pdf_from_sheet(sheet), media_type="application/pdf")

    return router


def _add_calibration(router: APIRouter, step: CameraStep) -> None:
    @router.post("/calibration", status_code=202, responses=rejections(409, 422, 503))
    def calibrate(asked: CalibrationRequest) -> JobMessage:
        """Fit the camera to the collected views; what passes the gate is kept in the open case.

        Answers the job; its result is the report, with the id of the document. The camera is used from the
        next image on.
        """
        return job_message(step.calibrate(made_by=asked.made_by))

    @router.get("/calibration", responses=rejections(409, 503))
    def calibration() -> DocumentMessage:
        """The calibration of the open case with its report; refused where there is none that holds.

        Its pictures (residuals, coverage) are the files that `plots` names: `/api/cases/{id}/files/{file}`.
        """
        return document_message(step.kept(), Current())

    @router.post("/accuracy", status_code=201, responses=rejections(409, 422, 503, 507))
    def accuracy(asked: AccuracyRequest) -> DocumentMessage:
        """Measure known displacements on a board that is in the picture now, as in the paper's Table 2.

        The place of the board is fitted to other points than those that are measured. What came out is kept,
        also when it does not pass.
        """
        document = step.check_accuracy(board_of(asked.board), made_by=asked.made_by)
        return document_message(document, Current())


def _add_collection(router: APIRouter, step: CameraStep, home: Home) -> None:
    @router.post("/collection", status_code=201, responses=rejections(422))
    def begin(asked: CollectionRequest) -> CollectionMessage:
        """Collect views of a board from the live images; one is taken when it holds still and adds something.

        What was collected before is thrown away.
        """
        return collection_message(step.begin(board_of(asked.board)))

    @router.get("/collection", responses=rejections(409))
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
        responses=rejections(409, 413, 422, 503, 507),
        openapi_extra={"requestBody": {"required": True, "content": IMAGE_TYPES}},
    )
    async def add_image(request: Request, name: str = "sent") -> CollectionMessage:
        """Add the view in an image, which is the body of the request (PNG or JPEG)."""
        collection = step.collection
        async with received(request, home, max_bytes=LARGEST_IMAGE_BYTES) as path:
            content = await to_thread.run_sync(path.read_bytes)
        await to_thread.run_sync(lambda: collection.add(_picture(content, name[:100]), name=name[:100]))
        return collection_message(collection)


def _newest(step: CameraStep, kind: DocumentKind, name: str) -> DocumentMessage | None:
    found = step.newest(kind, name)
    return None if found is None else document_message(*found)


def _picture(content: bytes, name: str) -> npt.NDArray[np.uint8]:
    picture = decoded(content)
    if picture is None:
        raise InvalidInput(
            "IMAGE_UNREADABLE",
            f"{name} is no picture ({len(content)} bytes)",
            "Send a PNG or JPEG as the camera made it, neither cut nor scaled.",
            {"image": name, "size_bytes": len(content)},
        )
    return picture
