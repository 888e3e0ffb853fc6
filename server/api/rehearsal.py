"""The rehearsal: which scene is played, another one while it runs, its truth, and the CT of its vertebra."""

from functools import cache

from fastapi import APIRouter, Response

from server.api.errors import rejections
from server.api.rehearsal_messages import (
    MomentMessage,
    RehearsalMessage,
    SceneRequest,
    moment_message,
    theatre_message,
)
from server.capture.address import source_from_text
from server.config import CameraConfig
from server.errors import SetupOrderError
from server.live import LiveHub
from server.loop.rehearsed import Rehearsed

NIFTI = "application/gzip"


def rehearsal_router(rehearsed: Rehearsed | None, hub: LiveHub, camera: CameraConfig) -> APIRouter:
    """Everything under `/api/rehearsal`; refused where the camera is not the rehearsal's."""
    source = source_from_text(camera.source).name
    router = APIRouter(prefix="/api/rehearsal", tags=["rehearsal"])

    def running() -> Rehearsed:
        if rehearsed is None:
            raise SetupOrderError(
                "NOT_A_REHEARSAL",
                f"images come from {source}, not from the rehearsal",
                "Start with camera.source: rehearsal.",
                {"source": source},
            )
        return rehearsed

    @router.get("", responses=rejections(409))
    def rehearsal(*, truth: bool = False) -> RehearsalMessage:
        """What is rehearsed. With `truth=1` also what is true, for tests and teaching."""
        return _message(running(), hub, with_truth=truth)

    @router.put("", responses=rejections(409, 422))
    def play(asked: SceneRequest) -> RehearsalMessage:
        """Play another scene in the same theatre, from its beginning, without a restart.

        It is there a moment later: see `begun`.
        """
        known = running()
        changed = {
            "scene": asked.scene,
            "skill": asked.skill or known.settings.skill,
            "board": asked.board or known.settings.board,
            "events": asked.events,
        }
        known.play(known.settings.model_copy(update=changed))
        return _message(known, hub, with_truth=False)

    @router.get(
        "/ct",
        response_class=Response,
        responses={200: {"content": {NIFTI: {}}}, **rejections(409)},
    )
    def ct() -> Response:
        """The CT of the rehearsal's vertebra, as .nii.gz; its LPS is the theatre's own vertebra frame."""
        running()
        headers = {"Content-Disposition": 'attachment; filename="rehearsal.nii.gz"'}
        return Response(_ct_bytes(), media_type=NIFTI, headers=headers)

    return router


def _message(rehearsed: Rehearsed, hub: LiveHub, *, with_truth: bool) -> RehearsalMessage:
    settings, first = rehearsed.settings, rehearsed.first_number
    return RehearsalMessage(
        seed=settings.seed,
        rate_hz=settings.rate_hz,
        reference=settings.reference,
        brings_setup=settings.brings_setup,
        scene=settings.scene,
        skill=settings.skill,
        board=settings.board,
        events=settings.events,
        begun=first is not None,
        first_number=first,
        truth=theatre_message(rehearsed.theatre, _moment(rehearsed, hub)) if with_truth else None,
    )


def _moment(rehearsed: Rehearsed, hub: LiveHub) -> MomentMessage | None:
    instant = hub.newest
    snapshot = None if instant is None else instant.snapshot
    if snapshot is None:
        return None
    truth = rehearsed.truth_of(snapshot.image_number)
    return None if truth is None else moment_message(truth, snapshot.image_number)


@cache
def _ct_bytes() -> bytes:
    # Loaded when asked for: nobody else needs a scanner in software.
    from server.imaging.nifti import nifti_bytes  # noqa: PLC0415
    from tracker.rehearsal.ct import rehearsal_ct  # noqa: PLC0415

    return nifti_bytes(rehearsal_ct())
