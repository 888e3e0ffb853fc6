"""The web application: every door that the server has, in one object."""

import asyncio
import contextlib
from collections.abc import AsyncIterator
from dataclasses import dataclass

from fastapi import FastAPI

from server.alarms import AlarmDesk
from server.api.alarms import alarms_router
from server.api.camera import camera_router
from server.api.cases import cases_router
from server.api.ct import ct_router
from server.api.dashboard import PRODUCT, dashboard_message, dashboard_router, product_version
from server.api.documentation import DocumentedApi, documentation_router
from server.api.errors import install_errors, refusals
from server.api.health import health_router
from server.api.jobs import jobs_router
from server.api.live import live_router
from server.api.metrics import Metrics, metrics_router
from server.api.needles import needles_router
from server.api.page import mount_page, page_folder
from server.api.plan import plan_router
from server.api.procedure import procedure_router
from server.api.refused_uploads import RefusedUploads
from server.api.registration import registration_router
from server.api.rehearsal import rehearsal_router
from server.api.streams import SOCKETS_IN_WORDS, streams_router
from server.api.surface import surface_router
from server.api.sweep import sweep_router
from server.api.tools import tools_router
from server.config import Config
from server.jobs import Jobs
from server.live import LiveHub
from server.loop.rehearsed import Rehearsed
from server.overlay.words import RESEARCH_SOFTWARE
from server.procedure import Steps
from server.procedure.shown_bone import ShownBone
from server.scene import mount_scene
from server.security import HostGuard, KnownHosts, SecurityHeaders
from server.store import CaseStore
from server.stream.mjpeg import Video
from server.stream.viewers import Viewers
from tracker.navigation import Setup
from tracker.plan import Surface

OPENAPI_PATH = "/api/openapi.json"


@dataclass(frozen=True, slots=True, kw_only=True)
class AppParts:
    """What the application is made of.

    Attributes:
        hub: where the newest instant is published.
        config: the settings; its limits are the ones that every door uses.
        store: where cases are kept; None where nothing is kept, and then nothing is answered about them.
        jobs: where long work is done; None where there is none.
        steps: of the set-up; None where nothing is kept.
        setup: what stands before the first image, for the scene; None when it is known only later.
        surface: the bone, for the scene.
        alarms: of this theatre; None makes some that nobody feeds.
        rehearsed: what is rehearsed; None for every other source.
    """

    hub: LiveHub
    config: Config
    store: CaseStore | None = None
    jobs: Jobs | None = None
    steps: Steps | None = None
    setup: Setup | None = None
    surface: Surface | None = None
    alarms: AlarmDesk | None = None
    rehearsed: Rehearsed | None = None


def create_app(parts: AppParts) -> FastAPI:
    """The application, ready to be served."""
    hub, config, limits = parts.hub, parts.config, parts.config.limits
    viewers = Viewers()
    metrics = Metrics(hub=hub, viewers=viewers)
    video = Video(hub=hub, viewers=viewers, stale_after_ms=limits.video_stale_after_ms)

    @contextlib.asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        counting = asyncio.create_task(metrics.follow(), name="metrics")
        await app.state.scene.start()
        try:
            yield
        finally:
            if parts.steps is not None:
                await asyncio.to_thread(parts.steps.close)
            await app.state.scene.stop()
            counting.cancel()
            await asyncio.wait([counting])

    app = DocumentedApi(
        title=PRODUCT,
        version=product_version(),
        description=f"{RESEARCH_SOFTWARE.capitalize()}.\n{SOCKETS_IN_WORDS}",
        openapi_url=OPENAPI_PATH,
        docs_url=None,
        redoc_url=None,
        lifespan=lifespan,
        responses=refusals(421, 500),
    )
    install_errors(app)
    app.add_middleware(HostGuard, hosts=KnownHosts.of(config.server.host))
    app.add_middleware(SecurityHeaders)
    app.add_middleware(RefusedUploads)
    app.include_router(streams_router(camera_name=config.camera.name, video=video, hub=hub, viewers=viewers))
    app.include_router(live_router(hub))
    app.include_router(alarms_router(parts.alarms or AlarmDesk(config)))
    app.include_router(dashboard_router(dashboard_message(config, scene_available=True)))
    app.include_router(health_router(hub, stale_after_ms=limits.video_stale_after_ms))
    app.include_router(metrics_router(metrics))
    app.include_router(rehearsal_router(parts.rehearsed, hub, config.camera))
    _add_procedure(app, parts)
    app.include_router(documentation_router(app.openapi, openapi_path=OPENAPI_PATH))
    mount_scene(
        app,
        hub=hub,
        setup=parts.setup,
        surface=parts.surface,
        stale_after_ms=limits.scene_stale_after_ms,
    )
    if parts.store is not None:
        ShownBone(parts.store, app.state.scene.show_surface, own=parts.surface)
    mount_page(app, camera=config.camera.name, folder=page_folder())
    return app


def _add_procedure(app: FastAPI, parts: AppParts) -> None:
    """The doors to cases, jobs and the steps, where there is a store."""
    if parts.store is not None:
        app.include_router(cases_router(parts.store))
    if parts.jobs is not None:
        app.include_router(jobs_router(parts.jobs))
    if parts.steps is not None and parts.store is not None:
        app.include_router(camera_router(parts.steps.camera, parts.store.home))
        app.include_router(tools_router(parts.steps.tool))
        app.include_router(ct_router(parts.steps.ct, parts.steps.opened_ct, parts.store.home))
        app.include_router(
            plan_router(
                parts.steps.plan,
                parts.steps.opened_ct,
                parts.store.home,
                least_landmarks=parts.config.registration.least_points,
            )
        )
        app.include_router(procedure_router(parts.steps.procedure))
        app.include_router(registration_router(parts.steps.registration))
        app.include_router(sweep_router(parts.steps.registration.sweep))
        app.include_router(needles_router(parts.steps.registration, parts.steps.opened_ct))
        app.include_router(surface_router(parts.steps.surface, parts.store, parts.store.home))
