"""The state of the procedure: its steps in their order, what each lacks, and what may follow."""

from typing import Annotated

from fastapi import APIRouter, Request
from pydantic import Field

from server.api.errors import rejections
from server.procedure.confirm import ConfirmStep
from server.procedure.confirmed import ConfirmationNeeded
from server.procedure.state import Procedure, ProcedureState, StepName, StepState
from server.security.person import person_of
from server.setup import Unconfirmed
from server.stream.messages import Message


class LackMessage(Message):
    """What a step that is done still lacks before anybody may navigate by it."""

    said: str
    remedy: str


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
    lacks: LackMessage | None
    """The co-signature that is required of it and not there; null where nothing is lacking."""


class ConfirmationMessage(Message):
    """What a person is asked before navigation goes on after a start."""

    because: Unconfirmed
    """server_started, or tracking_started: where no marker is on the patient, nobody watched the camera."""
    said: str
    """Why, in a sentence."""
    remedy: str
    """What to look at before it is confirmed."""
    registration_id: str
    """What is confirmed; `POST /api/procedure/confirmation` takes it."""
    vertebra: str
    registered_at: str
    """UTC, ISO 8601."""
    registered_by: str
    reference: str | None
    """The marker on the patient that it is fixed to; null where it is fixed to the camera."""


class ConfirmationRequest(Message):
    """A person's word that what they were shown still holds."""

    registration_id: Annotated[str, Field(min_length=1, max_length=64)]


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
    confirmation: ConfirmationMessage | None
    """What is to be confirmed first; null where nothing is."""


def procedure_router(procedure: Procedure, confirm: ConfirmStep) -> APIRouter:
    """`GET /api/procedure`, and the confirmation after a start."""
    router = APIRouter(prefix="/api/procedure", tags=["procedure"])

    @router.get("", responses=rejections(503))
    def state() -> ProcedureMessage:
        """How every step of the open case stands: done, missing, failed, out of date or due again."""
        return procedure_message(procedure.state())

    @router.post("/confirmation", responses=rejections(409, 422, 503, 507))
    def confirmation(asked: ConfirmationRequest, request: Request) -> ProcedureMessage:
        """Say, after a start, that patient, marker and camera stand as they did: navigation goes on.

        It is kept in the case, with who said it. Where nothing is asked any more, nothing is kept.
        """
        confirm.confirm(asked.registration_id, made_by=person_of(request.scope).name)
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
                lacks=None
                if one.lacks is None
                else LackMessage(said=one.lacks.said, remedy=one.lacks.remedy),
            )
            for one in state.steps
        ],
        next_step=state.next_step,
        may_navigate=state.status(StepName.NAVIGATE).finding.state is StepState.DONE,
        confirmation=None if state.confirmation is None else confirmation_message(state.confirmation),
    )


def confirmation_message(needed: ConfirmationNeeded) -> ConfirmationMessage:
    """What is asked, as it is told."""
    return ConfirmationMessage(
        because=needed.because,
        said=needed.said,
        remedy=needed.remedy,
        registration_id=needed.registration.id,
        vertebra=needed.vertebra,
        registered_at=needed.registration.made_at,
        registered_by=needed.registration.maker,
        reference=needed.reference or None,
    )
