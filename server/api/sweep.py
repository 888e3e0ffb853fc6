"""Refining a registration by a sweep of the tip over bare bone."""

from fastapi import APIRouter, Response

from server.api.case_messages import DocumentMessage, document_message
from server.api.errors import rejections
from server.api.registration_messages import ByRequest, RemarkMessage, ToolRequest, remark_message
from server.live import Problem
from server.procedure.registered import Value
from server.procedure.registration import SweepStep
from server.procedure.registration.sweep import SweepStatus
from server.store import Current
from server.stream.messages import Message, ProblemMessage, problem_message
from tracker.registration import AnchoredTo

KEPT = rejections(409, 422, 503, 507)


class TakingRequest(Message):
    """Whether the tip is on bare bone now."""

    taking: bool


class SweepMessage(Message):
    """How far a sweep has come."""

    vertebra: str
    tool: str
    anchored_to: AnchoredTo
    start_version: int
    """Of the registration that it refines."""
    taking: bool
    points: int
    unseen: int
    """Images in which the tip was not known."""
    reach_mm: list[float]
    """From end to end along the sweep's three axes, the longest first."""
    problem: ProblemMessage | None


class SweepFitMessage(Message):
    """What a sweep gives."""

    numbers: dict[str, Value]
    weakest: str
    """The way in which the sweep alone holds the bone least, in words."""
    remarks: list[RemarkMessage]
    missing: list[ProblemMessage]
    """What keeps it from being concluded; empty when it passes its gate."""


def sweep_router(step: SweepStep) -> APIRouter:
    """Everything under `/api/registration/sweep`. Plain functions: they wait for the fit, in threads."""
    router = APIRouter(prefix="/api/registration/sweep", tags=["registration"])

    @router.post("", status_code=201, responses=KEPT)
    def begin(asked: ToolRequest) -> SweepMessage:
        """Take the tip's places from the live images while it is swept over the vertebra's bare bone."""
        return _message(step.begin(tool=asked.tool).status)

    @router.get("", responses=rejections(409))
    def progress() -> SweepMessage:
        """How much was swept."""
        return _message(step.session.status)

    @router.put("", responses=rejections(409))
    def take(asked: TakingRequest) -> SweepMessage:
        """Leave the tip out while it is lifted off the bone, or take it again."""
        step.session.take(taking=asked.taking)
        return _message(step.session.status)

    @router.delete("", status_code=204)
    def end() -> Response:
        """Take no more; what was swept is thrown away."""
        step.end()
        return Response(status_code=204)

    @router.post("/fit", responses=KEPT)
    def fit() -> SweepFitMessage:
        """Lay what was swept so far on the bone; nothing is kept. Refused where the sweep slides."""
        found, failures, _ = step.fit()
        return SweepFitMessage(
            numbers=step.numbers(step.session.status, found),
            weakest=found.weakest.in_words,
            remarks=[remark_message(remark) for remark in found.remarks],
            missing=[
                message
                for message in (problem_message(Problem.from_error(one)) for one in failures)
                if message is not None
            ],
        )

    @router.post("/conclusion", status_code=201, responses=KEPT)
    def conclude(asked: ByRequest) -> DocumentMessage:
        """Keep the refined registration, if it passes its gate; it is to be checked again then."""
        return document_message(step.conclude(made_by=asked.made_by), Current())

    return router


def _message(status: SweepStatus) -> SweepMessage:
    return SweepMessage(
        vertebra=status.ground.vertebra.name,
        tool=status.ground.tool,
        anchored_to=status.ground.anchored_to,
        start_version=status.start.document.version,
        taking=status.taking,
        points=status.points,
        unseen=status.unseen,
        reach_mm=list(status.reach_mm),
        problem=problem_message(status.problem),
    )
