"""Labels of vertebrae: upload of a segmentation, and download in the voxels of the CT."""

from typing import Annotated

import numpy as np
from anyio import to_thread
from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import FileResponse

from server.api.case_messages import heading_message
from server.api.ct_messages import Coordinate
from server.api.errors import rejections
from server.api.jobs import JobMessage, job_message
from server.api.label_messages import (
    ChannelLevelsMessage,
    LabelOutlinesMessage,
    LabelsMessage,
    StartPointsMessage,
    channel_levels_message,
    labels_message,
    outlines_message,
    start_points_message,
)
from server.api.requester import MadeByQuery
from server.api.revalidation import unless_known
from server.api.uploads import received
from server.procedure.labels import LabelStep
from server.procedure.plan import PlanStep
from server.store import CaseStore, Home

# As for a CT, of which a segmentation is a part.
MAX_LABELS_BYTES = 4 * 2**30
# No slice of a CT has more columns or rows.
MAX_SLICE_PX = 2048
GZIP = "application/gzip"
LABEL_TYPES: dict[str, dict[str, object]] = {"application/zip": {}, "application/octet-stream": {}}


def labels_router(step: LabelStep, plan: PlanStep, store: CaseStore, home: Home) -> APIRouter:
    """Return the router of `/api/labels`. Its routes are synchronous because they wait for the disk."""
    router = APIRouter(prefix="/api", tags=["labels"])
    _add_use(router, step, plan)

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


def _add_use(router: APIRouter, step: LabelStep, plan: PlanStep) -> None:
    @router.get("/labels/starts/{level}", responses=rejections(409, 503))
    def starts(level: str) -> StartPointsMessage:
        """Return start points for the measurement of both pedicles of a level, from its label."""
        return start_points_message(level, step.start_points(level))

    @router.get("/labels/channels", responses=rejections(409, 503))
    def channels() -> ChannelLevelsMessage:
        """Return in the label of which level each planned channel lies."""
        return channel_levels_message(plan.repository.channel_levels())

    @router.get("/labels/outlines", responses=rejections(409, 503))
    def outlines(
        lps_from_px: Annotated[list[Coordinate], Query(min_length=9, max_length=9)],
        width_px: Annotated[int, Query(ge=1, le=MAX_SLICE_PX)],
        height_px: Annotated[int, Query(ge=1, le=MAX_SLICE_PX)],
    ) -> LabelOutlinesMessage:
        """Return the outlines of the labels in a slice of the CT, by the geometry of a `SliceMessage`.

        `lps_from_px` is its 3x3 matrix, row by row.
        """
        return outlines_message(step.outlines(np.array(lps_from_px).reshape(3, 3), (width_px, height_px)))
