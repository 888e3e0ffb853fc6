"""The rehearsal: select a scene, read its ground truth, and download the CT of its vertebra."""

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
from server.loop.rehearsal_control import RehearsalControl

NIFTI = "application/gzip"


def rehearsal_router(rehearsed: RehearsalControl | None, hub: LiveHub, camera: CameraConfig) -> APIRouter:
    """Return the router of `/api/rehearsal`; requests are rejected if the source is not the rehearsal."""
    source = source_from_text(camera.source).name
    router = APIRouter(prefix="/api/rehearsal", tags=["rehearsal"])

    def running() -> RehearsalControl:
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
        """Return the scene of the rehearsal; with `truth=1` also its ground truth, for tests and teaching."""
        return _message(running(), hub, with_truth=truth)

    @router.put("", responses=rejections(409, 422))
    def play(requested: SceneRequest) -> RehearsalMessage:
        """Start another scene in the same theatre, without a restart of the server.

        It starts with a short delay: see `begun`.
        """
        known = running()
        changed = {
            "scene": requested.scene,
            "skill": requested.skill or known.settings.skill,
            "board": requested.board or known.settings.board,
            "events": requested.events,
        }
        known.play(known.settings.model_copy(update=changed))
        return _message(known, hub, with_truth=False)

    @router.get(
        "/ct",
        response_class=Response,
        responses={200: {"content": {NIFTI: {}}}, **rejections(409)},
    )
    def ct() -> Response:
        """Return the CT of the simulated vertebra as .nii.gz, in the vertebra frame of the theatre (LPS)."""
        running()
        headers = {"Content-Disposition": 'attachment; filename="rehearsal.nii.gz"'}
        return Response(_ct_bytes(), media_type=NIFTI, headers=headers)

    return router


def _message(rehearsed: RehearsalControl, hub: LiveHub, *, with_truth: bool) -> RehearsalMessage:
    settings, first = rehearsed.settings, rehearsed.first_number
    return RehearsalMessage(
        seed=settings.seed,
        rate_hz=settings.rate_hz,
        reference=settings.reference,
        provides_setup=settings.provides_setup,
        scene=settings.scene,
        skill=settings.skill,
        board=settings.board,
        events=settings.events,
        begun=first is not None,
        first_number=first,
        truth=theatre_message(rehearsed.theatre, _moment(rehearsed, hub)) if with_truth else None,
    )


def _moment(rehearsed: RehearsalControl, hub: LiveHub) -> MomentMessage | None:
    instant = hub.newest
    snapshot = None if instant is None else instant.snapshot
    if snapshot is None:
        return None
    truth = rehearsed.truth_of(snapshot.image_number)
    return None if truth is None else moment_message(truth, snapshot.image_number)


@cache
def _ct_bytes() -> bytes:
    # Imported on demand, because only this route needs the CT simulation.
    from server.imaging.nifti import nifti_bytes  # noqa: PLC0415
    from tracker.rehearsal.ct import rehearsal_ct  # noqa: PLC0415

    return nifti_bytes(rehearsal_ct())
