"""Records of invitations and sessions."""

from dataclasses import dataclass
from datetime import datetime, timedelta
from enum import StrEnum

from server.security.person import Person


class InvitationState(StrEnum):
    """State of an invitation."""

    OPEN = "open"
    USED = "used"
    EXPIRED = "expired"
    REVOKED = "revoked"


@dataclass(frozen=True, slots=True, kw_only=True)
class Invitation:
    """A link with which its person can sign in.

    Attributes:
        id: its id.
        person: person and role; the same over all its sessions.
        made_by: who invited.
        made_at: when, UTC.
        expires_at: end of its validity.
        single_use: whether it allows a single sign-in.
        for_machine: whether its sessions are for scripts: the token is returned, and no cookie is set.
        session_lasts: lifetime of its sessions.
        token_sum: SHA-256 of its token.
        uses: number of sign-ins.
        revoked_at: time of the revocation.
    """

    id: str
    person: Person
    made_by: str
    made_at: datetime
    expires_at: datetime
    single_use: bool
    for_machine: bool
    session_lasts: timedelta
    token_sum: str
    uses: int = 0
    revoked_at: datetime | None = None

    def state(self, now: datetime) -> InvitationState:
        """Return its state now."""
        if self.revoked_at is not None:
            return InvitationState.REVOKED
        if self.single_use and self.uses:
            return InvitationState.USED
        return InvitationState.EXPIRED if now >= self.expires_at else InvitationState.OPEN


@dataclass(frozen=True, slots=True, kw_only=True)
class Session:
    """A signed-in session.

    Attributes:
        id: its id.
        person: its person.
        invitation_id: the invitation that was used.
        started_at: UTC.
        expires_at: end of its validity.
        for_machine: whether it is a script's.
        token_sum: SHA-256 of its token.
        ended_at: when it was ended before its expiry.
    """

    id: str
    person: Person
    invitation_id: str
    started_at: datetime
    expires_at: datetime
    for_machine: bool
    token_sum: str
    ended_at: datetime | None = None

    def is_valid(self, now: datetime) -> bool:
        """Return whether it is valid now."""
        return self.ended_at is None and now < self.expires_at

    def ends_at(self) -> datetime:
        """Return when it ended, or will."""
        return self.expires_at if self.ended_at is None else min(self.ended_at, self.expires_at)
