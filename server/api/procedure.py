"""The state of the procedure: its steps in their order, what each lacks, and what may follow."""

from fastapi import APIRouter

from server.api.errors import refusals
from server.procedure.state import Procedure, ProcedureState, StepName, StepState
from server.stream.messages import Message


class StepMessage(Message):
    """One step."""

    step: StepName
    state: StepState
    """missing, out_of_date, failed, due (it holds, and shall be done again), done."""
    said: str
    """Why, in a sentence."""
    remedy: str
    """What to do; empty where there is nothing to do."""
    numbers: dict[str, float | int | bool | str | None]
    """Of its gate."""
    document_id: str | None
    """What was made in it; null where nothing was."""
    allowed: bool
    """Whether it may be done now, because all that it stands on holds."""


class ProcedureMessage(Message):
    """The whole procedure."""

    case_id: str | None
    """The open case; null where none is open."""
    case_name: str | None
    """As people call it, so that a screen in theatre can say whose plan it shows."""
    steps: list[StepMessage]
    """In the order in which they follow each other."""
    next_step: StepName
    """What is to be done now."""
    may_navigate: bool


def procedure_router(procedure: Procedure) -> APIRouter:
    """`GET /api/procedure`."""
    router = APIRouter(prefix="/api/procedure", tags=["procedure"])

    @router.get("", responses=refusals(503))
    def state() -> ProcedureMessage:
        """How every step of the open case stands: done, missing, failed, out of date or due again."""
        return procedure_message(procedure.state())

    return router


def procedure_message(state: ProcedureState) -> ProcedureMessage:
    """The state, as it is told."""
    return ProcedureMessage(
        case_id=state.case_id or None,
        case_name=state.case_name or None,
        steps=[
            StepMessage(
                step=one.step,
                state=one.finding.state,
                said=one.finding.said,
                remedy=one.finding.remedy,
                numbers=dict(one.finding.numbers),
                document_id=one.finding.document_id or None,
                allowed=one.allowed,
            )
            for one in state.steps
        ],
        next_step=state.next_step,
        may_navigate=state.status(StepName.NAVIGATE).finding.state is StepState.DONE,
    )
