"""Camera calibration: collect views, fit the camera, store the result."""

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
    worded_calibration,
)
from server.api.case_messages import DocumentMessage, document_message
from server.api.errors import rejections
from server.api.jobs import JobMessage, job_message
from server.api.uploads import received
from server.image_file import decoded
from server.printing import board_sheet, pdf_from_sheet, svg_from_sheet
from server.procedure.camera import ACCURACY, MAIN_CAMERA, CameraStep
from server.store import Current, DocumentKind, Home
from tracker.errors import InvalidInput

MAX_IMAGE_BYTES = 64 * 2**20
IMAGE_TYPES: dict[str, dict[str, object]] = {"image/png": {}, "image/jpeg": {}}


def camera_router(step: CameraStep, home: Home) -> APIRouter:
    """Return the router of `/api/camera`."""
    router = APIRouter(prefix="/api/camera", tags=["camera"])

    @router.get("", responses=rejections(503))
    def camera() -> CameraStepMessage:
        """Return the camera calibration of the open case, and whether views are being collected."""
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
    def board(requested: BoardFileRequest) -> Response:
        """Return a calibration board as a sheet to print at 100 %, with rulers to check the scale."""
        sheet = board_sheet(board_of(requested.board), paper=requested.paper)
        if requested.file == "svg":
            return Response(svg_from_sheet(sheet), media_type="image/svg+xml")
        return Response(pdf_from_sheet(sheet), media_type="application/pdf")

    return router


def _add_calibration(router: APIRouter, step: CameraStep) -> None:
    @router.post("/calibration", status_code=202, responses=rejections(409, 422, 503))
    def calibrate(requested: CalibrationRequest) -> JobMessage:
        """Fit the camera to the collected views and store it in the open case if it passes its limits.

        Returns the job; its result is the report with the id of the document. The calibration is used from
        the next image on.
        """
        return job_message(step.calibrate(made_by=requested.made_by))

    @router.get("/calibration", responses=rejections(409, 503))
    def calibration() -> DocumentMessage:
        """Return the valid calibration of the open case with its report.

        Its plots (residuals, coverage) are the files in `plots`: `/api/cases/{id}/files/{file}`.
        """
        message = document_message(step.calibration(), Current())
        return message.model_copy(update={"content": worded_calibration(message.content)})

    @router.post("/accuracy", status_code=201, responses=rejections(409, 422, 503, 507))
    def accuracy(requested: AccuracyRequest) -> DocumentMessage:
        """Measure known displacements on a board in the live image, as in Table 2 of the paper.

        The pose of the board is fitted to other points than the measured ones. The result is stored even if
        it exceeds the limit.
        """
        document = step.check_accuracy(board_of(requested.board), made_by=requested.made_by)
        return document_message(document, Current())


def _add_collection(router: APIRouter, step: CameraStep, home: Home) -> None:
    @router.post("/collection", status_code=201, responses=rejections(409, 422))
    def begin(requested: CollectionRequest) -> CollectionMessage:
        """Start collecting views of a board from the live images; still views that add information are taken.

        Views collected before are discarded.
        """
        return collection_message(step.begin(board_of(requested.board)))

    @router.get("/collection", responses=rejections(409))
    def progress() -> CollectionMessage:
        """Return the progress of the collection, what is missing, and the last detection of the board."""
        return collection_message(step.collection)

    @router.delete("/collection", status_code=204)
    def end() -> Response:
        """Stop collecting and discard the views."""
        step.end()
        return Response(status_code=204)

    @router.post(
        "/collection/images",
        status_code=201,
        responses=rejections(409, 413, 422, 503, 507),
        openapi_extra={"requestBody": {"required": True, "content": IMAGE_TYPES}},
    )
    async def add_image(request: Request, name: str = "sent") -> CollectionMessage:
        """Add a view from an image in the request body (PNG or JPEG)."""
        collection = step.collection
        async with received(request, home, max_bytes=MAX_IMAGE_BYTES) as path:
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
            f"{name} is not a readable image ({len(content)} bytes)",
            "Send an original PNG or JPEG of the camera, neither cropped nor scaled.",
            {"image": name, "size_bytes": len(content)},
        )
    return picture
