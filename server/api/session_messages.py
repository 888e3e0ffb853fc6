"""What is said of who is signed in, who is invited, and what was written down."""

from datetime import UTC, datetime
from typing import Annotated

from pydantic import AfterValidator, Field, StringConstraints

from server.security.people.records import Invitation, InvitationState, Session
from server.security.person import Role
from server.store.checks import checked_name
from server.stream.message import Message


def _storable(name: str) -> str:
    """What the store takes as the name of who did it: else nothing that they do could be kept."""
    return checked_name(name, of="name")


PersonName = Annotated[
    str,
    StringConstraints(strip_whitespace=True, min_length=1, max_length=80, pattern=r"^[^\x00-\x1f\x7f]+$"),
    AfterValidator(_storable),
]
# Three minutes: one that is over before it is used is no session.
SHORTEST_SESSION_H = 0.05


class SessionMessage(Message):
    """Who is signed in."""

    name: str
    role: Role
    expires_at: datetime | None
    """None where nobody has to sign in."""
    sign_in_required: bool


class EnterRequest(Message):
    """What opens the door: the part of the link after its #."""

    invitation: Annotated[str, StringConstraints(min_length=1, max_length=200)]


class EnteredMessage(SessionMessage):
    """Who is signed in now."""

    token: str | None
    """For a machine alone, to be sent as `Authorization: Bearer`; a browser has a cookie."""


class SignedInMessage(Message):
    """One session."""

    id: str
    name: str
    role: Role
    started_at: datetime
    expires_at: datetime
    for_machine: bool
    is_own: bool
    """It is the one that asks."""


class InvitationMessage(Message):
    """One invitation, without what opens the door."""

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
    """Who is signed in, and who is invited."""

    sign_in_required: bool
    sessions: list[SignedInMessage]
    """The newest first."""
    invitations: list[InvitationMessage]
    """The newest first; those that ended two days ago are forgotten."""


class InviteRequest(Message):
    """Somebody is to be invited."""

    name: PersonName
    """As they are called in the log."""
    role: Role
    lasts_h: Annotated[float, Field(gt=0.0, le=720.0)] = 24.0
    """How long the link lets in."""
    single_use: bool = True
    for_machine: bool = False
    """Its session is for a script: its token is told, and it sets no cookie."""
    session_lasts_h: Annotated[float, Field(ge=SHORTEST_SESSION_H, le=2160.0)] | None = None
    """How long they stay signed in; what the settings say if left out."""


class InvitedMessage(Message):
    """A new invitation. Its link is told once, here."""

    invitation: InvitationMessage
    link: str
    """To be opened in a browser; the part after # opens the door, and browsers send it to nobody."""
    qr_svg: str
    """The link as a QR code (SVG)."""
    is_reachable: bool
    """false: the link leads to this computer alone, because the server listens for nobody else."""


class AuditMessage(Message):
    """A part of the audit log."""

    lines: list[dict[str, object]]
    """The oldest first, with `number`, `at`, `who`, `what`, and where there are such: `of`, `status`, `code`,
    `changes` (each with `from` and `to`), `address`; `before` is the SHA-256 of the line before."""
    count: int
    """Of all lines."""
    sum: str
    """SHA-256 of the last line: whoever has it written down can tell later whether lines are missing."""
    is_whole: bool
    fault: str
    """What is wrong with the log; empty while it is whole."""
    fault_line: int | None


def signed_in_message(session: Session, *, own: Session | None) -> SignedInMessage:
    """The message of a session."""
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
    """The message of an invitation."""
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
