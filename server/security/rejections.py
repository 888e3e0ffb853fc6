"""What can go wrong at the door.

NavigationError
├── SessionRejected      nobody is signed in, or no longer               HTTP 401
├── RoleRejected         somebody is, and may not do this                HTTP 403
├── PageRejected         it is another page that asks for it             HTTP 403
├── AddressUnknown      there is nothing at this address                HTTP 404
├── MethodUnknown       it cannot be done at this address               HTTP 405
├── InvitationRejected   an invitation that lets nobody in               HTTP 403
├── PeopleRejected       there are too many of them                      HTTP 409
├── TooManyTries        somebody guesses, or signs in again and again   HTTP 429
├── PersonUnknown       there is no such session or invitation          HTTP 404
└── SignInOff           nobody has to sign in, so nobody can be invited HTTP 409
"""

import math

from server.security.person import Person, Role
from tracker.errors import NavigationError

SIGN_IN = "Sign in with the link that the server printed at its start, or ask the operator for an invitation."
ASK_AGAIN = "Ask the operator for a new invitation; an operator starts the server with --new-operator-link."


class SessionRejected(NavigationError):
    """Nobody is signed in."""

    @classmethod
    def needed(cls) -> "SessionRejected":
        """Nothing was shown at the door."""
        return cls("SESSION_NEEDED", "nobody is signed in here", SIGN_IN)

    @classmethod
    def expired(cls) -> "SessionRejected":
        """What was shown at the door does not open it, or no longer."""
        return cls("SESSION_EXPIRED", "this session is over, was ended, or is none of this server", SIGN_IN)


class RoleRejected(NavigationError):
    """The role of who is signed in does not include this."""

    @classmethod
    def of(cls, person: Person, roles: frozenset[Role]) -> "RoleRejected":
        """Who may do it is told."""
        may = " or ".join(sorted(role.value for role in roles))
        return cls(
            "ROLE_REJECTED",
            f"this is for the {may}, and {person.name} is signed in as {person.role.value}",
            "Ask somebody who is signed in with that role to do it, or to invite you with it.",
            {"role": person.role.value, "allowed": sorted(role.value for role in roles)},
        )


class PageRejected(NavigationError):
    """A page that is none of ours uses what the browser brings along by itself."""

    @classmethod
    def told(cls) -> "PageRejected":
        """In the words in which another origin is refused."""
        return cls(
            "ORIGIN_REJECTED",
            "the browser does not say that a page of this server asks for this",
            "Open the dashboard of this server itself; a program sends its token as "
            "'Authorization: Bearer' in place of a cookie.",
        )


class AddressUnknown(NavigationError):
    """There is nothing at this address."""

    @classmethod
    def at(cls, path: str) -> "AddressUnknown":
        """Which one."""
        return cls(
            "NOT_FOUND",
            f"there is nothing at {path[:200]}",
            "Look at /api/docs for what can be asked.",
            {"path": path[:200]},
        )


class MethodUnknown(NavigationError):
    """There is something at this address, and this cannot be done with it."""

    @classmethod
    def at(cls, method: str, path: str) -> "MethodUnknown":
        """Which one."""
        return cls(
            "METHOD_NOT_ALLOWED",
            f"{method} is not possible at {path[:200]}",
            "Look at /api/docs for what can be asked.",
            {"path": path[:200]},
        )


class InvitationRejected(NavigationError):
    """An invitation that lets nobody in."""

    @classmethod
    def unknown(cls) -> "InvitationRejected":
        """It was never made, or is forgotten since it ended."""
        return cls("INVITATION_UNKNOWN", "this link is none of this server's invitations", ASK_AGAIN)

    @classmethod
    def used(cls) -> "InvitationRejected":
        """It was for one sign-in."""
        return cls("INVITATION_USED", "this link was for one sign-in, and has been used", ASK_AGAIN)

    @classmethod
    def expired(cls) -> "InvitationRejected":
        """Its time is over."""
        return cls("INVITATION_EXPIRED", "the time of this link is over", ASK_AGAIN)

    @classmethod
    def revoked(cls) -> "InvitationRejected":
        """Somebody took it back."""
        return cls("INVITATION_REVOKED", "this link was taken back", ASK_AGAIN)

    @classmethod
    def full(cls, count: int) -> "InvitationRejected":
        """So many are in by it; nobody who watches is sent away for somebody new."""
        return cls(
            "INVITATION_FULL",
            f"{count} are signed in by this link now, more are not let in by it",
            "Sign out where it is not needed, or ask the operator to end sessions or for a link of your own.",
            {"sessions": count, "allowed": count},
        )


class PeopleRejected(NavigationError):
    """There are too many people."""

    @classmethod
    def too_many(cls, count: int, allowed: int) -> "PeopleRejected":
        """All of them hold: what has ended makes room by itself."""
        return cls(
            "TOO_MANY_PEOPLE",
            f"{count} open invitations and sessions would be kept, allowed are {allowed}",
            "Take back invitations and end sessions that nobody needs.",
            {"kept": count, "allowed": allowed},
        )


class TooManyTries(NavigationError):
    """Somebody guesses, or something is set up wrongly."""

    @classmethod
    def wait(cls, seconds: float) -> "TooManyTries":
        """For so long."""
        whole = max(1, math.ceil(seconds))
        return cls(
            "TOO_MANY_TRIES",
            f"too many links or sessions were tried that do not exist; the next try counts in {whole} s",
            f"Wait {whole} s, then open the link once more.",
            {"wait_s": whole},
        )

    @classmethod
    def signing_in(cls, count: int, within_s: float, seconds: float) -> "TooManyTries":
        """A right link, used again and again; who is in by it stays in."""
        whole = max(1, math.ceil(seconds))
        minutes, left = round(within_s / 60), math.ceil(whole / 60)
        return cls(
            "TOO_MANY_SIGN_INS",
            f"this link has signed in {count} times within {minutes} min, and signs in again in {left} min",
            "Stay signed in where you are, or ask the operator for a link of your own.",
            {"wait_s": whole, "sign_ins": count, "within_s": within_s},
        )


class PersonUnknown(NavigationError):
    """There is no such session or invitation."""

    @classmethod
    def of(cls, kind: str, number: str) -> "PersonUnknown":
        """Which one."""
        return cls(
            f"{kind.upper()}_UNKNOWN",
            f"there is no {kind} {number[:40]}",
            "Look at the list of people once more.",
            {"id": number[:40]},
        )


class SignInOff(NavigationError):
    """Nobody has to sign in on this server."""

    @classmethod
    def told(cls) -> "SignInOff":
        """By its settings."""
        return cls(
            "SIGN_IN_OFF",
            "nobody has to sign in on this server, so nobody can",
            "Set security.sign_in to required in the settings, and start the server again.",
        )


STATUS_OF: dict[type[NavigationError], int] = {
    SessionRejected: 401,
    RoleRejected: 403,
    PageRejected: 403,
    AddressUnknown: 404,
    MethodUnknown: 405,
    InvitationRejected: 403,
    PeopleRejected: 409,
    TooManyTries: 429,
    PersonUnknown: 404,
    SignInOff: 409,
}


def status_of(rejection: NavigationError) -> int:
    """The HTTP status of a refusal at the door; 507 for one that the disk makes."""
    return next((STATUS_OF[kind] for kind in type(rejection).__mro__ if kind in STATUS_OF), 507)


def body_of(rejection: NavigationError) -> dict[str, object]:
    """A refusal in the one shape that refusals have."""
    return {
        "code": rejection.code,
        "message": rejection.message,
        "remedy": rejection.remedy,
        "context": rejection.context,
    }
