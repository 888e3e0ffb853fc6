"""Attributes of a request or WebSocket handshake for the access rules: person and action."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from starlette.datastructures import Headers
from starlette.types import Scope

from server.security.access_rules import SOCKET, Rule, rules_of
from server.security.cookies import is_under_tls, token_in_cookie, token_in_header
from server.security.hosts import SAFE_METHODS
from server.security.people import PeopleService, Session
from server.security.person import ANONYMOUS, LOCAL_USER, Person
from server.security.rejections import (
    AddressUnknown,
    MethodUnknown,
    PageRejected,
    RoleRejected,
    SessionRejected,
)
from tracker.errors import NavigationError


@dataclass(frozen=True, slots=True, kw_only=True)
class AccessRequest:
    """A request and the rules that apply to it.

    Attributes:
        method: HTTP method, `GET` for `HEAD`; `SOCKET` for a WebSocket.
        path: decoded path.
        rules: matching rules with their path parameters, the most specific one first.
        is_page: whether it is a file of the web page itself.
        is_known: whether a rule has this path, with any method.
        address: address of the client.
        is_secure: whether the connection uses TLS.
    """

    method: str
    path: str
    rules: tuple[tuple[Rule, Mapping[str, str]], ...]
    is_page: bool
    is_known: bool
    address: str
    is_secure: bool

    @classmethod
    def of(cls, scope: Scope, *, is_page: Callable[[str], bool], behind_proxy: bool) -> "AccessRequest":
        """Read an ASGI scope. A proxy's `X-Forwarded-Proto` is trusted only with `behind_proxy`."""
        method = SOCKET if scope["type"] == "websocket" else str(scope["method"])
        method, path = "GET" if method == "HEAD" else method, str(scope["path"])
        fitting, is_known = rules_of(method, path)
        forwarded_proto = Headers(scope=scope).get("x-forwarded-proto", "").strip().lower()
        return cls(
            method=method,
            path=path,
            rules=tuple(fitting),
            is_page=method == "GET" and is_page(path),
            is_known=is_known,
            address=str((scope.get("client") or ("",))[0]),
            is_secure=is_under_tls(scope) or (behind_proxy and forwarded_proto == "https"),
        )

    @property
    def rule(self) -> Rule | None:
        """The rule that applies."""
        return self.rules[0][0] if self.rules else None

    @property
    def names(self) -> Mapping[str, str]:
        """Its path parameters."""
        return self.rules[0][1] if self.rules else {}

    @property
    def is_public(self) -> bool:
        """Whether it is open without sign-in."""
        return self.is_page or (bool(self.rules) and all(rule.is_public for rule, _ in self.rules))

    def session(self, scope: Scope, people: PeopleService) -> Session | None:
        """Return the session of the token that was sent; None without a token, and where sign-in is off.

        Raises:
            SessionRejected, TooManyTries: the token is not accepted.
            PageRejected: a cross-site request.
        """
        if not people.required:
            return None
        shown = token_in_header(scope)
        if shown is None:
            shown = token_in_cookie(scope, secure=self.is_secure)
            if shown is None:
                return None
            if not self.is_page:
                _reject_cross_site(self.method, scope)
        try:
            return people.session_of(shown, address=self.address)
        except NavigationError:
            if self.is_public:
                # Sign-in stays open to a browser with an old cookie.
                return None
            raise

    def person(self, session: Session | None, *, required: bool) -> Person:
        """Return the person, if the rules allow the request.

        Raises:
            SessionRejected: sign-in is required.
            RoleRejected: the role does not allow it.
            AddressUnknown, MethodUnknown: no rule matches.
        """
        person = LOCAL_USER if not required else ANONYMOUS if session is None else session.person
        if self.is_page or (person is ANONYMOUS and self.is_public):
            return person
        if person is ANONYMOUS:
            # Only signed-in people learn which addresses exist.
            raise SessionRejected.needed()
        if not self.rules:
            known = self.is_known
            raise MethodUnknown.at(self.method, self.path) if known else AddressUnknown.at(self.path)
        for rule, _ in self.rules:
            if person.role not in rule.roles:
                raise RoleRejected.of(person, rule.roles)
        return person


def _reject_cross_site(method: str, scope: Scope) -> None:
    """Reject a cross-site request: the browser sends the cookie whichever page caused it.

    `SameSite` counts every port of a host as one site. `HostGuard` has checked an `Origin` header before.
    """
    headers = Headers(scope=scope)
    if headers.get("sec-fetch-site", "same-origin") not in {"same-origin", "none"}:
        raise PageRejected.error()
    if method not in SAFE_METHODS and "origin" not in headers:
        raise PageRejected.error()
