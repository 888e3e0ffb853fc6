"""Markers of the open case: upload, list, show and remove."""

from typing import Annotated

from anyio import to_thread
from fastapi import APIRouter, Query, Request, Response

from server.api.case_messages import ImportedMessage, imported_message
from server.api.errors import rejections
from server.api.requester import MadeByQuery
from server.api.uploads import received
from server.config import Name
from server.image_file import png_bytes
from server.procedure.markers import KnownMarker, MarkerStep
from server.store import Home, NotFound
from server.stream.messages import Message

MAX_PICTURE_BYTES = 32 * 2**20
PICTURE_TYPES: dict[str, dict[str, object]] = {"image/png": {}, "image/jpeg": {}, "image/bmp": {}}
SideMm = Annotated[float, Query(gt=0.0, le=1000.0, allow_inf_nan=False)]


class KnownMarkerMessage(Message):
    """A marker of the tracker."""

    name: str
    side_mm: float | None
    """Outer side of the printed black square; null for a rigid body of an external tracker."""
    width_px: int | None
    """Size of its image, which is at `/api/markers/{name}/picture`; null for a rigid body, which has none."""
    height_px: int | None
    document_id: str | None
    """Its document in the open case; null for a marker of the settings."""
    made_at: str | None
    made_by: str | None
    imported: ImportedMessage | None


class KnownMarkersMessage(Message):
    """All markers of the tracker: first those of the settings, then those of the open case."""

    markers: list[KnownMarkerMessage]


def markers_router(step: MarkerStep, home: Home) -> APIRouter:
    """Return the router of `/api/markers`."""
    router = APIRouter(prefix="/api/markers", tags=["markers"])

    @router.get("", responses=rejections(503))
    def markers() -> KnownMarkersMessage:
        """Return the markers that the tracker detects now."""
        return KnownMarkersMessage(markers=[_message(known) for known in step.known()])

    @router.post(
        "",
        status_code=201,
        responses=rejections(409, 413, 422, 503, 507),
        openapi_extra={"requestBody": {"required": True, "content": PICTURE_TYPES}},
    )
    async def add(
        request: Request, name: Name, side_mm: SideMm, made_by: MadeByQuery, file: str = "sent"
    ) -> KnownMarkerMessage:
        """Add a marker from its image in the request body (PNG, JPEG or BMP), from the next image on.

        The black square must fill the image edge to edge. A marker of the same name is replaced, and tools
        calibrated with it become out of date; a marker of the settings is not replaced.
        """
        async with received(request, home, max_bytes=MAX_PICTURE_BYTES) as path:

            def add_marker() -> KnownMarkerMessage:
                step.add(name, side_mm=side_mm, picture=path, named=file[:100], made_by=made_by)
                return _message(step.one(name))

            return await to_thread.run_sync(add_marker)

    @router.get(
        "/{name}/picture",
        response_class=Response,
        responses={200: {"content": {"image/png": {}}}, **rejections(404, 503)},
    )
    def picture(name: str) -> Response:
        """Return the greyscale image of the marker, row 0 at the top."""
        model = step.one(name).model
        if model is None:
            raise NotFound(
                "MARKER_WITHOUT_IMAGE",
                f"'{name}' is a rigid body of an external tracker, which has no image",
                "GET /api/markers states which markers have one.",
                {"marker": name},
            )
        return Response(png_bytes(model.image), media_type="image/png")

    @router.delete("/{name}", status_code=204, responses=rejections(404, 409, 422, 503, 507))
    def remove(name: str, made_by: MadeByQuery) -> Response:
        """Remove a marker from the open case; tools calibrated with it become out of date."""
        step.remove(name, by=made_by)
        return Response(status_code=204)

    return router


def _message(known: KnownMarker) -> KnownMarkerMessage:
    height, width = (None, None) if known.model is None else known.model.image.shape
    document = known.document
    return KnownMarkerMessage(
        name=known.name,
        side_mm=known.side_mm,
        width_px=width,
        height_px=height,
        document_id=None if document is None else document.id,
        made_at=None if document is None else document.made_at,
        made_by=None if document is None else document.maker,
        imported=None
        if document is None
        else imported_message(document.imported, claimed_maker=document.made_by),
    )
