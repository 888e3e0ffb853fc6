"""The web application: every door that the server has, in one object."""

import asyncio
import contextlib
from collections.abc import AsyncIterator
from dataclasses import dataclass

from fastapi import Depends, FastAPI

from server.alarms import AlarmDesk
from server.api.alarms import alarms_router
from server.api.audit import audit_router
from server.api.bodies import LimitedBodies
from server.api.camera import camera_router
from server.api.cases import cases_router
from server.api.ct import ct_router
from server.api.dashboard import PRODUCT, dashboard_message, dashboard_router, product_version
from server.api.documentation import DocumentedApi, documentation_router
from server.api.doing import know_who_asks
from server.api.errors import install_errors, rejections
from server.api.gates import gates_router
from server.api.guide import guide_folder, is_guide, mount_guide
from server.api.health import health_router
from server.api.jobs import jobs_router
from server.api.latency import latency_router
from server.api.live import live_router
from server.api.markers import markers_router
from server.api.metrics import Metrics, metrics_router
from server.api.needles import needles_router
from server.api.page import mount_page, page_addresses, page_folder
from server.api.people import people_router
from server.api.plan import plan_router
from server.api.procedure import procedure_router
from server.api.readout import readout_router
from server.api.registration import registration_router
from server.api.rehearsal import rehearsal_router
from server.api.rejected_uploads import RejectedUploads
from server.api.session import session_router
from server.api.streams import SOCKETS_IN_WORDS, streams_router
from server.api.supervision import ROOM_IN_WORDS, room_router, signatures_router
from server.api.surface import surface_router
from server.api.sweep import sweep_router
from server.api.tools import tools_router
from server.capture.address import source_from_text
from server.config import Config
from server.jobs import Jobs
from server.live import LiveHub
from server.loop.publisher import Picture
from server.loop.rehearsed import Rehearsed
from server.overlay.words import RESEARCH_SOFTWARE
from server.procedure import Steps
from server.procedure.shown_bone import ShownBone
from server.scene import mount_scene
from server.security import HostGuard, KnownHosts, PeopleDesk, SecurityHeaders, SessionGuard
from server.store import CaseStore
from server.stream.connection import cut_line
from server.stream.fitting.pictures import Pictures
from server.stream.fitting.texts import Texts
from server.stream.mjpeg import Video
from server.stream.phone.receiver import Receiver
from server.stream.phone.socket import PhoneDoor
from server.stream.view_socket import View
from server.stream.viewers import ViewerKind, Viewers
from server.supervision import Holds, HoldsFile, Lobby, SignatureDesk
from tracker.navigation import Setup
from tracker.plan import Surface

OPENAPI_PATH = "/api/openapi.json"
EVERY_ADDRESS = frozenset({"0.0.0.0", "::"})  # noqa: S104  compared with, not listened on


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
        phone: receives the images of a phone; None for every other source.
        people: who is signed in; None where there is no guard at all, as in tests of other rooms.
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
    phone: Receiver | None = None
    people: PeopleDesk | None = None


def create_app(parts: AppParts) -> FastAPI:
    """The application, ready to be served."""
    hub, config, limits = parts.hub, parts.config, parts.config.limits
    viewers = Viewers(most=config.video.max_viewers)
    pictures = Pictures(quality=config.video.jpeg_quality, language=config.video.language)
    metrics = Metrics(hub=hub, viewers=viewers, pictures=pictures)
    video = Video(hub=hub, viewers=viewers, pictures=pictures, stale_after_ms=limits.video_stale_after_ms)
    view = View(hub=hub, viewers=viewers, pictures=pictures, texts=Texts())

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
            pictures.close()

    app = DocumentedApi(
        title=PRODUCT,
        version=product_version(),
        description=f"{RESEARCH_SOFTWARE.capitalize()}.\n{SOCKETS_IN_WORDS}{ROOM_IN_WORDS}",
        openapi_url=OPENAPI_PATH,
        docs_url=None,
        redoc_url=None,
        lifespan=lifespan,
        dependencies=[Depends(know_who_asks)],
        responses=rejections(401, 403, 413, 421, 429, 500),
    )
    _add_guards(app, parts)
    app.state.pictures = pictures
    _add_streams(app, parts, viewers, video, view)
    app.include_router(live_router(hub))
    _add_people(app, parts)
    _add_supervision(app, parts, viewers)
    app.include_router(dashboard_router(dashboard_message(config, scene_available=True)))
    app.include_router(gates_router(config))
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
        admit=lambda person: viewers.watching(ViewerKind.SCENE, person=person),
        cut=cut_line,
    )
    if parts.store is not None:
        ShownBone(parts.store, app.state.scene.show_surface, own=parts.surface)
    _mount_files(app, config)
    return app


