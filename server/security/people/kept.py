"""What is remembered of people: all that holds, and of what has ended the newest, to say why it is over."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Self

from server.security.people.records import Invitation, InvitationState, Session
from server.security.rejections import PeopleRejected

# What has ended is remembered for so long, to tell people why they do not get in.
REMEMBERED = timedelta(days=2)
MAX_KEPT = 1000
OVER = frozenset(InvitationState) - {InvitationState.OPEN}


@dataclass(frozen=True, slots=True, kw_only=True)
class People:
    """Invitations and sessions by their id; never changed."""

    invitations: Mapping[str, Invitation]
    sessions: Mapping[str, Session]

    def reject_crowd(self) -> None:
        """To be asked before one more is let in.

        Raises:
            PeopleRejected: TOO_MANY_PEOPLE.
        """
        count = len(self.invitations) + len(self.sessions)
        if count > MAX_KEPT:
            raise PeopleRejected.too_many(count, MAX_KEPT)

    def with_these(self, invitation: Invitation | None, session: Session | None, *, now: datetime) -> Self:
        """With these two; what ended two days ago, and first of all where there are too many, is forgotten.

        What holds is never forgotten: there can be more than `MAX_KEPT`.
        """
        sessions = {key: one for key, one in self.sessions.items() if now < one.over_at() + REMEMBERED}
        if session is not None:
            sessions[session.id] = session
        invitations = {key: one for key, one in self.invitations.items() if now < _over_at(one) + REMEMBERED}
        if invitation is not None:
            invitations[invitation.id] = invitation
        too_many = max(0, len(sessions) + len(invitations) - MAX_KEPT)
        ended = {key: one.over_at() for key, one in sessions.items() if not one.holds(now)}
        for key in _oldest(ended, too_many):
            del sessions[key]
        too_many = max(0, len(sessions) + len(invitations) - MAX_KEPT)
        over = {key: _over_at(one) for key, one in invitations.items() if one.state(now) in OVER}
        for key in _oldest(over, too_many):
            del invitations[key]
        return type(self)(invitations=invitations, sessions=sessions)


def _over_at(one: Invitation) -> datetime:
    return one.expires_at if one.revoked_at is None else min(one.revoked_at, one.expires_at)


def _oldest(over_at: Mapping[str, datetime], count: int) -> list[str]:
    return sorted(over_at, key=lambda key: over_at[key])[:count]
