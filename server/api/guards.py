"""The middleware that every server has: errors, limits of bodies, session, host, headers, language."""

from fastapi import FastAPI

from server.api.body_drain import BodyDrainMiddleware
from server.api.body_limits import BodyLimitMiddleware
from server.api.errors import install_errors
from server.api.guide import is_guide
from server.api.language import LanguageMiddleware
from server.api.page import page_addresses, page_folder
from server.config import ServerConfig
from server.security import HostGuard, KnownHosts, PeopleService, SecurityHeaders, SessionGuard


def add_guards(app: FastAPI, *, server: ServerConfig, people: PeopleService | None) -> None:
    """Add the middleware; the last one added runs first. Without `people` there is no access control."""
    is_page = page_addresses(page_folder())
    install_errors(app)
    app.add_middleware(BodyLimitMiddleware)
    if people is not None:
        app.add_middleware(
            SessionGuard,
            people=people,
            is_page=lambda path: is_page(path) or is_guide(path),
            behind_proxy=server.behind_proxy is not None,
        )
    app.add_middleware(HostGuard, hosts=KnownHosts.of(server.host))
    app.add_middleware(SecurityHeaders)
    app.add_middleware(BodyDrainMiddleware)
    app.add_middleware(LanguageMiddleware)
