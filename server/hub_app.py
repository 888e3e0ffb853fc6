"""The ASGI application of the hub: sign-in, list of theatres, and page. It has no case and no camera."""

import asyncio
import contextlib
from collections.abc import AsyncIterator

from fastapi import Depends, FastAPI

from server.api.audit import audit_router
from server.api.dashboard import PRODUCT, DashboardMessage, dashboard_message
from server.api.documentation import DocumentedApi
from server.api.errors import rejections
from server.api.guards import add_guards
from server.api.guide import mount_guide
from server.api.hub import HubContext, hub_router
from server.api.page import mount_page, page_folder
from server.api.people import people_router
from server.api.requester import set_requester
from server.api.session import session_router
from server.config import Config
from server.hub.connection import HubAddress
from server.hub.theatres import STALE_AFTER_MS
from server.installation import product_version
from server.security import PeopleService


def create_hub_app(config: Config, address: HubAddress, people: PeopleService | None) -> FastAPI:
    """Create the application; it receives from the NATS server while it runs."""
    hub = HubContext.of(config, address, _dashboard(config))

    @contextlib.asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        receiving = asyncio.create_task(hub.watcher.run(), name="hub")
        try:
            yield
        finally:
            receiving.cancel()
            await asyncio.wait([receiving])

    app = DocumentedApi(
        title=PRODUCT,
        version=product_version(),
        openapi_url=None,
        docs_url=None,
        redoc_url=None,
        lifespan=lifespan,
        dependencies=[Depends(set_requester)],
        responses=rejections(401, 403, 413, 421, 429, 500),
    )
    add_guards(app, server=config.server, people=people)
    app.state.hub = hub
    app.include_router(session_router(people, is_hub=True))
    app.include_router(people_router(people, listens_everywhere=config.server.host in {"0.0.0.0", "::"}))  # noqa: S104  compared with
    app.include_router(audit_router(None if people is None else people.audit))
    app.include_router(hub_router(hub))
    mount_guide(app)
    mount_page(app, camera=config.camera.name, folder=page_folder())
    return app


def _dashboard(config: Config) -> DashboardMessage:
    """Return the start-up data of an opened theatre.

    A picture comes twice a second and has no figures: it is shown for as long as a theatre's state.
    """
    limits = config.limits.model_copy(update={"video_stale_after_ms": STALE_AFTER_MS})
    return dashboard_message(config.model_copy(update={"limits": limits}), scene_available=False)
