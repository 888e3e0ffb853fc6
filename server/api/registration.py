"""Registration by landmarks, manual correction, and the check on anatomy."""

from typing import Annotated

from fastapi import APIRouter, Query, Response

from server.api.case_messages import DocumentMessage, document_message
from server.api.errors import rejections
from server.api.registration_messages import (
    ByRequest,
    CheckMessage,
    CheckRequest,
    LandmarkRequest,
    NudgeRequest,
    NudgesMessage,
    PointsMessage,
    PointsRequest,
    RegistrationMessage,
    RunningMessage,
    UseRequest,
    VertebraName,
    check_message,
    nudges_message,
    points_message,
    registration_message,
)
from server.api.requester import MadeByQuery
from server.config import RegistrationConfig
from server.procedure.registration import (
    CheckStep,
    NudgeStep,
    PointsStep,
    RegistrationRepository,
    RegistrationSteps,
)
from server.store import Current
from server.stream.messages import translated_problem
from tracker.registration.nudge import Nudge

STORE_ERRORS = rejections(409, 422, 503, 507)


def registration_router(steps: RegistrationSteps) -> APIRouter:
    """Return the router of `/api/registration`. Its routes are synchronous because they wait for the disk."""
    router = APIRouter(prefix="/api/registration", tags=["registration"])
    _add_whole(router, steps.repository, steps.points.gate)
    _add_running(router, steps)
    _add_points(router, steps.points)
    _add_check(router, steps.check)
    _add_nudges(router, steps.nudge)
    return router


def _add_whole(router: APIRouter, repository: RegistrationRepository, gate: RegistrationConfig) -> None:
    @router.get("", responses=rejections(409, 422, 503))
    def registration(
        vertebra: Annotated[VertebraName | None, Query()] = None,
    ) -> RegistrationMessage:
        """Return the newest registration of a vertebra; default: that of the active channel."""
        return registration_message(repository.newest(vertebra), gate)


def _add_running(router: APIRouter, steps: RegistrationSteps) -> None:
    @router.get("/running")
    def running() -> RunningMessage:
        """Return the registrations and checks in progress, so that a page can continue them."""
        return RunningMessage(
            points=steps.points.is_collecting,
            sweep=steps.sweep.is_collecting,
            check=steps.check.is_collecting,
        )


def _add_points(router: APIRouter, step: PointsStep) -> None:
    @router.post("/points", status_code=201, responses=STORE_ERRORS)
    def begin(requested: PointsRequest) -> PointsMessage:
        """Start a registration by landmarks; previously captured points are discarded."""
        step.begin(tool=requested.tool, vertebra=requested.vertebra)
        return _points(step)

    @router.get("/points", responses=rejections(409))
    def progress() -> PointsMessage:
        """Return the captured points with residuals, expected errors, and what is missing."""
        return _points(step)

    @router.delete("/points", status_code=204)
    def end() -> Response:
        """Stop and discard the captured points."""
        step.end()
        return Response(status_code=204)

    @router.post("/points/captures", status_code=202, responses=rejections(409, 422))
    def capture(requested: LandmarkRequest) -> PointsMessage:
        """Capture the tip at rest on this landmark from the next images; a repetition replaces the point."""
        step.collection.capture(requested.landmark)
        return _points(step)

    @router.put("/points/use", responses=rejections(409, 422))
    def use(requested: UseRequest) -> PointsMessage:
        """Include a captured landmark in the fit, or exclude it."""
        step.collection.use(requested.landmark, used=requested.used)
        return _points(step)

    @router.delete("/points/captures", responses=rejections(409, 422))
    def forget(landmark: Annotated[str, Query(min_length=1, max_length=60)]) -> PointsMessage:
        """Discard the captured point of a landmark."""
        step.collection.forget(landmark)
        return _points(step)

    @router.post("/points/conclusion", status_code=201, responses=STORE_ERRORS)
    def conclude(requested: ByRequest) -> DocumentMessage:
        """Store the registration if it passes its limits; it is used after its check."""
        return document_message(step.conclude(made_by=requested.made_by), Current())


def _add_check(router: APIRouter, step: CheckStep) -> None:
    @router.post("/check", status_code=201, responses=STORE_ERRORS)
    def begin(requested: CheckRequest) -> CheckMessage:
        """Start a check: hold the tip still on a landmark that was not used for the fit."""
        return check_message(step.begin(requested.landmark, tool=requested.tool).status)

    @router.get("/check", responses=rejections(409))
    def progress() -> CheckMessage:
        """Return the progress of the check and the distance of the tip from the planned landmark."""
        return check_message(step.collection.status)

    @router.delete("/check", status_code=204)
    def end() -> Response:
        """Stop the check."""
        step.end()
        return Response(status_code=204)

    @router.post("/check/conclusion", status_code=201, responses=STORE_ERRORS)
    def conclude(requested: ByRequest) -> DocumentMessage:
        """Store the check, passed or failed; navigation requires a passed check."""
        return document_message(step.conclude(made_by=requested.made_by), Current())


def _add_nudges(router: APIRouter, step: NudgeStep) -> None:
    @router.get("/nudges", responses=rejections(409, 422, 503))
    def nudges() -> NudgesMessage:
        """Return the manual corrections with author and time, and their total."""
        return nudges_message(step.status())

    @router.post("/nudges", status_code=201, responses=STORE_ERRORS)
    def apply(requested: NudgeRequest) -> NudgesMessage:
        """Correct the registration by one manual step; it then has to be checked again."""
        step.apply(
            Nudge(kind=requested.kind, axis=requested.axis, amount=requested.amount),
            made_by=requested.made_by,
        )
        return nudges_message(step.status())

    @router.delete("/nudges/last", responses=STORE_ERRORS)
    def undo(made_by: MadeByQuery) -> NudgesMessage:
        """Undo the last manual step, including its uncertainty."""
        step.undo(made_by=made_by)
        return nudges_message(step.status())


def _points(step: PointsStep) -> PointsMessage:
    status = step.collection.status
    return points_message(status, [translated_problem(error) for error in step.failures(status)], step.gate)
