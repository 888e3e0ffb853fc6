"""Retention of invitations and sessions: all valid ones, and the newest that have ended."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Self

from server.security.people.records import Invitation, InvitationState, Session
from server.security.rejections import PeopleRejected

# Retention of ended records, to explain a failed sign-in.
RETENTION = timedelta(days=2)
MAX_RECORDS = 1000
OVER = frozenset(InvitationState) - {InvitationState.OPEN}


@dataclass(frozen=True, slots=True, kw_only=True)
class PeopleRecords:
    """Invitations and sessions by id; immutable."""

    invitations: Mapping[str, Invitation]
    sessions: Mapping[str, Session]

    def reject_too_many(self) -> None:
        """Reject one more record above the limit.

        Raises:
            PeopleRejected: TOO_MANY_PEOPLE.
        """
        count = len(self.invitations) + len(self.sessions)
        if count > MAX_RECORDS:
            raise PeopleRejected.too_many(count, MAX_RECORDS)

    def with_records(self, invitation: Invitation | None, session: Session | None, *, now: datetime) -> Self:
        """Return a copy with these two, without records that ended two days ago or exceed the limit.

        Valid records are never dropped: there can be more than `MAX_RECORDS`.
        """
        sessions = {key: one for key, one in self.sessions.items() if now < one.ends_at() + RETENTION}
        if session is not None:
            sessions[session.id] = session
        invitations = {key: one for key, one in self.invitations.items() if now < _ends_at(one) + RETENTION}
        if invitation is not None:
            invitations[invitation.id] = invitation
        too_many = max(0, len(sessions) + len(invitations) - MAX_RECORDS)
        ended = {key: one.ends_at() for key, one in sessions.items() if not one.is_valid(now)}
        for key in _oldest(ended, too_many):
            del sessions[key]
        too_many = max(0, len(sessions) + len(invitations) - MAX_RECORDS)
        over = {key: _ends_at(one) for key, one in invitations.items() if one.state(now) in OVER}
        for key in _oldest(over, too_many):
            del invitations[key]
        return type(self)(invitations=invitations, sessions=sessions)


def _ends_at(one: Invitation) -> datetime:
    return one.expires_at if one.revoked_at is None else min(one.revoked_at, one.expires_at)


def _oldest(ends_at: Mapping[str, datetime], count: int) -> list[str]:
    return sorted(ends_at, key=lambda key: ends_at[key])[:count]
