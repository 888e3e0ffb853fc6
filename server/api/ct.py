"""CT: upload, import and slices."""

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
import numpy.typing as npt
from anyio import to_thread
from fastapi import APIRouter, Depends, Query, Request, Response
from fastapi.responses import FileResponse

from server.api.case_messages import heading_message
from server.api.ct_messages import (
    CtMessage,
    ProbeMessage,
    ProbeRequest,
    SliceMessage,
    UploadMessage,
    ct_message,
    slice_message,
    upload_message,
)
from server.api.errors import STATUS_OF, rejections
from server.api.requester import MadeByQuery
from server.api.slice_images import (
    HU,
    PNG,
    PNG_ANSWER,
    SLICE_ANSWER,
    SLICE_CT,
    SLICE_PLACE,
    PixelMm,
    SizeMm,
    SlabMm,
    WindowHu,
    image_with_headers,
    point_from_query,
    window_from_query,
)
from server.api.uploads import received
from server.procedure.ct import CtProvider, CtStep, MappedCt, UploadUnknown
from server.store import Current, Home
from tracker.plan import Channel, Volume
from tracker.plan.slices import (
    Plane,
    Slice,
    Window,
    across_channel,
    along_channel,
    patient_slice,
    reach_mm,
    shown,
)

STATUS_OF[UploadUnknown] = 404
MAX_CT_BYTES = 4 * 2**30
CT_TYPES: dict[str, dict[str, object]] = {"application/zip": {}, "application/octet-stream": {}}
View = Literal["along", "across"]
Degrees = Annotated[float, Query(ge=-360.0, le=360.0, allow_inf_nan=False)]
DepthMm = Annotated[float, Query(ge=-500.0, le=500.0, allow_inf_nan=False)]
AtMm = Annotated[float, Query(ge=-10_000.0, le=10_000.0, allow_inf_nan=False)]


def ct_router(step: CtStep, opened: CtProvider, home: Home) -> APIRouter:
    """Return the router of `/api/ct`. Its routes are synchronous because they read from the disk."""
    router = APIRouter(prefix="/api/ct", tags=["ct"])
    _add_uploads(router, step, home)
    _add_ct(router, opened)
    _add_slices(router, opened)
    _add_oblique(router, opened)
    return router


def _add_uploads(router: APIRouter, step: CtStep, home: Home) -> None:
    @router.post(
        "",
        status_code=202,
        responses=rejections(409, 413, 422, 503, 507),
        openapi_extra={"requestBody": {"required": True, "content": CT_TYPES}},
    )
    async def send(request: Request, made_by: MadeByQuery) -> UploadMessage:
        """Upload a CT in the request body: a zip of DICOM slices, a DICOM file, or NIfTI.

        A job reads and checks it and stores it as the CT of the open case; documents that depend on the
        previous CT become out of date. If it contains several CT series, the result of the job lists them.
        A CT that is not usable for planning is rejected and not stored.
        """
        await to_thread.run_sync(step.reject_without_case)
        async with received(request, home, max_bytes=MAX_CT_BYTES) as path:
            return upload_message(await to_thread.run_sync(lambda: step.receive(path, made_by=made_by)))

    @router.post(
        "/uploads/{upload_id}/series/{series}", status_code=202, responses=rejections(404, 422, 503, 507)
    )
    def choose(upload_id: str, series: str) -> UploadMessage:
        """Read one series of an upload with several."""
        return upload_message(step.choose(upload_id, series))

    @router.get(
        "/uploads/{upload_id}/preview.png",
        response_class=FileResponse,
        responses={
            **PNG_ANSWER,
            204: {"description": "No slice has been read yet; request it again after a moment."},
            **rejections(404, 503),
        },
    )
    def preview(upload_id: str) -> Response:
        """Return a preview slice from the middle while the CT is being read; 204 before it is available."""
        path = step.preview(upload_id)
        try:
            return Response(path.read_bytes(), media_type=PNG)
        except FileNotFoundError:
            # 204 instead of 404, because an early request is no error.
            return Response(status_code=204)


def _add_ct(router: APIRouter, opened: CtProvider) -> None:
    @router.get("", responses=rejections(409, 422, 503))
    def ct() -> CtMessage:
        """Return the CT of the open case: description, geometry and warnings."""
        found = opened.current()
        heading = heading_message(found.document, Current())
        return ct_message(heading, found.document.content, found.volume)

    @router.post("/probe", responses=rejections(409, 422, 503))
    def probe(requested: ProbeRequest) -> ProbeMessage:
        """Return the Hounsfield units at a point."""
        volume = opened.current().volume
        point = np.array(requested.point_lps_mm)
        return ProbeMessage(
            hu=float(volume.sample_hu(point)),
            inside=bool(volume.contains(point)),
            index_ijk=volume.index_from_lps(point).tolist(),
        )


