"""The surface of the bone: made out of the CT or sent, and given out as PLY."""

from typing import Annotated, Literal

from anyio import to_thread
from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import FileResponse
from pydantic import Field

from server.api.case_messages import DocumentMessage, document_message
from server.api.ct_messages import PointLps
from server.api.doing import MadeBy, MadeByQuery
from server.api.errors import rejections
from server.api.jobs import JobMessage, job_message
from server.api.pictures import KEEP
from server.api.uploads import received
from server.planning.surface import MeshOrder
from server.procedure.surface import BoneOrder, SurfaceStep
from server.store import CaseStore, Home
from server.stream.messages import Message
from tracker.plan.mesh.intake import Space

LARGEST_MESH_BYTES = 100 * 2**20
PLY = "model/ply"
MESH_TYPES: dict[str, dict[str, object]] = {"model/stl": {}, "model/obj": {}, PLY: {}}


class RegionMessage(Message):
    """A box along the patient's axes."""

    low_lps_mm: PointLps
    high_lps_mm: PointLps


class BoneRequest(Message):
    """How the surface shall be made; what is left out is chosen by the program."""

    made_by: MadeBy
    threshold_hu: Annotated[float, Field(ge=-1024.0, le=4000.0, allow_inf_nan=False)] | None = None
    """From where on a voxel is bone."""
    region: RegionMessage | None = None
    """The whole CT if left out."""
    largest_part_only: bool = True
    smoothing_rounds: Annotated[int, Field(ge=0, le=200)] = 10
    max_faces: Annotated[int, Field(ge=100, le=2_000_000)] = 60_000


def surface_router(step: SurfaceStep, store: CaseStore, home: Home) -> APIRouter:
    """Everything under `/api/surface`. Plain functions: they wait for the disk, in threads."""
    router = APIRouter(prefix="/api", tags=["surface"])
    _add_making(router, step, home)

    @router.get("/surface", responses=rejections(409, 503))
    def surface() -> DocumentMessage:
        """The surface of the open case: how it was made, how large it is, and what to know of it."""
        document, _ = step.latest()
        return document_message(document, store.standing(document))

    @router.get(
        "/surface.ply",
        response_class=FileResponse,
        responses={200: {"content": {PLY: {}}}, **rejections(409, 503)},
    )
    def triangles(request: Request) -> Response:
        """Its triangles, binary PLY in mm of LPS."""
        _, file = step.latest()
        headers = {"ETag": f'"{file.sha256[:32]}"', "Cache-Control": KEEP}
        if headers["ETag"] in request.headers.get("if-none-match", ""):
            return Response(status_code=304, headers=headers)
        return FileResponse(file.path, media_type=PLY, filename="surface.ply", headers=headers)

    return router


def _add_making(router: APIRouter, step: SurfaceStep, home: Home) -> None:
    @router.post("/surface/from-ct", status_code=202, responses=rejections(409, 422, 503, 507))
    def from_ct(asked: BoneRequest) -> JobMessage:
        """Make the surface of the bone in the CT of the open case, in a job."""
        region = asked.region
        order = BoneOrder(
            threshold_hu=asked.threshold_hu,
            region_lps_mm=None if region is None else (region.low_lps_mm, region.high_lps_mm),
            largest_part_only=asked.largest_part_only,
            smoothing_rounds=asked.smoothing_rounds,
            max_faces=asked.max_faces,
        )
        return job_message(step.from_ct(order, made_by=asked.made_by))

    @router.post(
        "/surface",
        status_code=202,
        responses=rejections(409, 413, 422, 503, 507),
        openapi_extra={"requestBody": {"required": True, "content": MESH_TYPES}},
    )
    async def send(
        request: Request,
        made_by: MadeByQuery,
        unit: Literal["mm", "cm", "m", "inch", "um"] | None = None,
        space: Space | None = None,
        file_format: Annotated[Literal["stl", "obj", "ply"] | None, Query(alias="format")] = None,
    ) -> JobMessage:
        """Send a surface, which is the body of the request: STL, OBJ or PLY; it is read in a job.

        Where its numbers cannot be a vertebra's in mm, the job refuses it and proposes a unit; nothing is
        scaled that was not asked for.
        """
        await to_thread.run_sync(step.reject_without_case)
        order = MeshOrder(file_format=file_format, unit=unit, space=space)
        async with received(request, home, max_bytes=LARGEST_MESH_BYTES) as path:
            job = await to_thread.run_sync(lambda: step.from_mesh(path, order, made_by=made_by))
        return job_message(job)
