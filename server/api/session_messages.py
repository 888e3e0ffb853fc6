"""Messages about sessions, invitations and the audit log."""

from datetime import UTC, datetime
from typing import Annotated

from pydantic import AfterValidator, Field, StringConstraints

from server.security.people.records import Invitation, InvitationState, Session
from server.security.person import Role
from server.store.validation import validate_name
from server.stream.message import Message


def _storable(name: str) -> str:
    """Check that the store accepts the name as an author."""
    return validate_name(name, of="name")


PersonName = Annotated[
    str,
    StringConstraints(strip_whitespace=True, min_length=1, max_length=80, pattern=r"^[^\x00-\x1f\x7f]+$"),
    AfterValidator(_storable),
]
# Three minutes; a shorter session could end before it is used.
MIN_SESSION_H = 0.05


class SessionMessage(Message):
    """The current session."""

    name: str
    role: Role
    expires_at: datetime | None
    """null if sign-in is off."""
    sign_in_required: bool
    is_hub: bool
    """Whether this server is the hub of many theatres."""


class EnterRequest(Message):
    """Invitation token: the part of the link after the #."""

    invitation: Annotated[str, StringConstraints(min_length=1, max_length=200)]


class EnteredMessage(SessionMessage):
    """The new session."""

    token: str | None
    """For machines only, to be sent as `Authorization: Bearer`; browsers use a cookie."""


class SignedInMessage(Message):
    """One session."""

    id: str
    name: str
    role: Role
    started_at: datetime
    expires_at: datetime
    for_machine: bool
    is_own: bool
    """It is the session of this request."""


class InvitationMessage(Message):
    """An invitation without its token."""

    id: str
    name: str
    role: Role
    state: InvitationState
    made_by: str
    made_at: datetime
    expires_at: datetime
    single_use: bool
    for_machine: bool
    uses: int


class PeopleMessage(Message):
    """Sessions and invitations."""

    sign_in_required: bool
    sessions: list[SignedInMessage]
    """The newest first."""
    invitations: list[InvitationMessage]
    """Newest first; invitations that ended more than two days ago are omitted."""


class InviteRequest(Message):
    """A new invitation."""

    name: PersonName
    """Name in the audit log."""
    role: Role
    lasts_h: Annotated[float, Field(gt=0.0, le=720.0)] = 24.0
    """Lifetime of the link in hours."""
    single_use: bool = True
    for_machine: bool = False
    """The session is for a script: it receives a token instead of a cookie."""
    session_lasts_h: Annotated[float, Field(ge=MIN_SESSION_H, le=2160.0)] | None = None
    """Length of the session; default: from the settings."""


class InvitedMessage(Message):
    """A new invitation. Its link is only returned here."""

    invitation: InvitationMessage
    link: str
    """To be opened in a browser; the token after # is not sent to servers by browsers."""
    qr_svg: str
    """The link as a QR code (SVG)."""
    is_reachable: bool
    """false: the link only works on this computer, because the server listens on loopback."""


class AuditMessage(Message):
    """A part of the audit log."""

    lines: list[dict[str, object]]
    """Oldest first, with `number`, `at`, `who`, `what`, and optionally `of`, `status`, `code`, `changes`
    (each with `from` and `to`) and `address`; `before` is the SHA-256 of the previous line."""
    count: int
    """Total number of lines."""
    sum: str
    """SHA-256 of the last line; recorded elsewhere, it allows missing lines to be detected later."""
    is_intact: bool
    fault: str
    """Description of the first fault; empty if the log is intact."""
    fault_line: int | None


def signed_in_message(session: Session, *, own: Session | None) -> SignedInMessage:
    """Return the message of a session."""
    return SignedInMessage(
        id=session.id,
        name=session.person.name,
        role=session.person.role,
        started_at=session.started_at.astimezone(UTC),
        expires_at=session.expires_at.astimezone(UTC),
        for_machine=session.for_machine,
        is_own=own is not None and own.id == session.id,
    )


def invitation_message(invitation: Invitation, state: InvitationState) -> InvitationMessage:
    """Return the message of an invitation."""
    return InvitationMessage(
        id=invitation.id,
        name=invitation.person.name,
        role=invitation.person.role,
        state=state,
        made_by=invitation.made_by,
        made_at=invitation.made_at.astimezone(UTC),
        expires_at=invitation.expires_at.astimezone(UTC),
        single_use=invitation.single_use,
        for_machine=invitation.for_machine,
        uses=invitation.uses,
    )
