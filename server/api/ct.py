"""The CT: sent, read, looked at in slices."""

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
from server.api.doing import MadeByQuery
from server.api.errors import STATUS_OF, rejections
from server.api.pictures import (
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
    asked_point,
    asked_window,
    placed_picture,
)
from server.api.uploads import received
from server.procedure.ct import CtInUse, CtStep, OpenedCt, UploadUnknown
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
LARGEST_CT_BYTES = 4 * 2**30
CT_TYPES: dict[str, dict[str, object]] = {"application/zip": {}, "application/octet-stream": {}}
View = Literal["along", "across"]
Degrees = Annotated[float, Query(ge=-360.0, le=360.0, allow_inf_nan=False)]
DepthMm = Annotated[float, Query(ge=-500.0, le=500.0, allow_inf_nan=False)]
AtMm = Annotated[float, Query(ge=-10_000.0, le=10_000.0, allow_inf_nan=False)]


def ct_router(step: CtStep, opened: OpenedCt, home: Home) -> APIRouter:
    """Everything under `/api/ct`. Plain functions: they read the disk, in threads."""
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
        """Send a CT, which is the body of the request: a zip of DICOM slices, a DICOM file, or NIfTI.

        It is read in a job, checked, and kept as the CT of the open case; what stood on the CT before is out
        of date then. If it holds several CT series, the job's result lists them, for one to be chosen. What
        cannot be planned on is refused by the job, and nothing of it is kept.
        """
        await to_thread.run_sync(step.reject_without_case)
        async with received(request, home, max_bytes=LARGEST_CT_BYTES) as path:
            return upload_message(await to_thread.run_sync(lambda: step.receive(path, made_by=made_by)))

    @router.post(
        "/uploads/{upload_id}/series/{series}", status_code=202, responses=rejections(404, 422, 503, 507)
    )
    def choose(upload_id: str, series: str) -> UploadMessage:
        """Read this series of an upload that holds several."""
        return upload_message(step.choose(upload_id, series))

    @router.get(
        "/uploads/{upload_id}/preview.png",
        response_class=FileResponse,
        responses={
            **PNG_ANSWER,
            204: {"description": "No slice is read yet; ask again in a moment."},
            **rejections(404, 503),
        },
    )
    def preview(upload_id: str) -> Response:
        """A slice of the middle, as soon as it is read and until the CT is; no content before that."""
        path = step.preview(upload_id)
        try:
            return Response(path.read_bytes(), media_type=PNG)
        except FileNotFoundError:
            # Nothing went wrong: a page that asks early must not look as if it did.
            return Response(status_code=204)


def _add_ct(router: APIRouter, opened: OpenedCt) -> None:
    @router.get("", responses=rejections(409, 422, 503))
    def ct() -> CtMessage:
        """The CT of the open case: what it is, where its slices lie, and what to know of it."""
        found = opened.current()
        heading = heading_message(found.document, Current())
        return ct_message(heading, found.document.content, found.volume)

    @router.post("/probe", responses=rejections(409, 422, 503))
    def probe(asked: ProbeRequest) -> ProbeMessage:
        """The Hounsfield units at a point."""
        volume = opened.current().volume
        point = np.array(asked.point_lps_mm)
        return ProbeMessage(
            hu=float(volume.sample_hu(point)),
            inside=bool(volume.holds(point)),
            index_ijk=volume.index_from_lps(point).tolist(),
        )


def _add_slices(router: APIRouter, opened: OpenedCt) -> None:
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
        """A slice as a picture, its place in the header; the middle one if no place is given.

        Left in the image is the patient's right (axial, coronal) or front (sagittal). The pixels are the
        scanner's own where they lie so, and need not be square; `pixel_mm` makes them.
        """
        grey = asked_window(window, level, preset)
        found = opened.current()

        def draw() -> tuple[npt.NDArray[np.uint8], dict[str, str]]:
            one, at = _slice(found.volume, plane, at_mm, slab_mm, pixel_mm)
            return _drawn(found, one, at, grey)

        return placed_picture(request, found.document.id, draw)

    @router.get("/slices/{plane}", responses=rejections(409, 422, 503))
    def slice_place(
        plane: Plane, at_mm: AtMm | None = None, slab_mm: SlabMm = 0.0, pixel_mm: PixelMm | None = None
    ) -> SliceMessage:
        """Where the pixels of this slice's picture lie in the patient."""
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
    ct: CtInUse, one: Slice, at_mm: float | None, grey: Window
) -> tuple[npt.NDArray[np.uint8], dict[str, str]]:
    """The pixels of a slice, and the headers that say where they lie and of which CT they are."""
    place = slice_message(one, at_mm=at_mm).model_dump_json()
    return shown(one.hu, grey), {SLICE_PLACE: place, SLICE_CT: ct.document.id}


@dataclass(frozen=True, slots=True, kw_only=True)
class Oblique:
    """What is asked of a slice along or across a channel, in the query of picture and place alike."""

    entry: str
    target: str
    view: View = "along"
    turn_deg: Degrees = 0.0
    depth_mm: DepthMm = 0.0
    width_mm: SizeMm = 60.0
    height_mm: SizeMm = 100.0
    pixel_mm: PixelMm | None = None
    slab_mm: SlabMm = 0.0

    @property
    def channel(self) -> Channel:
        """The line that it is cut along; InvalidInput where an end is no point."""
        return Channel(
            name="oblique",
            entry_in_vertebra_mm=asked_point(self.entry, name="entry"),
            target_in_vertebra_mm=asked_point(self.target, name="target"),
            radius_mm=1.0,
        )

    def of(self, volume: Volume, channel: Channel) -> Slice:
        """The slice of this volume."""
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
            turn_deg=self.turn_deg,
            size_mm=size_mm,
            pixel_mm=self.pixel_mm,
            slab_mm=self.slab_mm,
        )


def _add_oblique(router: APIRouter, opened: OpenedCt) -> None:
    @router.get(
        "/oblique.png", response_class=Response, responses={**SLICE_ANSWER, **rejections(409, 422, 503)}
    )
    def oblique_picture(
        request: Request,
        asked: Annotated[Oblique, Depends()],
        window: WindowHu | None = None,
        level: HU | None = None,
        preset: str | None = None,
    ) -> Response:
        """A slice along a channel, turned about it, or across it at a depth from its entry.

        Entry and target are `x,y,z` in mm of LPS. Along the channel, one drills upwards in the middle of the
        image; across it, one looks in the drilling direction.
        """
        grey = asked_window(window, level, preset)
        channel = asked.channel
        found = opened.current()

        def draw() -> tuple[npt.NDArray[np.uint8], dict[str, str]]:
            return _drawn(found, asked.of(found.volume, channel), None, grey)

        return placed_picture(request, found.document.id, draw)

    @router.get("/oblique", responses=rejections(409, 422, 503))
    def oblique_place(asked: Annotated[Oblique, Depends()]) -> SliceMessage:
        """Where the pixels of this slice's picture lie in the patient."""
        volume = opened.current().volume
        return slice_message(asked.of(volume, asked.channel))
