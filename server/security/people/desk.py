"""The desk at the door: invites, lets in, knows who is there, sends away. All of it outlasts a restart."""

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

from server.security.audit import AuditLog
from server.security.people.file import read_people, write_people
from server.security.people.guesses import Guesses
from server.security.people.records import Invitation, InvitationState, Session
from server.security.people.tokens import Token, new_id
from server.security.person import SERVER, Person, Role
from server.security.refusals import InvitationRefused, PersonUnknown, SessionRefused, TooManyTries
from server.store import StoreError, told

PEOPLE_FILE = "people.json"
OPERATOR_NAME = "Operator"
OPERATOR_LINK_LASTS = timedelta(hours=24)
# What has ended is remembered for so long, to tell people why they do not get in.
REMEMBERED = timedelta(days=2)
MOST_KEPT = 1000
REFUSED_BY_STATE = {
    InvitationState.USED: InvitationRefused.used,
    InvitationState.EXPIRED: InvitationRefused.expired,
    InvitationState.REVOKED: InvitationRefused.revoked,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Wanted:
    """An invitation that somebody wants to make."""

    name: str
    role: Role
    lasts: timedelta
    single_use: bool = True
    for_machine: bool = False
    session_lasts: timedelta | None = None


class PeopleDesk:
    """Invitations and sessions of one server. Safe to use from any thread.

    Asking who somebody is takes no disk; whatever changes something waits for it.

    Args:
        folder: where they are kept.
        audit: where it is written down.
        required: whether people have to sign in at all.
        session_lasts: where an invitation says nothing else.
        clock: the wall clock in UTC: sessions end at a time of the day, over restarts.
        seconds: a monotonic clock, for guesses.

    Raises:
        StoreError: PEOPLE_DAMAGED, or the folder cannot be used.
    """

    def __init__(
        self,
        folder: Path,
        *,
        audit: AuditLog,
        required: bool = True,
        session_lasts: timedelta = timedelta(hours=12),
        clock: Callable[[], datetime] = lambda: datetime.now(tz=UTC),
        seconds: Callable[[], float] = time.monotonic,
    ) -> None:
        self.audit = audit
        self.required = required
        self._folder = folder
        self._file = folder / PEOPLE_FILE
        self._session_lasts = session_lasts
        self._clock = clock
        self._guesses = Guesses(clock=seconds)
        self._turn = threading.RLock()
        with told(folder):
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            invitations, sessions = read_people(self._file)
        self._invitations = {one.id: one for one in invitations}
        self._sessions = {one.id: one for one in sessions}

    # ------------------------------------------------------------ who is there

    def who(self, shown: str, *, address: str) -> Session:
        """Whose session this token is.

        A right token is let in however much its address has guessed: a theatre's screen must not go dark
        because somebody guesses behind the same router.

        Raises:
            SessionRefused: SESSION_EXPIRED.
            TooManyTries: the token is wrong, and so were too many before.
        """
        token = Token.read(shown)
        with self._turn:
            session = None if token is None else self._sessions.get(token.id)
            if token is not None and session is not None and token.opens(session.token_sum):
                if session.holds(self._clock()):
                    return session
                raise SessionRefused.expired()
            self._refuse_guessing(address)
            self._guesses.wrong(address)
        raise SessionRefused.expired()

    def holds(self, session_id: str) -> bool:
        """Whether a session that held once still does."""
        with self._turn:
            session = self._sessions.get(session_id)
            return session is not None and session.holds(self._clock())

    def sessions(self) -> list[Session]:
        """All that hold now, the newest first."""
        with self._turn:
            now = self._clock()
            holding = [one for one in self._sessions.values() if one.holds(now)]
        return sorted(holding, key=lambda one: one.started_at, reverse=True)

    def invitations(self) -> list[tuple[Invitation, InvitationState]]:
        """All that are remembered, the newest first."""
        with self._turn:
            now = self._clock()
            kept = [(one, one.state(now)) for one in self._invitations.values()]
        return sorted(kept, key=lambda one: one[0].made_at, reverse=True)

    # ------------------------------------------------------------ in and out

    def invite(self, wanted: Wanted, *, by: str) -> tuple[Invitation, Token]:
        """Make an invitation; its token is known here and now, and never again.

        Raises:
            StoreError: it cannot be kept, or there are too many.
        """
        token = Token.new()
        with self._turn:
            now = self._clock()
            invitation = Invitation(
                id=token.id,
                person=Person(id=new_id(), name=wanted.name, role=wanted.role),
                made_by=by,
                made_at=now,
                expires_at=now + wanted.lasts,
                single_use=wanted.single_use,
                for_machine=wanted.for_machine,
                session_lasts=wanted.session_lasts or self._session_lasts,
                token_sum=token.sum,
            )
            self._keep(invitation=invitation)
        return invitation, token

    def enter(self, shown: str, *, address: str) -> tuple[Session, Token]:
        """Let in who has this invitation.

        Raises:
            InvitationRefused: it lets nobody in, or no longer.
            TooManyTries: too many wrong ones came before.
            StoreError: the session cannot be kept.
        """
        found = Token.read(shown)
        with self._turn:
            # Here even a right one waits, or guessing would only be told less about, and not be slower.
            self._refuse_guessing(address)
            invitation = None if found is None else self._invitations.get(found.id)
            if found is None or invitation is None or not found.opens(invitation.token_sum):
                self._guesses.wrong(address)
                raise InvitationRefused.unknown()
            now = self._clock()
            state = invitation.state(now)
            if state is not InvitationState.OPEN:
                raise REFUSED_BY_STATE[state]()
            token = Token.new()
            session = Session(
                id=token.id,
                person=invitation.person,
                invitation_id=invitation.id,
                started_at=now,
                expires_at=now + invitation.session_lasts,
                for_machine=invitation.for_machine,
                token_sum=token.sum,
            )
            self._keep(invitation=replace(invitation, uses=invitation.uses + 1), session=session)
        return session, token

    def end(self, session_id: str) -> Session:
        """End a session: its sockets and pictures end within two seconds.

        Raises:
            PersonUnknown: SESSION_UNKNOWN.
            StoreError: that cannot be kept; it has ended all the same, until a restart.
        """
        with self._turn:
            session = self._sessions.get(session_id)
            if session is None or not session.holds(self._clock()):
                raise PersonUnknown.of("session", session_id)
            ended = replace(session, ended_at=self._clock())
            self._sessions[session_id] = ended
            self._keep(session=ended)
        return ended

    def revoke(self, invitation_id: str) -> Invitation:
        """Take an invitation back; who came by it stays until their session is ended.

        Raises:
            PersonUnknown: INVITATION_UNKNOWN.
            StoreError: that cannot be kept; it lets nobody in all the same, until a restart.
        """
        with self._turn:
            invitation = self._invitations.get(invitation_id)
            if invitation is None:
                raise PersonUnknown.of("invitation", invitation_id)
            revoked = replace(invitation, revoked_at=invitation.revoked_at or self._clock())
            self._invitations[invitation_id] = revoked
            self._keep(invitation=revoked)
        return revoked

    def operator_token(self, *, wanted: bool) -> Token | None:
        """A token for the operator, where none is signed in or one is asked for; older ones of its kind end.

        Raises:
            StoreError: it cannot be kept.
        """
        with self._turn:
            there = any(one.person.role is Role.OPERATOR and not one.for_machine for one in self.sessions())
            if not self.required or (there and not wanted):
                return None
            for one, state in self.invitations():
                if one.made_by == SERVER.name and state is InvitationState.OPEN:
                    self.revoke(one.id)
            first = Wanted(name=OPERATOR_NAME, role=Role.OPERATOR, lasts=OPERATOR_LINK_LASTS)
            return self.invite(first, by=SERVER.name)[1]

    def _refuse_guessing(self, address: str) -> None:
        wait_s = self._guesses.wait_s(address)
        if wait_s > 0:
            raise TooManyTries.wait(wait_s)

    def _keep(self, *, invitation: Invitation | None = None, session: Session | None = None) -> None:
        """Have these on the disk first, and hold then; what ended long ago is forgotten."""
        now = self._clock()
        invitations = {
            key: one
            for key, one in self._invitations.items()
            if now < one.expires_at + REMEMBERED and now < (one.revoked_at or now) + REMEMBERED
        }
        sessions = {key: one for key, one in self._sessions.items() if now < one.over_at() + REMEMBERED}
        if invitation is not None:
            invitations[invitation.id] = invitation
        if session is not None:
            sessions[session.id] = session
        if len(invitations) + len(sessions) > MOST_KEPT:
            raise StoreError(
                "TOO_MANY_PEOPLE",
                f"{len(invitations)} invitations and {len(sessions)} sessions are kept, allowed: {MOST_KEPT}",
                "Take back invitations and end sessions that nobody needs; they are forgotten in two days.",
                {"invitations": len(invitations), "sessions": len(sessions), "allowed": MOST_KEPT},
            )
        with told(self._folder):
            write_people(self._file, invitations.values(), sessions.values())
        self._invitations, self._sessions = invitations, sessions
