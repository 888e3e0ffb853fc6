"""The desk at the door: invites, lets in, knows who is there, sends away. All of it outlasts a restart."""

import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import structlog

from server.security.audit import AuditLog
from server.security.people.file import read_people, write_people
from server.security.people.guesses import Guesses
from server.security.people.kept import People
from server.security.people.often import Often
from server.security.people.records import Invitation, InvitationState, Session
from server.security.people.tokens import Token, new_id
from server.security.person import SERVER, Person, Role
from server.security.rejections import (
    InvitationRejected,
    PersonUnknown,
    SessionRejected,
    TooManyTries,
)
from server.store import StoreError, told

log = structlog.get_logger(__name__)
PEOPLE_FILE = "people.json"
OPERATOR_NAME = "Operator"
OPERATOR_LINK_LASTS = timedelta(hours=24)
# Who is in by one link: a hall of onlookers, and not a program that signs in again and again.
MAX_BY_ONE_LINK = 20
# Each sign-in is a line of the audit log: a full hall twice in an hour, and no program that fills the disk.
SIGN_INS_BY_ONE_LINK, SIGN_INS_WITHIN_S = 40, 3600.0
REJECTED_BY_STATE = {
    InvitationState.USED: InvitationRejected.used,
    InvitationState.EXPIRED: InvitationRejected.expired,
    InvitationState.REVOKED: InvitationRejected.revoked,
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

    Asking who somebody is waits for nothing; whatever changes something waits for the disk.

    Args:
        folder: where they are kept.
        audit: where it is written down.
        required: whether people have to sign in at all.
        session_lasts: where an invitation says nothing else.
        clock: the wall clock in UTC: sessions end at a time of the day, over restarts.
        seconds: a monotonic clock, for guesses and for how often a link lets in.

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
        self._seconds = seconds
        self._guesses = Guesses(clock=seconds)
        self._sign_ins = Often(most=SIGN_INS_BY_ONE_LINK, window_s=SIGN_INS_WITHIN_S)
        self._turn = threading.RLock()
        with told(folder):
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            invitations, sessions = read_people(self._file)
        # Never changed, only put in place of each other: who asks, in the event loop, waits for no lock.
        self._invitations: Mapping[str, Invitation] = {one.id: one for one in invitations}
        self._sessions: Mapping[str, Session] = {one.id: one for one in sessions}

    # ------------------------------------------------------------ who is there

    def who(self, shown: str, *, address: str) -> Session:
        """Whose session this token is.

        A right token is let in however much its address has guessed: a theatre's screen must not go dark
        because somebody guesses behind the same router.

        Raises:
            SessionRejected: SESSION_EXPIRED.
            TooManyTries: the token is wrong, and so were too many before.
        """
        token = Token.read(shown)
        session = None if token is None else self._sessions.get(token.id)
        if token is None or session is None or not token.opens(session.token_sum):
            self._count_guess(address)
            raise SessionRejected.expired()
        if not session.holds(self._clock()):
            raise SessionRejected.expired()
        return session

    def holds(self, session_id: str) -> bool:
        """Whether a session that held once still does."""
        session = self._sessions.get(session_id)
        return session is not None and session.holds(self._clock())

    def sessions(self) -> list[Session]:
        """All that hold now, the newest first."""
        now = self._clock()
        holding = [one for one in self._sessions.values() if one.holds(now)]
        return sorted(holding, key=lambda one: one.started_at, reverse=True)

    def invitations(self) -> list[tuple[Invitation, InvitationState]]:
        """All that are remembered, the newest first."""
        now = self._clock()
        kept = [(one, one.state(now)) for one in self._invitations.values()]
        return sorted(kept, key=lambda one: one[0].made_at, reverse=True)

    # ------------------------------------------------------------ in and out

    def invite(self, wanted: Wanted, *, by: str) -> tuple[Invitation, Token]:
        """Make an invitation; its token is known here and now, and never again.

        Raises:
            PeopleRejected: TOO_MANY_PEOPLE.
            StoreError: it cannot be kept.
        """
        token = Token.new()
        with self._turn:
            invitation = self._invitation(wanted, token, by=by)
            self._keep(invitation=invitation, room_needed=True)
        return invitation, token

    def _invitation(self, wanted: Wanted, token: Token, *, by: str) -> Invitation:
        now = self._clock()
        return Invitation(
            id=token.id,
            person=Person(id=new_id(), name=wanted.name, role=wanted.role, invited_by=by),
            made_by=by,
            made_at=now,
            expires_at=now + wanted.lasts,
            single_use=wanted.single_use,
            for_machine=wanted.for_machine,
            session_lasts=self._session_lasts if wanted.session_lasts is None else wanted.session_lasts,
            token_sum=token.sum,
        )

    def enter(self, shown: str, *, address: str) -> tuple[Session, Token]:
        """Let in who has this invitation.

        However much their address has guessed: nobody guesses 256 bits, and else whoever tries wrong links
        behind the same router would keep the surgeon out.

        Raises:
            InvitationRejected: it lets nobody in, or no longer, or no more.
            PeopleRejected: TOO_MANY_PEOPLE.
            TooManyTries: the token is wrong, and so were too many before; or it let in too often of late.
            StoreError: the session cannot be kept, and is no operator's.
        """
        found = Token.read(shown)
        with self._turn:
            invitation = None if found is None else self._invitations.get(found.id)
            if found is None or invitation is None or not found.opens(invitation.token_sum):
                self._count_guess(address)
                raise InvitationRejected.unknown()
            now = self._clock()
            state = invitation.state(now)
            if state is not InvitationState.OPEN:
                raise REJECTED_BY_STATE[state]()
            by_it = sum(one.invitation_id == invitation.id for one in self.sessions())
            if by_it >= MAX_BY_ONE_LINK:
                raise InvitationRejected.full(by_it)
            wait_s = self._sign_ins.wait_s(invitation.id, self._seconds())
            if wait_s > 0.0:
                raise TooManyTries.signing_in(SIGN_INS_BY_ONE_LINK, SIGN_INS_WITHIN_S, wait_s)
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
            self._let_in(replace(invitation, uses=invitation.uses + 1), session)
            self._sign_ins.count(invitation.id, self._seconds())
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
            self._sessions = {**self._sessions, session_id: ended}
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
            self._invitations = {**self._invitations, invitation_id: revoked}
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
            first, token = (
                Wanted(name=OPERATOR_NAME, role=Role.OPERATOR, lasts=OPERATOR_LINK_LASTS),
                Token.new(),
            )
            # However many people there are: without it nobody could come in and send some away.
            self._keep(invitation=self._invitation(first, token, by=SERVER.name))
            return token

    def _let_in(self, used: Invitation, session: Session) -> None:
        """Keep who comes; an operator is let in by a full disk, too: who else could make room on it."""
        if used.person.role is not Role.OPERATOR:
            self._keep(invitation=used, session=session, room_needed=True)
            return
        try:
            self._keep(invitation=used, session=session)
        except StoreError as error:
            log.warning("an operator is signed in until the next start alone", code=error.code)
            self._invitations = {**self._invitations, used.id: used}
            self._sessions = {**self._sessions, session.id: session}

    def _count_guess(self, address: str) -> None:
        wait_s = self._guesses.wrong(address)
        if wait_s > 0:
            raise TooManyTries.wait(wait_s)

    def _keep(
        self,
        *,
        invitation: Invitation | None = None,
        session: Session | None = None,
        room_needed: bool = False,
    ) -> None:
        """Have these on the disk first, and hold then; refuse them in a crowd, where there has to be room."""
        people = People(invitations=self._invitations, sessions=self._sessions)
        kept = people.with_these(invitation, session, now=self._clock())
        if room_needed:
            kept.reject_crowd()
        with told(self._folder):
            write_people(self._file, kept.invitations.values(), kept.sessions.values())
        self._invitations, self._sessions = kept.invitations, kept.sessions
