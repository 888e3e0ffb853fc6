"""Registration by three needles: detected, marked, or aligned with a slice overlay on the live image."""

from typing import Annotated

import cv2
from fastapi import APIRouter, Query, Response

from server.api.case_messages import DocumentMessage, document_message
from server.api.errors import rejections
from server.api.needle_messages import (
    LaidMessage,
    LaidRequest,
    NeedlesConclusion,
    NeedlesRequest,
    OverlayQuery,
    ProposalsMessage,
    laid_message,
    proposals_message,
)
from server.api.slice_images import window_from_query
from server.procedure.ct import CtProvider
from server.procedure.registration import RegistrationSteps, touched_points
from server.procedure.registration.needle_picture import overlay_picture
from server.procedure.registration.needle_records import NeedleScene, PlacedSlice
from server.store import Current

JPEG = "image/jpeg"
STORE_ERRORS = rejections(409, 422, 503, 507)
IMAGE_ERRORS = rejections(409, 422, 503)


def needles_router(steps: RegistrationSteps, opened: CtProvider) -> APIRouter:
    """Return the router of `/api/registration/needles`; synchronous, because it processes images."""
    router = APIRouter(prefix="/api/registration/needles", tags=["registration"])
    step = steps.needles

    def scene_of(requested: NeedlesRequest) -> NeedleScene:
        return step.scene(requested.order, touched_points(steps.points) if requested.use_touched else ())

    def fitted(requested: NeedlesConclusion) -> tuple[PlacedSlice, str]:
        scene = scene_of(requested)
        if requested.overlay is not None:
            return step.take(scene, requested.overlay.record), "overlay"
        marked = [one.record for one in requested.marked]
        return step.mark(
            scene, marked, order_is_sure=requested.picked
        ), "picked" if requested.picked else "marked"

    @router.post("/proposal", responses=IMAGE_ERRORS)
    def propose(requested: NeedlesRequest) -> ProposalsMessage:
        """Detect the needles in the newest image; return assignment hypotheses with residuals.

        The user selects one and sends its needles to the conclusion as `marked` with `picked`.
        """
        return proposals_message(step.propose(scene_of(requested), radius_mm=requested.radius_mm))

    @router.post("/overlay", responses=IMAGE_ERRORS)
    def lay(requested: LaidRequest) -> LaidMessage:
        """Return the slice overlay on the newest image and the residuals of marked needles."""
        overlay = None if requested.overlay is None else requested.overlay.record
        scene = scene_of(requested)
        laid = step.lay(scene, overlay, [one.record for one in requested.marked])
        return laid_message(laid, None if scene.reference is None else opened.current().volume)

    @router.post("/conclusion", status_code=201, responses=STORE_ERRORS)
    def conclude(requested: NeedlesConclusion) -> DocumentMessage:
        """Register to the needles and store the result if it passes its limits; it then has to be checked."""
        laid, way = fitted(requested)
        return document_message(step.keep(laid, way=way, made_by=requested.made_by), Current())

    _add_picture(router, steps, opened)
    return router


def _add_picture(router: APIRouter, steps: RegistrationSteps, opened: CtProvider) -> None:
    step = steps.needles

    @router.get(
        "/overlay.jpg", response_class=Response, responses={200: {"content": {JPEG: {}}}, **IMAGE_ERRORS}
    )
    def overlay_jpg(requested: Annotated[OverlayQuery, Query()]) -> Response:
        """Return the newest image with the translucent slice; default placement from the ruler."""
        scene = step.scene(NeedlesRequest(view=requested.view, vertebra=requested.vertebra).order)
        laid = step.lay(scene, requested.overlay_from(step.lay(scene, None).overlay))
        drawn = overlay_picture(laid, opened.current().volume, window_from_query(None, None, None))
        encoded, content = cv2.imencode(".jpg", drawn)
        if not encoded:
            raise RuntimeError("the image could not be encoded")
        return Response(content.tobytes(), media_type=JPEG, headers={"Cache-Control": "no-store"})
