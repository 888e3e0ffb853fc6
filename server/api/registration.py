"""Finding the plan's vertebra on the patient: points, and the check on anatomy."""

from typing import Annotated

from fastapi import APIRouter, Query, Response

from server.api.case_messages import DocumentMessage, document_message
from server.api.doing import MadeByQuery
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
from server.config import RegistrationConfig
from server.live import Problem
from server.procedure.registration import (
    CheckStep,
    NudgeStep,
    PointsStep,
    RegistrationRepository,
    RegistrationSteps,
)
from server.store import Current
from server.stream.messages import ProblemMessage
from tracker.errors import RegistrationError
from tracker.registration.nudge import Nudge

KEPT = rejections(409, 422, 503, 507)


def registration_router(steps: RegistrationSteps) -> APIRouter:
    """Everything under `/api/registration`. Plain functions: they wait for the disk, in threads."""
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
        """The newest registration of a vertebra, by default of the one that is to be drilled."""
        return registration_message(repository.newest(vertebra), gate)


def _add_running(router: APIRouter, steps: RegistrationSteps) -> None:
    @router.get("/running")
    def running() -> RunningMessage:
        """Which ways to register, and whether a check, somebody has begun: a page goes on with them."""
        return RunningMessage(
            points=steps.points.running, sweep=steps.sweep.running, check=steps.check.running
        )


def _add_points(router: APIRouter, step: PointsStep) -> None:
    @router.post("/points", status_code=201, responses=KEPT)
    def begin(asked: PointsRequest) -> PointsMessage:
        """Begin to touch the landmarks of a vertebra; what was touched before is thrown away."""
        step.begin(tool=asked.tool, vertebra=asked.vertebra)
        return _points(step)

    @router.get("/points", responses=rejections(409))
    def progress() -> PointsMessage:
        """The points so far with their residuals, the errors to expect, and what is missing."""
        return _points(step)

    @router.delete("/points", status_code=204)
    def end() -> Response:
        """Look no more; what was touched is thrown away."""
        step.end()
        return Response(status_code=204)

    @router.post("/points/captures", status_code=202, responses=rejections(409, 422))
    def capture(asked: LandmarkRequest) -> PointsMessage:
        """Take the tip at rest on this landmark from the next images; again, to touch it anew."""
        step.session.capture(asked.landmark)
        return _points(step)

    @router.put("/points/use", responses=rejections(409, 422))
    def use(asked: UseRequest) -> PointsMessage:
        """Let a landmark that was touched have a say in the fit, or not."""
        step.session.use(asked.landmark, used=asked.used)
        return _points(step)

    @router.delete("/points/captures", responses=rejections(409, 422))
    def forget(landmark: Annotated[str, Query(min_length=1, max_length=60)]) -> PointsMessage:
        """Throw the point of a landmark away."""
        step.session.forget(landmark)
        return _points(step)

    @router.post("/points/conclusion", status_code=201, responses=KEPT)
    def conclude(asked: ByRequest) -> DocumentMessage:
        """Keep the registration, if it passes its gate; it is used once it was checked."""
        return document_message(step.conclude(made_by=asked.made_by), Current())


def _add_check(router: APIRouter, step: CheckStep) -> None:
    @router.post("/check", status_code=201, responses=KEPT)
    def begin(asked: CheckRequest) -> CheckMessage:
        """Hold the tip still on a landmark that the registration was not fitted to."""
        return check_message(step.begin(asked.landmark, tool=asked.tool).status)

    @router.get("/check", responses=rejections(409))
    def progress() -> CheckMessage:
        """Whether the tip was captured, and how far it is from where the plan has the landmark."""
        return check_message(step.session.status)

    @router.delete("/check", status_code=204)
    def end() -> Response:
        """Look no more."""
        step.end()
        return Response(status_code=204)

    @router.post("/check/conclusion", status_code=201, responses=KEPT)
    def conclude(asked: ByRequest) -> DocumentMessage:
        """Keep the check, passed or failed: its distance decides whether anybody may navigate."""
        return document_message(step.conclude(made_by=asked.made_by), Current())


def _add_nudges(router: APIRouter, step: NudgeStep) -> None:
    @router.get("/nudges", responses=rejections(409, 422, 503))
    def nudges() -> NudgesMessage:
        """What was nudged by hand, by whom and when, and how far all of it leads."""
        return nudges_message(step.status())

    @router.post("/nudges", status_code=201, responses=KEPT)
    def apply(asked: NudgeRequest) -> NudgesMessage:
        """Nudge the vertebra that is drawn on the patient; it has to be checked again then."""
        step.apply(Nudge(kind=asked.kind, axis=asked.axis, amount=asked.amount), made_by=asked.made_by)
        return nudges_message(step.status())

    @router.delete("/nudges/last", responses=KEPT)
    def undo(made_by: MadeByQuery) -> NudgesMessage:
        """Take the last nudge back; undone, its uncertainty is gone too."""
        step.undo(made_by=made_by)
        return nudges_message(step.status())


def _points(step: PointsStep) -> PointsMessage:
    status = step.session.status
    return points_message(status, [_told(error) for error in step.failures(status)], step.gate)


def _told(error: RegistrationError) -> ProblemMessage:
    problem = Problem.from_error(error)
    return ProblemMessage(
        code=problem.code, message=problem.message, remedy=problem.remedy, context=problem.context
    )