def picture_of(app: FastAPI) -> Picture:
    """How each image is drawn and encoded: once for all who watch through this application."""
    pictures: Pictures = app.state.pictures
    return Picture(
        draw=pictures.draw,
        encode=pictures.encode,
        is_watched=pictures.is_watched,
        is_watched_in_full=pictures.is_watched_in_full,
    )


def _add_streams(app: FastAPI, parts: AppParts, viewers: Viewers, video: Video, view: View) -> None:
    """The doors to what is live, and the one for a phone's images."""
    camera = parts.config.camera
    source = source_from_text(camera.source).name
    phone = PhoneDoor(hub=parts.hub, viewers=viewers, receiver=parts.phone, source=source)
    app.include_router(streams_router(camera_name=camera.name, video=video, view=view, phone=phone))


def _mount_files(app: FastAPI, config: Config) -> None:
    """The guide, and then the page, because that answers to every path."""
    mount_guide(app, folder=guide_folder())
    mount_page(app, camera=config.camera.name, folder=page_folder())


def _add_guards(app: FastAPI, parts: AppParts) -> None:
    """What everything that is asked passes before it reaches a door; the last one here is passed first."""
    server = parts.config.server
    is_page = page_addresses(page_folder())
    install_errors(app)
    app.add_middleware(LimitedBodies)
    if parts.people is not None:
        app.add_middleware(
            SessionGuard,
            people=parts.people,
            is_page=lambda path: is_page(path) or is_guide(path),
            behind_proxy=server.behind_proxy is not None,
        )
    app.add_middleware(HostGuard, hosts=KnownHosts.of(server.host))
    app.add_middleware(SecurityHeaders)
    app.add_middleware(RejectedUploads)


def _add_people(app: FastAPI, parts: AppParts) -> None:
    """The doors to who is signed in and what they did."""
    everywhere = parts.config.server.host in EVERY_ADDRESS
    app.include_router(session_router(parts.people))
    app.include_router(people_router(parts.people, listens_everywhere=everywhere))
    app.include_router(audit_router(None if parts.people is None else parts.people.audit))


def _add_supervision(app: FastAPI, parts: AppParts, viewers: Viewers) -> None:
    """The doors to alarms, to the room of those who watch, and to what is co-signed in a case."""
    desk = parts.alarms or AlarmDesk(parts.config)
    kept = None if parts.store is None else HoldsFile(parts.store.home.folder)
    holds, signatures = Holds(desk, kept=kept), None
    if parts.steps is not None and parts.store is not None:
        signatures = SignatureDesk(parts.store, parts.steps.procedure)
        app.include_router(signatures_router(signatures))
    lobby = Lobby(
        hub=parts.hub,
        holds=holds,
        signatures=signatures,
        fades_after_s=parts.config.supervision.drawings_fade_after_s,
    )
    app.include_router(alarms_router(desk, holds))
    app.include_router(room_router(lobby, viewers))


def _add_procedure(app: FastAPI, parts: AppParts) -> None:
    """The doors to cases, jobs and the steps, where there is a store."""
    if parts.store is not None:
        app.include_router(cases_router(parts.store))
    if parts.jobs is not None:
        app.include_router(jobs_router(parts.jobs))
    if parts.steps is not None and parts.store is not None:
        app.include_router(camera_router(parts.steps.camera, parts.store.home))
        app.include_router(readout_router(parts.steps.readout))
        app.include_router(latency_router(parts.steps.latency))
        app.include_router(markers_router(parts.steps.markers, parts.store.home))
        app.include_router(tools_router(parts.steps.tool))
        app.include_router(ct_router(parts.steps.ct, parts.steps.opened_ct, parts.store.home))
        app.include_router(
            plan_router(
                parts.steps.plan,
                parts.steps.opened_ct,
                parts.store.home,
                min_landmarks=parts.config.registration.min_points,
            )
        )
        app.include_router(procedure_router(parts.steps.procedure, parts.steps.confirm))
        app.include_router(registration_router(parts.steps.registration))
        app.include_router(sweep_router(parts.steps.registration.sweep))
        app.include_router(needles_router(parts.steps.registration, parts.steps.opened_ct))
        app.include_router(surface_router(parts.steps.surface, parts.store, parts.store.home))
