"""State of the procedure: its steps, what is missing, and which step is next."""

from typing import Annotated

from fastapi import APIRouter, Request
from pydantic import Field

from server.api.errors import rejections
from server.api.recordings import RecordingStateMessage, recording_state_message
from server.api.setup_check_messages import SetupCheckMessage, setup_check_message
from server.procedure.confirmation import ConfirmationPrompt
from server.procedure.confirmation_step import ConfirmStep
from server.procedure.setup_check import SetupCheck, SetupChecker
from server.procedure.state import Procedure, ProcedureState, StepName, StepState
from server.recording.service import RecordingService
from server.security.person import person_of
from server.setup import ConfirmationReason
from server.stream.messages import Message
from server.texts import Language, requested_language


class MissingSignatureMessage(Message):
    """What a completed step still lacks before navigation may start."""

    message: str
    remedy: str


class StepMessage(Message):
    """One step."""

    step: StepName
    state: StepState
    """missing, out_of_date, failed, due (valid, but to be repeated), done."""
    code: str
    """The reason."""
    message: str
    """The reason as a sentence without its full stop."""
    remedy: str
    """What to do; empty if nothing."""
    language: Language
    """Language of message and remedy: as requested by `Accept-Language`; English without a translation."""
    numbers: dict[str, float | int | bool | str | None]
    """Values compared with its limits."""
    document_id: str | None
    """Its result; null if there is none."""
    allowed: bool
    """Whether it may be done now, because all its dependencies are valid."""
    missing_cosignature: MissingSignatureMessage | None
    """The required co-signature that is missing; null if none is."""


class ConfirmationMessage(Message):
    """Confirmation that is required before navigation continues after a start."""

    because: ConfirmationReason
    """server_started, or tracking_started (no patient marker: the camera was not monitored meanwhile)."""
    message: str
    """The reason."""
    remedy: str
    """What to verify before the confirmation."""
    registration_id: str
    """Registration to confirm with `POST /api/procedure/confirmation`."""
    vertebra: str
    registered_at: str
    """UTC, ISO 8601."""
    registered_by: str
    reference: str | None
    """The patient marker that it is relative to; null if it is relative to the camera."""


class ConfirmationRequest(Message):
    """Confirmation that the registration is still valid."""

    registration_id: Annotated[str, Field(min_length=1, max_length=64)]


class ProcedureMessage(Message):
    """State of the procedure."""

    case_id: str | None
    """The open case; null if none is open."""
    case_name: str | None
    """Its name, to be displayed in theatre."""
    steps: list[StepMessage]
    """In order."""
    next_step: StepName
    """The next step."""
    may_navigate: bool
    confirmation: ConfirmationMessage | None
    """The required confirmation; null if none is."""
    setup_check: SetupCheckMessage | None
    """Check of the active channel; null without a screw, or without registration and four landmarks."""
    recording: RecordingStateMessage | None
    """State of the recording; null if recordings are off."""


def procedure_router(
    procedure: Procedure,
    confirm: ConfirmStep,
    recordings: RecordingService | None = None,
    *,
    setup_check: SetupChecker,
) -> APIRouter:
    """Return the router of `/api/procedure`."""
    router = APIRouter(prefix="/api/procedure", tags=["procedure"])

    def message() -> ProcedureMessage:
        # Included because every page requests this message already.
        recording = None if recordings is None else recording_state_message(recordings)
        return procedure_message(procedure.state(), recording, setup_check.check())

    @router.get("", responses=rejections(503))
    def state() -> ProcedureMessage:
        """Return the state of each step of the open case."""
        return message()

    @router.post("/confirmation", responses=rejections(409, 422, 503, 507))
    def confirmation(requested: ConfirmationRequest, request: Request) -> ProcedureMessage:
        """Confirm after a start that patient, marker and camera have not moved, so that navigation continues.

        The confirmation is stored in the case with its author, unless it is no longer required.
        """
        confirm.confirm(requested.registration_id, made_by=person_of(request.scope).name)
        return message()

    return router


def procedure_message(
    state: ProcedureState, recording: RecordingStateMessage | None, setup_check: SetupCheck | None
) -> ProcedureMessage:
    """Return the message of the procedure in the language of the request."""
    language = requested_language()
    return ProcedureMessage(
        case_id=state.case_id or None,
        case_name=state.case_name or None,
        steps=[
            StepMessage(
                step=one.step,
                state=one.finding.state,
                code=one.finding.reason.code,
                message=one.finding.reason.message[language],
                remedy=one.finding.reason.remedy[language],
                language=one.finding.reason.language(language),
                numbers=dict(one.finding.numbers),
                document_id=one.finding.document_id or None,
                allowed=one.allowed,
                missing_cosignature=None
                if one.missing_cosignature is None
                else MissingSignatureMessage(
                    message=one.missing_cosignature.reason.message[language],
                    remedy=one.missing_cosignature.reason.remedy[language],
                ),
            )
            for one in state.steps
        ],
        next_step=state.next_step,
        may_navigate=state.status(StepName.NAVIGATE).finding.state is StepState.DONE,
        confirmation=None if state.confirmation is None else confirmation_message(state.confirmation),
        setup_check=None if setup_check is None else setup_check_message(setup_check),
        recording=recording,
    )


def confirmation_message(needed: ConfirmationPrompt) -> ConfirmationMessage:
    """Return the message of a required confirmation in the language of the request."""
    language = requested_language()
    return ConfirmationMessage(
        because=needed.because,
        message=needed.reason.message[language],
        remedy=needed.reason.remedy[language],
        registration_id=needed.registration.id,
        vertebra=needed.vertebra,
        registered_at=needed.registration.made_at,
        registered_by=needed.registration.maker,
        reference=needed.reference or None,
    )
