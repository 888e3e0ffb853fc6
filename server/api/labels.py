"""Labels of vertebrae: upload of a segmentation, and download in the voxels of the CT."""

from typing import Annotated

from anyio import to_thread
from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import FileResponse

from server.api.case_messages import heading_message
from server.api.errors import rejections
from server.api.jobs import JobMessage, job_message
from server.api.label_messages import LabelsMessage, labels_message
from server.api.requester import MadeByQuery
from server.api.revalidation import unless_known
from server.api.uploads import received
from server.procedure.labels import LabelStep
from server.store import CaseStore, Home

# As for a CT, of which a segmentation is a part.
MAX_LABELS_BYTES = 4 * 2**30
GZIP = "application/gzip"
LABEL_TYPES: dict[str, dict[str, object]] = {"application/zip": {}, "application/octet-stream": {}}


def labels_router(step: LabelStep, store: CaseStore, home: Home) -> APIRouter:
    """Return the router of `/api/labels`. Its routes are synchronous because they wait for the disk."""
    router = APIRouter(prefix="/api", tags=["labels"])

    @router.post(
        "/labels",
        status_code=202,
        responses=rejections(409, 413, 422, 503, 507),
        openapi_extra={"requestBody": {"required": True, "content": LABEL_TYPES}},
    )
    async def send(
        request: Request, made_by: MadeByQuery, names: Annotated[str, Query(max_length=4000)] = ""
    ) -> JobMessage:
        """Upload a segmentation of the vertebrae in the CT of the open case, in the request body.

        NIfTI with all labels, DICOM SEG, or a zip of files `vertebrae_L3.nii.gz` of TotalSegmentator. A job
        reads it, resamples it to the CT, and checks it. `names` states the levels of labels that the file
        does not name, as `29:L3,28:L4`; without it and without names in the file, the numbers of
        TotalSegmentator v2 apply.
        """
        await to_thread.run_sync(step.reject_without_ct)
        async with received(request, home, max_bytes=MAX_LABELS_BYTES) as path:
            return job_message(
                await to_thread.run_sync(lambda: step.receive(path, names=names, made_by=made_by))
            )

    @router.get("/labels", responses=rejections(409, 503))
    def labels() -> LabelsMessage:
        """Return the labels of the open case: levels, volumes, positions and warnings."""
        document, _ = step.latest()
        return labels_message(heading_message(document, store.validity(document)), document.content)

    @router.get(
        "/labels.nii.gz",
        response_class=FileResponse,
        responses={200: {"content": {GZIP: {}}}, **rejections(409, 503)},
    )
    def labels_file(request: Request) -> Response:
        """Return the labels in the voxels of the CT as NIfTI, with the numbers of TotalSegmentator v2."""
        _, file = step.latest()
        return unless_known(
            request,
            file.sha256[:32],
            lambda headers: FileResponse(
                file.path, media_type=GZIP, filename="labels.nii.gz", headers=headers
            ),
        )

    return router
