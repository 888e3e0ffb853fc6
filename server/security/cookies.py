"""Where a session's token travels: in a cookie that no script reads, or in `Authorization` for machines."""

from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.requests import cookie_parser
from starlette.types import Scope

DEFAULT_PORT = {"http": 80, "ws": 80, "https": 443, "wss": 443}
BEARER = "bearer "


def is_under_tls(scope: Scope) -> bool:
    """Whether this server itself speaks TLS here."""
    return scope.get("scheme") in {"https", "wss"}


def cookie_name(scope: Scope, *, secure: bool) -> str:
    """The name of the cookie at this address.

    Browsers send a cookie to every port of its host, so that two servers on one machine would overwrite each
    other's: the port is in the name. `__Host-` makes the browser itself hold it to TLS and to this host.
    """
    host = Headers(scope=scope).get("host", "")
    try:
        port = urlsplit(f"//{host}").port
    except ValueError:
        port = None
    if port is None:
        port = 443 if secure else DEFAULT_PORT.get(scope.get("scheme", "http"), 80)
    return f"{'__Host-' if secure else ''}coaxial-{port}"


def token_in_cookie(scope: Scope, *, secure: bool) -> str | None:
    """What the browser brings along by itself."""
    name = cookie_name(scope, secure=secure)
    for header in Headers(scope=scope).getlist("cookie"):
        found = cookie_parser(header).get(name)
        if found is not None:
            return found
    return None


def token_in_header(scope: Scope) -> str | None:
    """What a program says of its own will."""
    said = Headers(scope=scope).get("authorization", "")
    return said[len(BEARER) :].strip() if said.lower().startswith(BEARER) else None


def cookie_header(scope: Scope, token: str, *, secure: bool, lasts_s: int) -> str:
    """The `Set-Cookie` that gives the browser this token; an empty one takes it away."""
    parts = [
        f"{cookie_name(scope, secure=secure)}={token}",
        "Path=/",
        f"Max-Age={max(0, lasts_s)}",
        "HttpOnly",
        "SameSite=Strict",
    ]
    return "; ".join([*parts, "Secure"] if secure else parts)
