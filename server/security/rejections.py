"""Errors of access control.

NavigationError
├── SessionRejected      no valid session                              HTTP 401
├── RoleRejected         the role does not allow this                  HTTP 403
├── PageRejected         a cross-site request                          HTTP 403
├── AddressUnknown      no such address                               HTTP 404
├── MethodUnknown       not possible at this address                  HTTP 405
├── InvitationRejected   an invitation that cannot be used             HTTP 403
├── PeopleRejected       too many records of people                    HTTP 409
├── TooManyTries        rate limit of sign-ins                        HTTP 429
├── PersonUnknown       no such session or invitation                 HTTP 404
└── SignInOff           sign-in is off                                HTTP 409
"""

import math

from server.security.person import Person, Role
from server.texts import reason_of_error, requested_language
from tracker.errors import NavigationError

SIGN_IN = "Sign in with the link that the server printed at its start, or ask the operator for an invitation."
ASK_FOR_INVITATION = (
    "Ask the operator for a new invitation; an operator starts the server with --new-operator-link."
)


class SessionRejected(NavigationError):
    """No valid session."""

    @classmethod
    def needed(cls) -> "SessionRejected":
        """No token was sent."""
        return cls("SESSION_NEEDED", "sign-in is required", SIGN_IN)

    @classmethod
    def expired(cls) -> "SessionRejected":
        """The token is unknown, or its session has ended."""
        return cls(
            "SESSION_EXPIRED", "this session has expired, was ended, or belongs to another server", SIGN_IN
        )


class RoleRejected(NavigationError):
    """The person's role does not allow this."""

    @classmethod
    def of(cls, person: Person, roles: frozenset[Role]) -> "RoleRejected":
        """Names the allowed roles."""
        may = " or ".join(sorted(role.value for role in roles))
        return cls(
            "ROLE_REJECTED",
            f"this requires the role {may}, but {person.name} is signed in as {person.role.value}",
            "Ask a person with this role to do it, or to invite you with this role.",
            {
                "role": person.role.value,
                "allowed": sorted(role.value for role in roles),
                "may": may,
                "person": person.name,
            },
        )


class PageRejected(NavigationError):
    """A cross-site request with this server's cookie."""

    @classmethod
    def error(cls) -> "PageRejected":
        """Same code as for a wrong origin."""
        return cls(
            "ORIGIN_REJECTED",
            "the browser does not state that this request comes from a page of this server",
            "Open the dashboard of this server; a program must send its token as "
            "'Authorization: Bearer' instead of a cookie.",
        )


class AddressUnknown(NavigationError):
    """No such address."""

    @classmethod
    def at(cls, path: str) -> "AddressUnknown":
        """Names the path."""
        return cls(
            "NOT_FOUND",
            f"{path[:200]} does not exist",
            "See /api/docs for all addresses.",
            {"path": path[:200]},
        )


class MethodUnknown(NavigationError):
    """The address exists, but not with this method."""

    @classmethod
    def at(cls, method: str, path: str) -> "MethodUnknown":
        """Names the path."""
        return cls(
            "METHOD_NOT_ALLOWED",
            f"{path[:200]} does not support {method}",
            "See /api/docs for all addresses.",
            {"path": path[:200], "method": method},
        )


class InvitationRejected(NavigationError):
    """An invitation that cannot be used."""

    @classmethod
    def unknown(cls) -> "InvitationRejected":
        """It never existed, or its record was deleted after it ended."""
        return cls("INVITATION_UNKNOWN", "this link is not an invitation of this server", ASK_FOR_INVITATION)

    @classmethod
    def used(cls) -> "InvitationRejected":
        """It was single-use."""
        return cls(
            "INVITATION_USED", "this link was for a single sign-in and has been used", ASK_FOR_INVITATION
        )

    @classmethod
    def expired(cls) -> "InvitationRejected":
        """It has expired."""
        return cls("INVITATION_EXPIRED", "this link has expired", ASK_FOR_INVITATION)

    @classmethod
    def revoked(cls) -> "InvitationRejected":
        """It was revoked."""
        return cls("INVITATION_REVOKED", "this link was revoked", ASK_FOR_INVITATION)

    @classmethod
    def full(cls, count: int) -> "InvitationRejected":
        """It has its maximum number of sessions; an existing session is not ended for a new one."""
        return cls(
            "INVITATION_FULL",
            f"{count} sessions are signed in by this link, the maximum",
            "Sign out on unused devices, or ask the operator to end sessions or for another link.",
            {"sessions": count, "allowed": count},
        )


class PeopleRejected(NavigationError):
    """Too many records of people."""

    @classmethod
    def too_many(cls, count: int, allowed: int) -> "PeopleRejected":
        """All records are valid; ended ones are deleted automatically."""
        return cls(
            "TOO_MANY_PEOPLE",
            f"{count} open invitations and sessions would be stored, allowed are {allowed}",
            "Revoke invitations and end sessions that are not needed.",
            {"stored": count, "allowed": allowed},
        )


class TooManyTries(NavigationError):
    """Rate limit of sign-ins."""

    @classmethod
    def wait(cls, seconds: float) -> "TooManyTries":
        """Too many unknown tokens."""
        wait_s = max(1, math.ceil(seconds))
        return cls(
            "TOO_MANY_TRIES",
            f"too many unknown links or sessions were tried; the next attempt is possible in {wait_s} s",
            f"Wait {wait_s} s, then open the link again.",
            {"wait_s": wait_s},
        )

    @classmethod
    def signing_in(cls, count: int, within_s: float, seconds: float) -> "TooManyTries":
        """One valid link was used too often; existing sessions stay."""
        wait_s = max(1, math.ceil(seconds))
        minutes, left = round(within_s / 60), math.ceil(wait_s / 60)
        return cls(
            "TOO_MANY_SIGN_INS",
            f"this link was used for {count} sign-ins within {minutes} min; the next is possible in "
            f"{left} min",
            "Stay signed in, or ask the operator for another link.",
            {"wait_s": wait_s, "sign_ins": count, "within_s": within_s, "minutes": minutes, "left_min": left},
        )


class PersonUnknown(NavigationError):
    """No such session or invitation."""

    @classmethod
    def of(cls, kind: str, number: str) -> "PersonUnknown":
        """Names the kind and id."""
        return cls(
            f"{kind.upper()}_UNKNOWN",
            f"there is no {kind} {number[:40]}",
            "Reload the list of people.",
            {"id": number[:40]},
        )


class SignInOff(NavigationError):
    """Sign-in is off on this server."""

    @classmethod
    def error(cls) -> "SignInOff":
        """By its settings."""
        return cls(
            "SIGN_IN_OFF",
            "sign-in is off on this server",
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
    """Return the HTTP status of an access error; 507 for a disk error."""
    return next((STATUS_OF[kind] for kind in type(rejection).__mro__ if kind in STATUS_OF), 507)


def body_of(rejection: NavigationError) -> dict[str, object]:
    """Return an error in the common shape of all errors, in the language of the request."""
    language = requested_language()
    why = reason_of_error(rejection)
    return {
        "code": rejection.code,
        "message": why.message[language],
        "remedy": why.remedy[language],
        "context": rejection.context,
        "language": why.language(language),
    }
