"""The supervisor's session at a theatre, in the browser at the hub: a cookie that no script reads.

The hub stores none. The name of the cookie has the session at the hub in it, so that the next person who
signs in at the hub with the same browser does not act by the session of the one before.
"""

from starlette.requests import HTTPConnection, cookie_parser

from server.security.cookies import cookie_name
from server.security.guard import SECURE_KEY, SESSION_KEY
from server.security.people import Session

# The theatre decides when the session ends; a browser keeps it no longer than a session may last.
LASTS_S = 168 * 3600


def token_at(theatre: str, asking: HTTPConnection) -> str:
    """Return the token of this person's session at a theatre; empty without one."""
    return cookie_parser(asking.headers.get("cookie", "")).get(_name(theatre, asking), "")


def theatre_cookie(theatre: str, token: str, asking: HTTPConnection) -> str:
    """Return the `Set-Cookie` value for a token; an empty one deletes the cookie."""
    parts = [
        f"{_name(theatre, asking)}={token}",
        "Path=/",
        f"Max-Age={LASTS_S if token else 0}",
        "HttpOnly",
        "SameSite=Strict",
        *(["Secure"] if _is_secure(asking) else []),
    ]
    return "; ".join(parts)


def _name(theatre: str, asking: HTTPConnection) -> str:
    session = asking.scope.get("state", {}).get(SESSION_KEY)
    of = session.id if isinstance(session, Session) else "local"
    return f"{cookie_name(asking.scope, secure=_is_secure(asking))}-{of}-{theatre}"


def _is_secure(asking: HTTPConnection) -> bool:
    return bool(asking.scope.get("state", {}).get(SECURE_KEY, False))
