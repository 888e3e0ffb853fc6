"""Invitations and sessions: invite, sign in, look up, end. All of it survives a restart."""

import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from datetime import timedelta
from pathlib import Path

import structlog

from server.clock import Clock, SteadyClock
from server.security.audit import AuditLog
from server.security.people.failed_logins import FailedLogins
from server.security.people.file import read_people, write_people
from server.security.people.rate_limiter import RateLimiter
from server.security.people.records import Invitation, InvitationState, Session
from server.security.people.retention import PeopleRecords
from server.security.people.tokens import Token, new_id
from server.security.person import SERVER, Person, Role
from server.security.rejections import (
    InvitationRejected,
    PersonUnknown,
    SessionRejected,
    TooManyTries,
)
from server.store import StoreError, translate_errors

log = structlog.get_logger(__name__)
PEOPLE_FILE = "people.json"
OPERATOR_NAME = "Operator"
OPERATOR_LINK_VALID_FOR = timedelta(hours=24)
# Maximum sessions by one link: a hall of onlookers, but no program that signs in repeatedly.
MAX_SESSIONS_PER_LINK = 20
# Each sign-in is an audit entry: a full hall twice in an hour, but no program that fills the disk.
MAX_SIGN_INS_PER_LINK, SIGN_IN_WINDOW_S = 40, 3600.0
REJECTED_BY_STATE = {
    InvitationState.USED: InvitationRejected.used,
    InvitationState.EXPIRED: InvitationRejected.expired,
    InvitationState.REVOKED: InvitationRejected.revoked,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class NewInvitation:
    """Properties of an invitation to be made."""

    name: str
    role: Role
    lasts: timedelta
    single_use: bool = True
    for_machine: bool = False
    session_lasts: timedelta | None = None


class PeopleService:
    """Invitations and sessions of one server. Thread-safe.

    Looking up a session waits for nothing; every change waits for the disk.

    Args:
        folder: storage folder.
        audit: audit log.
        required: whether sign-in is required at all.
        session_lasts: default lifetime of a session.
        clock: clock in UTC: sessions end at a time of day, over restarts. By default one that is steady, so
            that nobody is signed out, or stays signed in, because the computer's clock was set.
        seconds: monotonic clock, for the rate limits.

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
        clock: Clock | None = None,
        seconds: Callable[[], float] = time.monotonic,
    ) -> None:
        self.audit = audit
        self.required = required
        self._folder = folder
        self._file = folder / PEOPLE_FILE
        self._session_lasts = session_lasts
        self._clock = clock or SteadyClock()
        self._seconds = seconds
        self._failed_logins = FailedLogins(clock=seconds)
        self._sign_ins = RateLimiter(max_count=MAX_SIGN_INS_PER_LINK, window_s=SIGN_IN_WINDOW_S)
        self._lock = threading.RLock()
        with translate_errors(folder):
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            invitations, sessions = read_people(self._file)
        # Immutable and replaced as a whole: the event loop reads them without a lock.
        self._invitations: Mapping[str, Invitation] = {one.id: one for one in invitations}
        self._sessions: Mapping[str, Session] = {one.id: one for one in sessions}

    # ------------------------------------------------------------ look-up

    def session_of(self, shown: str, *, address: str) -> Session:
        """Return the session of a token.

        A valid token is accepted regardless of failed attempts from its address: a theatre's screen must not
        go dark because somebody guesses behind the same router.

        Raises:
            SessionRejected: SESSION_EXPIRED.
            TooManyTries: too many unknown tokens.
        """
        token = Token.read(shown)
        session = None if token is None else self._sessions.get(token.id)
        if token is None or session is None or not token.matches(session.token_sum):
            self._count_failed_login(address)
            raise SessionRejected.expired()
        if not session.is_valid(self._clock()):
            raise SessionRejected.expired()
        return session

    def is_valid(self, session_id: str) -> bool:
        """Return whether a session is still valid."""
        session = self._sessions.get(session_id)
        return session is not None and session.is_valid(self._clock())

    def role_of(self, shown: str) -> Role | None:
        """Return the role of the token of a session or invitation; None for an unknown token."""
        token = Token.read(shown)
        record = None if token is None else self._sessions.get(token.id) or self._invitations.get(token.id)
        if token is None or record is None or not token.matches(record.token_sum):
            return None
        return record.person.role

    def sessions(self) -> list[Session]:
        """Return all valid sessions, newest first."""
        now = self._clock()
        holding = [one for one in self._sessions.values() if one.is_valid(now)]
        return sorted(holding, key=lambda one: one.started_at, reverse=True)

    def invitations(self) -> list[tuple[Invitation, InvitationState]]:
        """Return all recorded invitations, newest first."""
        now = self._clock()
        stored = [(one, one.state(now)) for one in self._invitations.values()]
        return sorted(stored, key=lambda one: one[0].made_at, reverse=True)

    # ------------------------------------------------------------ changes

    def invite(self, wanted: NewInvitation, *, by: str) -> tuple[Invitation, Token]:
        """Make an invitation; its token is returned only here.

        Raises:
            PeopleRejected: TOO_MANY_PEOPLE.
            StoreError: it cannot be stored.
        """
        token = Token.new()
        with self._lock:
            invitation = self._invitation(wanted, token, by=by)
            self._keep(invitation=invitation, enforces_limit=True)
        return invitation, token

    def _invitation(self, wanted: NewInvitation, token: Token, *, by: str) -> Invitation:
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

    def sign_in(self, shown: str, *, address: str) -> tuple[Session, Token]:
        """Start a session with an invitation's token.

        Failed attempts from the same address do not matter: 256 bits cannot be guessed, and otherwise wrong
        links tried behind the same router would lock the surgeon out.

        Raises:
            InvitationRejected: unknown, used, expired, revoked or full.
            PeopleRejected: TOO_MANY_PEOPLE.
            TooManyTries: too many unknown tokens, or too many sign-ins by this link.
            StoreError: the session cannot be stored, and is no operator's.
        """
        found = Token.read(shown)
        with self._lock:
            invitation = None if found is None else self._invitations.get(found.id)
            if found is None or invitation is None or not found.matches(invitation.token_sum):
                self._count_failed_login(address)
                raise InvitationRejected.unknown()
            now = self._clock()
            state = invitation.state(now)
            if state is not InvitationState.OPEN:
                raise REJECTED_BY_STATE[state]()
            by_it = sum(one.invitation_id == invitation.id for one in self.sessions())
            if by_it >= MAX_SESSIONS_PER_LINK:
                raise InvitationRejected.full(by_it)
            wait_s = self._sign_ins.wait_s(invitation.id, self._seconds())
            if wait_s > 0.0:
                raise TooManyTries.signing_in(MAX_SIGN_INS_PER_LINK, SIGN_IN_WINDOW_S, wait_s)
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
            self._add_session(replace(invitation, uses=invitation.uses + 1), session)
            self._sign_ins.count(invitation.id, self._seconds())
        return session, token

    def end_session(self, session_id: str) -> Session:
        """End a session: its sockets and streams end within two seconds.

        Raises:
            PersonUnknown: SESSION_UNKNOWN.
            StoreError: it cannot be stored; the session has ended all the same, until a restart.
        """
        with self._lock:
            session = self._sessions.get(session_id)
            if session is None or not session.is_valid(self._clock()):
                raise PersonUnknown.of("session", session_id)
            ended = replace(session, ended_at=self._clock())
            self._sessions = {**self._sessions, session_id: ended}
            self._keep(session=ended)
        return ended

    def revoke(self, invitation_id: str) -> Invitation:
        """Revoke an invitation; its sessions stay until they are ended.

        Raises:
            PersonUnknown: INVITATION_UNKNOWN.
            StoreError: it cannot be stored; the invitation is revoked all the same, until a restart.
        """
        with self._lock:
            invitation = self._invitations.get(invitation_id)
            if invitation is None:
                raise PersonUnknown.of("invitation", invitation_id)
            revoked = replace(invitation, revoked_at=invitation.revoked_at or self._clock())
            self._invitations = {**self._invitations, invitation_id: revoked}
            self._keep(invitation=revoked)
        return revoked

    def operator_token(self, *, wanted: bool) -> Token | None:
        """Return a token if no operator is signed in or one is requested; older links are revoked.

        Raises:
            StoreError: it cannot be stored.
        """
        with self._lock:
            there = any(one.person.role is Role.OPERATOR and not one.for_machine for one in self.sessions())
            if not self.required or (there and not wanted):
                return None
            for one, state in self.invitations():
                if one.made_by == SERVER.name and state is InvitationState.OPEN:
                    self.revoke(one.id)
            first, token = (
                NewInvitation(name=OPERATOR_NAME, role=Role.OPERATOR, lasts=OPERATOR_LINK_VALID_FOR),
                Token.new(),
            )
            # Not limited: without it nobody could sign in to end sessions.
            self._keep(invitation=self._invitation(first, token, by=SERVER.name))
            return token

    def _add_session(self, used: Invitation, session: Session) -> None:
        """Store a new session; an operator's is accepted even on a full disk, to free space on it."""
        if used.person.role is not Role.OPERATOR:
            self._keep(invitation=used, session=session, enforces_limit=True)
            return
        try:
            self._keep(invitation=used, session=session)
        except StoreError as error:
            log.warning("an operator's session lasts only until the next start", code=error.code)
            self._invitations = {**self._invitations, used.id: used}
            self._sessions = {**self._sessions, session.id: session}

    def _count_failed_login(self, address: str) -> None:
        wait_s = self._failed_logins.wrong(address)
        if wait_s > 0:
            raise TooManyTries.wait(wait_s)

    def _keep(
        self,
        *,
        invitation: Invitation | None = None,
        session: Session | None = None,
        enforces_limit: bool = False,
    ) -> None:
        """Store records on the disk first, then in memory; the limit is checked where required."""
        people = PeopleRecords(invitations=self._invitations, sessions=self._sessions)
        stored = people.with_records(invitation, session, now=self._clock())
        if enforces_limit:
            stored.reject_too_many()
        with translate_errors(self._folder):
            write_people(self._file, stored.invitations.values(), stored.sessions.values())
        self._invitations, self._sessions = stored.invitations, stored.sessions
