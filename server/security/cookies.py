"""Transport of a session's token: an HttpOnly cookie, or `Authorization: Bearer` for programs."""

from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.requests import cookie_parser
from starlette.types import Scope

DEFAULT_PORTS = {"http": 80, "ws": 80, "https": 443, "wss": 443}
BEARER = "bearer "


def is_under_tls(scope: Scope) -> bool:
    """Return whether this server itself speaks TLS on the connection."""
    return scope.get("scheme") in {"https", "wss"}


def cookie_name(scope: Scope, *, secure: bool) -> str:
    """Return the cookie's name at this address.

    Browsers send a cookie to every port of its host, so two servers on one machine would overwrite each
    other's: the port is in the name. `__Host-` makes the browser restrict the cookie to TLS and to this host.
    """
    host = Headers(scope=scope).get("host", "")
    try:
        port = urlsplit(f"//{host}").port
    except ValueError:
        port = None
    if port is None:
        port = 443 if secure else DEFAULT_PORTS.get(scope.get("scheme", "http"), 80)
    return f"{'__Host-' if secure else ''}coaxial-{port}"


def token_in_cookie(scope: Scope, *, secure: bool) -> str | None:
    """Return the token of the cookie; None without one."""
    name = cookie_name(scope, secure=secure)
    for header in Headers(scope=scope).getlist("cookie"):
        found = cookie_parser(header).get(name)
        if found is not None:
            return found
    return None


def token_in_header(scope: Scope) -> str | None:
    """Return the token of `Authorization: Bearer`; None without one."""
    header = Headers(scope=scope).get("authorization", "")
    return header[len(BEARER) :].strip() if header.lower().startswith(BEARER) else None


def cookie_header(scope: Scope, token: str, *, secure: bool, lasts_s: int) -> str:
    """Return the `Set-Cookie` value for a token; an empty token deletes the cookie."""
    parts = [
        f"{cookie_name(scope, secure=secure)}={token}",
        "Path=/",
        f"Max-Age={max(0, lasts_s)}",
        "HttpOnly",
        "SameSite=Strict",
    ]
    return "; ".join([*parts, "Secure"] if secure else parts)
