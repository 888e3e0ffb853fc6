"""Registration by three needles: found, marked, or under the slice that is laid over the live picture."""

from typing import Annotated

import cv2
from fastapi import APIRouter, Query, Response

from server.api.case_messages import DocumentMessage, document_message
from server.api.errors import rejections
from server.api.needle_messages import (
    LaidMessage,
    LaidRequest,
    Measured,
    NeedlesConclusion,
    NeedlesRequest,
    OverlayMessage,
    Pixel,
    ProposalsMessage,
    ViewMessage,
    laid_message,
    proposals_message,
)
from server.api.pictures import asked_window
from server.api.registration_messages import VertebraName
from server.procedure.ct import OpenedCt
from server.procedure.registration import RegistrationSteps, touched_points
from server.procedure.registration.needle_picture import overlay_picture
from server.procedure.registration.needle_records import LaidSlice, NeedleScene
from server.store import Current
from tracker.registration.needles import Standing

JPEG = "image/jpeg"
KEPT = rejections(409, 422, 503, 507)
SEEN = rejections(409, 422, 503)


def needles_router(steps: RegistrationSteps, opened: OpenedCt) -> APIRouter:
    """Everything under `/api/registration/needles`. Plain functions: they look at images, in threads."""
    router = APIRouter(prefix="/api/registration/needles", tags=["registration"])
    step = steps.needles

    def scene_of(asked: NeedlesRequest) -> NeedleScene:
        return step.scene(asked.order, touched_points(steps.points) if asked.use_touched else ())

    def fitted(asked: NeedlesConclusion) -> tuple[LaidSlice, str]:
        scene = scene_of(asked)
        if asked.overlay is not None:
            return step.take(scene, asked.overlay.record), "overlay"
        marked = [one.record for one in asked.marked]
        return step.mark(scene, marked, order_is_sure=asked.picked), "picked" if asked.picked else "marked"

    @router.post("/proposal", responses=SEEN)
    def propose(asked: NeedlesRequest) -> ProposalsMessage:
        """Find the needles in the newest image: each likely naming with its residuals; nothing is kept.

        A person picks one in the picture, and sends its needles to the conclusion as `marked`, `picked`.
        """
        return proposals_message(step.propose(scene_of(asked), radius_mm=asked.radius_mm))

    @router.post("/overlay", responses=SEEN)
    def lay(asked: LaidRequest) -> LaidMessage:
        """Lay the slice over the newest image, and tell how marked needles lie beside its lines."""
        overlay = None if asked.overlay is None else asked.overlay.record
        scene = scene_of(asked)
        laid = step.lay(scene, overlay, [one.record for one in asked.marked])
        return laid_message(laid, None if scene.reference is None else opened.current().volume)

    @router.post("/conclusion", status_code=201, responses=KEPT)
    def conclude(asked: NeedlesConclusion) -> DocumentMessage:
        """Fit to the needles and keep the registration, if it passes its gate; it is to be checked then."""
        laid, way = fitted(asked)
        return document_message(step.keep(laid, way=way, made_by=asked.made_by), Current())

    _add_picture(router, steps, opened)
    return router


def _add_picture(router: APIRouter, steps: RegistrationSteps, opened: OpenedCt) -> None:
    step = steps.needles

    @router.get("/overlay.jpg", response_class=Response, responses={200: {"content": {JPEG: {}}}, **SEEN})
    def overlay_jpg(
        vertical_mm: Annotated[Measured, Query()],
        horizontal_mm: Annotated[Measured, Query()],
        vertebra: Annotated[VertebraName | None, Query()] = None,
        azimuth_deg: Annotated[float, Query(ge=-180.0, le=180.0)] = 0.0,
        standing: Annotated[Standing, Query()] = Standing.FEET,
        x_px: Annotated[Pixel | None, Query()] = None,
        y_px: Annotated[Pixel | None, Query()] = None,
        turn_deg: Annotated[float, Query(ge=-360.0, le=360.0)] = 0.0,
        scale_px_per_mm: Annotated[float | None, Query(ge=0.05, le=100.0)] = None,
        fade_ratio: Annotated[float, Query(ge=0.0, le=1.0)] = 0.5,
    ) -> Response:
        """The newest image with the slice translucent over it; where the ruler has it, unless it is moved."""
        view = ViewMessage(
            vertical_mm=vertical_mm, horizontal_mm=horizontal_mm, azimuth_deg=azimuth_deg, standing=standing
        )
        scene = step.scene(NeedlesRequest(view=view, vertebra=vertebra).order)
        first = step.lay(scene, None).overlay
        laid = step.lay(
            scene,
            OverlayMessage(
                shift_px=[
                    float(first.shift_px[0]) if x_px is None else x_px,
                    float(first.shift_px[1]) if y_px is None else y_px,
                ],
                turn_deg=turn_deg,
                scale_px_per_mm=first.scale_px_per_mm if scale_px_per_mm is None else scale_px_per_mm,
                fade_ratio=fade_ratio,
            ).record,
        )
        drawn = overlay_picture(laid, opened.current().volume, asked_window(None, None, None))
        encoded, content = cv2.imencode(".jpg", drawn)
        if not encoded:
            raise RuntimeError("a picture could not be encoded")
        return Response(content.tobytes(), media_type=JPEG, headers={"Cache-Control": "no-store"})
