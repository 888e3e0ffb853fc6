"""Refine a registration by a sweep of the tip over exposed bone."""

from fastapi import APIRouter, Response

from server.api.case_messages import DocumentMessage, document_message
from server.api.errors import rejections
from server.api.registration_messages import ByRequest, ToolRequest
from server.api.remark_messages import RemarkMessage, remark_message
from server.live import Problem
from server.procedure.registration import SweepStep
from server.procedure.registration.sweep import SweepStatus
from server.procedure.registration_record import Value
from server.store import Current
from server.stream.messages import Message, ProblemMessage, problem_message
from tracker.registration import AnchoredTo

STORE_ERRORS = rejections(409, 422, 503, 507)


class TakingRequest(Message):
    """Whether the tip is on exposed bone now."""

    taking: bool


class SweepMessage(Message):
    """Progress of a sweep."""

    vertebra: str
    tool: str
    anchored_to: AnchoredTo
    start_version: int
    """Version of the registration that it refines."""
    taking: bool
    points: int
    unseen: int
    """Images without the tip."""
    reach_mm: list[float]
    """Extent along the principal axes of the sweep, largest first."""
    problem: ProblemMessage | None


class SweepFitMessage(Message):
    """Result of a sweep."""

    numbers: dict[str, Value]
    weakest: str
    """The least determined direction."""
    remarks: list[RemarkMessage]
    missing: list[ProblemMessage]
    """Unmet requirements; empty if it passes its limits."""


def sweep_router(step: SweepStep) -> APIRouter:
    """Return the router of `/api/registration/sweep`; synchronous, because its routes wait for the fit."""
    router = APIRouter(prefix="/api/registration/sweep", tags=["registration"])

    @router.post("", status_code=201, responses=STORE_ERRORS)
    def begin(requested: ToolRequest) -> SweepMessage:
        """Start recording tip positions while the tip sweeps over the exposed bone of the vertebra."""
        return _message(step.begin(tool=requested.tool).status)

    @router.get("", responses=rejections(409))
    def progress() -> SweepMessage:
        """Return the progress of the sweep."""
        return _message(step.collection.status)

    @router.put("", responses=rejections(409))
    def take(requested: TakingRequest) -> SweepMessage:
        """Pause or resume recording, for example while the tip is lifted off the bone."""
        step.collection.take(taking=requested.taking)
        return _message(step.collection.status)

    @router.delete("", status_code=204)
    def end() -> Response:
        """Stop and discard the sweep."""
        step.end()
        return Response(status_code=204)

    @router.post("/fit", responses=STORE_ERRORS)
    def fit() -> SweepFitMessage:
        """Fit the sweep to the bone without storing it. Rejected if a direction is undetermined."""
        found, failures, _ = step.fit()
        return SweepFitMessage(
            numbers=step.numbers(step.collection.status, found),
            weakest=found.weakest_mode.description,
            remarks=[remark_message(remark) for remark in found.remarks],
            missing=[
                message
                for message in (problem_message(Problem.from_error(one)) for one in failures)
                if message is not None
            ],
        )

    @router.post("/conclusion", status_code=201, responses=STORE_ERRORS)
    def conclude(requested: ByRequest) -> DocumentMessage:
        """Store the refined registration if it passes its limits; it then has to be checked again."""
        return document_message(step.conclude(made_by=requested.made_by), Current())

    return router


def _message(status: SweepStatus) -> SweepMessage:
    return SweepMessage(
        vertebra=status.context.vertebra.name,
        tool=status.context.tool,
        anchored_to=status.context.anchored_to,
        start_version=status.start.document.version,
        taking=status.taking,
        points=status.points,
        unseen=status.unseen,
        reach_mm=list(status.reach_mm),
        problem=problem_message(status.problem),
    )