def _add_slices(router: APIRouter, opened: CtProvider) -> None:
    @router.get(
        "/slices/{plane}.png",
        response_class=Response,
        responses={**SLICE_ANSWER, **rejections(409, 422, 503)},
    )
    def slice_picture(
        request: Request,
        plane: Plane,
        at_mm: AtMm | None = None,
        window: WindowHu | None = None,
        level: HU | None = None,
        preset: str | None = None,
        slab_mm: SlabMm = 0.0,
        pixel_mm: PixelMm | None = None,
    ) -> Response:
        """Return a slice as PNG with its geometry in a header; default: the middle slice.

        The left side of the image is the patient's right (axial, coronal) or anterior (sagittal). Pixels are
        those of the scanner where possible and need not be square; `pixel_mm` resamples them.
        """
        grey = window_from_query(window, level, preset)
        found = opened.current()

        def draw() -> tuple[npt.NDArray[np.uint8], dict[str, str]]:
            one, at = _slice(found.volume, plane, at_mm, slab_mm, pixel_mm)
            return _drawn(found, one, at, grey)

        return image_with_headers(request, found.document.id, draw)

    @router.get("/slices/{plane}", responses=rejections(409, 422, 503))
    def slice_place(
        plane: Plane, at_mm: AtMm | None = None, slab_mm: SlabMm = 0.0, pixel_mm: PixelMm | None = None
    ) -> SliceMessage:
        """Return the geometry of the pixels of this slice."""
        one, at = _slice(opened.current().volume, plane, at_mm, slab_mm, pixel_mm)
        return slice_message(one, at_mm=at)


def _slice(
    volume: Volume, plane: Plane, at_mm: float | None, slab_mm: float, pixel_mm: float | None
) -> tuple[Slice, float]:
    if at_mm is None:
        low, high, step = reach_mm(volume, plane)
        at_mm = min(high, low + round((high - low) / 2.0 / step) * step)
    return patient_slice(volume, plane, at_mm, slab_mm=slab_mm, pixel_mm=pixel_mm), at_mm


def _drawn(
    ct: MappedCt, one: Slice, at_mm: float | None, grey: Window
) -> tuple[npt.NDArray[np.uint8], dict[str, str]]:
    """Return the pixels of a slice, and the headers with its geometry and its CT."""
    place = slice_message(one, at_mm=at_mm).model_dump_json()
    return shown(one.hu, grey), {SLICE_PLACE: place, SLICE_CT: ct.document.id}


@dataclass(frozen=True, slots=True, kw_only=True)
class Oblique:
    """Query parameters of an oblique slice along or across a channel."""

    entry: str
    target: str
    view: View = "along"
    rotation_deg: Degrees = 0.0
    depth_mm: DepthMm = 0.0
    width_mm: SizeMm = 60.0
    height_mm: SizeMm = 100.0
    pixel_mm: PixelMm | None = None
    slab_mm: SlabMm = 0.0

    @property
    def channel(self) -> Channel:
        """Return the axis of the slice; raises InvalidInput for an invalid point."""
        return Channel(
            name="oblique",
            entry_in_vertebra_mm=point_from_query(self.entry, name="entry"),
            target_in_vertebra_mm=point_from_query(self.target, name="target"),
            radius_mm=1.0,
        )

    def of(self, volume: Volume, channel: Channel) -> Slice:
        """Return the slice of this volume."""
        size_mm = (self.width_mm, self.height_mm)
        if self.view == "across":
            return across_channel(
                volume,
                channel,
                depth_mm=self.depth_mm,
                size_mm=size_mm,
                pixel_mm=self.pixel_mm,
                slab_mm=self.slab_mm,
            )
        return along_channel(
            volume,
            channel,
            rotation_deg=self.rotation_deg,
            size_mm=size_mm,
            pixel_mm=self.pixel_mm,
            slab_mm=self.slab_mm,
        )


def _add_oblique(router: APIRouter, opened: CtProvider) -> None:
    @router.get(
        "/oblique.png", response_class=Response, responses={**SLICE_ANSWER, **rejections(409, 422, 503)}
    )
    def oblique_picture(
        request: Request,
        requested: Annotated[Oblique, Depends()],
        window: WindowHu | None = None,
        level: HU | None = None,
        preset: str | None = None,
    ) -> Response:
        """Return a slice along a channel, rotated about its axis, or across it at a depth from its entry.

        Entry and target are `x,y,z` in mm (LPS). Along the channel, the drilling direction points upwards;
        across it, the view is in the drilling direction.
        """
        grey = window_from_query(window, level, preset)
        channel = requested.channel
        found = opened.current()

        def draw() -> tuple[npt.NDArray[np.uint8], dict[str, str]]:
            return _drawn(found, requested.of(found.volume, channel), None, grey)

        return image_with_headers(request, found.document.id, draw)

    @router.get("/oblique", responses=rejections(409, 422, 503))
    def oblique_place(requested: Annotated[Oblique, Depends()]) -> SliceMessage:
        """Return the geometry of the pixels of this slice."""
        volume = opened.current().volume
        return slice_message(requested.of(volume, requested.channel))
