"""Who asks, and for what: one request or socket as the table sees it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from starlette.datastructures import Headers
from starlette.types import Scope

from server.security.cookies import is_under_tls, token_in_cookie, token_in_header
from server.security.hosts import SAFE_METHODS
from server.security.people import PeopleDesk, Session
from server.security.person import ANYBODY, NOBODY, Person
from server.security.rejections import (
    AddressUnknown,
    MethodUnknown,
    PageRejected,
    RoleRejected,
    SessionRejected,
)
from server.security.table import SOCKET, Rule, rules_of
from tracker.errors import NavigationError


@dataclass(frozen=True, slots=True, kw_only=True)
class Asked:
    """What is asked.

    Attributes:
        method: of HTTP, `GET` for `HEAD`; `SOCKET` for a WebSocket.
        path: as it was sent, without its percents.
        rules: of the table that it may be, the one that is meant first, with the parts that name things.
        is_page: it is a file of the page itself.
        is_known: the path is in the table, with whatever method.
        address: of the machine that asks.
        is_secure: TLS carries it.
    """

    method: str
    path: str
    rules: tuple[tuple[Rule, Mapping[str, str]], ...]
    is_page: bool
    is_known: bool
    address: str
    is_secure: bool

    @classmethod
    def of(cls, scope: Scope, *, is_page: Callable[[str], bool], behind_proxy: bool) -> "Asked":
        """Read a scope. Of a proxy it is believed that it speaks TLS, where the settings say so, no more."""
        method = SOCKET if scope["type"] == "websocket" else str(scope["method"])
        method, path = "GET" if method == "HEAD" else method, str(scope["path"])
        fitting, is_known = rules_of(method, path)
        told = Headers(scope=scope).get("x-forwarded-proto", "").strip().lower()
        return cls(
            method=method,
            path=path,
            rules=tuple(fitting),
            is_page=method == "GET" and is_page(path),
            is_known=is_known,
            address=str((scope.get("client") or ("",))[0]),
            is_secure=is_under_tls(scope) or (behind_proxy and told == "https"),
        )

    @property
    def rule(self) -> Rule | None:
        """The one that is meant."""
        return self.rules[0][0] if self.rules else None

    @property
    def names(self) -> Mapping[str, str]:
        """The parts of the path that name things."""
        return self.rules[0][1] if self.rules else {}

    @property
    def is_public(self) -> bool:
        """Whether who is not signed in may have it."""
        return self.is_page or (bool(self.rules) and all(rule.is_public for rule, _ in self.rules))

    def session(self, scope: Scope, people: PeopleDesk) -> Session | None:
        """Whose session is shown; None where none is, and where nobody has to sign in.

        Raises:
            SessionRejected, TooManyTries: what is shown opens no door.
            PageRejected: the browser brings it along for a page that is none of ours.
        """
        if not people.required:
            return None
        shown = token_in_header(scope)
        if shown is None:
            shown = token_in_cookie(scope, secure=self.is_secure)
            if shown is None:
                return None
            if not self.is_page:
                _reject_strange_page(self.method, scope)
        try:
            return people.who(shown, address=self.address)
        except NavigationError:
            if self.is_public:
                # The way in stays open to who comes with an old cookie.
                return None
            raise

    def person(self, session: Session | None, *, required: bool) -> Person:
        """Who asks, if the table lets them.

        Raises:
            SessionRejected: nobody is signed in, and somebody must be.
            RoleRejected: somebody is, and may not.
            AddressUnknown, MethodUnknown: it is in no table.
        """
        person = ANYBODY if not required else NOBODY if session is None else session.person
        if self.is_page or (person is NOBODY and self.is_public):
            return person
        if person is NOBODY:
            # What there is and what there is not is told to those who are signed in.
            raise SessionRejected.needed()
        if not self.rules:
            known = self.is_known
            raise MethodUnknown.at(self.method, self.path) if known else AddressUnknown.at(self.path)
        for rule, _ in self.rules:
            if person.role not in rule.roles:
                raise RoleRejected.of(person, rule.roles)
        return person


def _reject_strange_page(method: str, scope: Scope) -> None:
    """A cookie is sent by the browser, whoever asks it to. So who asks must be told by the browser, too.

    `SameSite` counts every port of a host as one site. Whether an origin that is told is ours, the guard of
    hosts has seen to.
    """
    headers = Headers(scope=scope)
    if headers.get("sec-fetch-site", "same-origin") not in {"same-origin", "none"}:
        raise PageRejected.told()
    if method not in SAFE_METHODS and "origin" not in headers:
        raise PageRejected.told()
