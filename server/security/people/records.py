"""An invitation, and a session that somebody has by one."""

from dataclasses import dataclass
from datetime import datetime, timedelta
from enum import StrEnum

from server.security.person import Person


class InvitationState(StrEnum):
    """Whether an invitation still lets somebody in."""

    OPEN = "open"
    USED = "used"
    EXPIRED = "expired"
    REVOKED = "revoked"


@dataclass(frozen=True, slots=True, kw_only=True)
class Invitation:
    """Lets somebody in who has its token.

    Attributes:
        id: names it.
        person: who is let in, with which role; the same over all sessions that come of it.
        made_by: who invited.
        made_at: when, UTC.
        expires_at: until when it lets in.
        single_use: it lets in once.
        for_machine: its sessions are for scripts: the token is told, and no cookie is set.
        session_lasts: how long a session lasts that comes of it.
        token_sum: of its token.
        uses: how often it has let in.
        revoked_at: when it was taken back.
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
        """Whether it lets in now."""
        if self.revoked_at is not None:
            return InvitationState.REVOKED
        if self.single_use and self.uses:
            return InvitationState.USED
        return InvitationState.EXPIRED if now >= self.expires_at else InvitationState.OPEN


@dataclass(frozen=True, slots=True, kw_only=True)
class Session:
    """Somebody is signed in.

    Attributes:
        id: names it.
        person: who.
        invitation_id: by which one they came.
        started_at: UTC.
        expires_at: when it ends by itself.
        for_machine: a script's.
        token_sum: of its token.
        ended_at: when somebody ended it.
    """

    id: str
    person: Person
    invitation_id: str
    started_at: datetime
    expires_at: datetime
    for_machine: bool
    token_sum: str
    ended_at: datetime | None = None

    def holds(self, now: datetime) -> bool:
        """Whether it lets in now."""
        return self.ended_at is None and now < self.expires_at

    def over_at(self) -> datetime:
        """When it ended, or will."""
        return self.expires_at if self.ended_at is None else min(self.ended_at, self.expires_at)
