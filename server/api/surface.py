"""Bone surface: extracted from the CT or uploaded, and downloaded as PLY."""

from typing import Annotated, Literal

from anyio import to_thread
from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import FileResponse
from pydantic import Field

from server.api.case_messages import DocumentMessage, document_message
from server.api.ct_messages import PointLps
from server.api.errors import rejections
from server.api.jobs import JobMessage, job_message
from server.api.requester import MadeBy, MadeByQuery
from server.api.revalidation import unless_known
from server.api.uploads import received
from server.planning.surface import MeshRequest
from server.procedure.surface import BoneSurfaceRequest, SurfaceStep
from server.store import CaseStore, Home
from server.stream.messages import Message
from tracker.plan.mesh.intake import Space

MAX_MESH_BYTES = 100 * 2**20
PLY = "model/ply"
MESH_TYPES: dict[str, dict[str, object]] = {"model/stl": {}, "model/obj": {}, PLY: {}}


class RegionMessage(Message):
    """A box along the patient axes."""

    low_lps_mm: PointLps
    high_lps_mm: PointLps


class BoneRequest(Message):
    """Parameters of the surface extraction; omitted values are chosen automatically."""

    made_by: MadeBy
    threshold_hu: Annotated[float, Field(ge=-1024.0, le=4000.0, allow_inf_nan=False)] | None = None
    """Threshold for bone."""
    region: RegionMessage | None = None
    """Default: the whole CT."""
    largest_part_only: bool = True
    smoothing_rounds: Annotated[int, Field(ge=0, le=200)] = 10
    max_faces: Annotated[int, Field(ge=100, le=2_000_000)] = 60_000


def surface_router(step: SurfaceStep, store: CaseStore, home: Home) -> APIRouter:
    """Return the router of `/api/surface`. Its routes are synchronous because they wait for the disk."""
    router = APIRouter(prefix="/api", tags=["surface"])
    _add_making(router, step, home)

    @router.get("/surface", responses=rejections(409, 503))
    def surface() -> DocumentMessage:
        """Return the surface of the open case: origin, size and warnings."""
        document, _ = step.latest()
        return document_message(document, store.validity(document))

    @router.get(
        "/surface.ply",
        response_class=FileResponse,
        responses={200: {"content": {PLY: {}}}, **rejections(409, 503)},
    )
    def triangles(request: Request) -> Response:
        """Return its triangles as binary PLY in mm (LPS)."""
        _, file = step.latest()
        return unless_known(
            request,
            file.sha256[:32],
            lambda headers: FileResponse(file.path, media_type=PLY, filename="surface.ply", headers=headers),
        )

    return router


def _add_making(router: APIRouter, step: SurfaceStep, home: Home) -> None:
    @router.post("/surface/from-ct", status_code=202, responses=rejections(409, 422, 503, 507))
    def from_ct(requested: BoneRequest) -> JobMessage:
        """Extract the bone surface from the CT of the open case, in a job."""
        region = requested.region
        order = BoneSurfaceRequest(
            threshold_hu=requested.threshold_hu,
            region_lps_mm=None if region is None else (region.low_lps_mm, region.high_lps_mm),
            largest_part_only=requested.largest_part_only,
            smoothing_rounds=requested.smoothing_rounds,
            max_faces=requested.max_faces,
        )
        return job_message(step.from_ct(order, made_by=requested.made_by))

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
        """Upload a surface in the request body: STL, OBJ or PLY; a job reads it.

        If its size is implausible for a vertebra in mm, the job rejects it and proposes a unit; it is never
        scaled without a request.
        """
        await to_thread.run_sync(step.reject_without_case)
        order = MeshRequest(file_format=file_format, unit=unit, space=space)
        async with received(request, home, max_bytes=MAX_MESH_BYTES) as path:
            job = await to_thread.run_sync(lambda: step.from_mesh(path, order, made_by=made_by))
        return job_message(job)
