"""The ASGI application: routes, middleware and their wiring."""

import asyncio
import contextlib
import socket
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass

from fastapi import Depends, FastAPI

from server.alarms import AlarmService
from server.api.accuracy import accuracy_router
from server.api.alarms import alarms_router
from server.api.audit import audit_router
from server.api.camera import camera_router
from server.api.cases import cases_router
from server.api.certificates import certificates_router
from server.api.ct import ct_router
from server.api.dashboard import PRODUCT, dashboard_message, dashboard_router
from server.api.documentation import DocumentedApi, documentation_router
from server.api.drillings import drillings_router
from server.api.errors import rejections
from server.api.gates import gates_router
from server.api.guards import add_guards
from server.api.guide import mount_guide
from server.api.health import health_router
from server.api.hub_requests import performer, rejected
from server.api.jobs import jobs_router
from server.api.labels import labels_router
from server.api.latency import latency_router
from server.api.live import live_router
from server.api.markers import markers_router
from server.api.metrics import Metrics, metrics_router
from server.api.navigation_ct import navigation_ct_router
from server.api.needles import needles_router
from server.api.page import mount_page, page_folder
from server.api.people import people_router
from server.api.placements import placements_router
from server.api.plan import plan_router
from server.api.procedure import procedure_router
from server.api.readout import readout_router
from server.api.received import received_router
from server.api.recording_review import recording_review_router, review_scenes_router
from server.api.recordings import recording_exports_router, recordings_router
from server.api.registration import registration_router
from server.api.rehearsal import rehearsal_router
from server.api.requester import set_requester
from server.api.session import session_router
from server.api.streams import SOCKETS_DESCRIPTION, streams_router
from server.api.supervision import ROOM_DESCRIPTION, room_router, signatures_router
from server.api.surface import surface_router
from server.api.sweep import sweep_router
from server.api.tools import tools_router
from server.capture.address import source_from_text
from server.config import Config
from server.dicom_receiver import DicomReceiver
from server.hub.connection import HubAddress
from server.hub.requests import RequestServer
from server.hub.theatre import HubPublication
from server.installation import product_version
from server.jobs import Jobs
from server.live import LiveHub, Problem
from server.loop.rehearsal_control import RehearsalControl
from server.openigtlink import OpenIgtLinkServer
from server.overlay.panel_readings import RESEARCH_SOFTWARE
from server.procedure import Steps
from server.procedure.scene_bone import SceneBone
from server.recording.comments import RecordingComments
from server.recording.exports import RecordingExports
from server.recording.review import RecordingReview
from server.recording.review_scenes import ReviewScenes
from server.recording.service import RecordingService
from server.scene import Admit, mount_scene
from server.security import PeopleService
from server.sinks import Sinks
from server.store import CaseStore
from server.stream.connection import abort_connection
from server.stream.mjpeg import Video
from server.stream.phone.receiver import Receiver
from server.stream.phone.socket import PhoneEndpoint
from server.stream.scaling.message_cache import MessageCache
from server.stream.scaling.picture_cache import PictureCache
from server.stream.view_socket import ViewContext
from server.stream.viewers import ViewerKind, Viewers
from server.supervision import HoldRequestFile, HoldRequests, RoomHub, SignatureService
from tracker.navigation import Setup
from tracker.plan import Surface

OPENAPI_PATH = "/api/openapi.json"
ALL_INTERFACES = frozenset({"0.0.0.0", "::"})  # noqa: S104  compared with, not listened on


@dataclass(frozen=True, slots=True, kw_only=True)
class AppParts:
    """Components of the application.

    Attributes:
        hub: Publishes the newest instant.
        config: The settings, with the limits for all routes.
        store: Case store; without one the routes of cases are missing.
        jobs: Background jobs; None without them.
        steps: Steps of the procedure; None without a store.
        setup: Setup of the 3-D scene before the first image; None if it is known later.
        surface: Bone surface of the 3-D scene.
        alarms: Alarm service; None creates one without input.
        rehearsed: The rehearsal; None for other sources.
        phone: Receiver of phone images; None for other sources.
        people: Sessions and invitations; None without access control, as in tests.
        openigtlink: Listening socket of OpenIGTLink; None if it is off.
        recordings: Recordings of the open case; None without them.
        sinks: Plug-ins that receive each message; None without them.
        publication: Publication to a hub; None if it is off.
        dicom: Receiver of CTs; None if it is off.
    """

    hub: LiveHub
    config: Config
    store: CaseStore | None = None
    jobs: Jobs | None = None
    steps: Steps | None = None
    setup: Setup | None = None
    surface: Surface | None = None
    alarms: AlarmService | None = None
    rehearsed: RehearsalControl | None = None
    phone: Receiver | None = None
    people: PeopleService | None = None
    openigtlink: socket.socket | None = None
    recordings: RecordingService | None = None
    sinks: Sinks | None = None
    publication: HubPublication | None = None
    dicom: DicomReceiver | None = None


def create_app(parts: AppParts) -> FastAPI:
    """Create the application."""
    hub, config, limits = parts.hub, parts.config, parts.config.limits
    viewers = Viewers(maximum=config.video.max_viewers)
    pictures = PictureCache(quality=config.video.jpeg_quality, language=config.video.language)
    metrics = Metrics(hub=hub, viewers=viewers, pictures=pictures)
    video = Video(hub=hub, viewers=viewers, pictures=pictures, stale_after_ms=limits.video_stale_after_ms)
    view = ViewContext(hub=hub, viewers=viewers, pictures=pictures, texts=MessageCache())

    link = OpenIgtLinkServer(hub, config)

    @contextlib.asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        counting = asyncio.create_task(metrics.follow(), name="metrics")
        await app.state.scene.start()
        if parts.openigtlink is not None:
            await link.start(parts.openigtlink)
        requests = _hub_requests(app, parts)
        answering = None if requests is None else asyncio.create_task(requests.run(), name="hub requests")
        try:
            yield
        finally:
            if answering is not None:
                answering.cancel()
                await asyncio.wait([answering])
            if parts.steps is not None:
                await asyncio.to_thread(parts.steps.close)
            await link.stop()
            await app.state.scene.stop()
            if app.state.review_scenes is not None:
                await app.state.review_scenes.stop()
            counting.cancel()
            await asyncio.wait([counting])
            pictures.close()

    app = DocumentedApi(
        title=PRODUCT,
        version=product_version(),
        description=f"{RESEARCH_SOFTWARE.capitalize()}.\n{SOCKETS_DESCRIPTION}{ROOM_DESCRIPTION}",
        openapi_url=OPENAPI_PATH,
        docs_url=None,
        redoc_url=None,
        lifespan=lifespan,
        dependencies=[Depends(set_requester)],
        responses=rejections(401, 403, 413, 421, 429, 500),
    )
    add_guards(app, server=config.server, people=parts.people)
    app.state.pictures = pictures
    app.state.review_scenes = None
    _add_streams(app, parts, viewers, video, view)
    app.include_router(live_router(hub))
    _add_people(app, parts)
    room_hub = _add_supervision(app, parts, viewers)
    app.include_router(dashboard_router(dashboard_message(config, scene_available=True)))
    app.include_router(gates_router(config))
    app.include_router(
        health_router(
            hub,
            stale_after_ms=limits.video_stale_after_ms,
            sinks=lambda: [
                *([] if parts.sinks is None else parts.sinks.status),
                *([] if parts.publication is None else [parts.publication.status]),
            ],
        )
    )
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
        admit=_admitted(viewers),
        cut=abort_connection,
        marks=room_hub.marks_on_cuts,
    )
    if parts.store is not None:
        SceneBone(parts.store, app.state.scene.show_surface, own=parts.surface)
    _mount_files(app, config)
    return app


def _hub_requests(app: FastAPI, parts: AppParts) -> RequestServer | None:
    """Return what answers supervisors at the hub; None if it is off."""
    publication, people, hub = parts.publication, parts.people, parts.config.hub
    if not hub.requests or hub.theatre is None or publication is None or people is None:
        return None
    return RequestServer(
        HubAddress.of(hub),
        hub.theatre,
        perform=performer(app, people),
        is_published=lambda: publication.status.problem is None,
        rejected=rejected,
    )


def picture_problem_of(app: FastAPI) -> Callable[[], Problem | None]:
    """Return a function for any thread: why this application cannot draw a picture, None while it can."""
    pictures: PictureCache = app.state.pictures
    return lambda: pictures.problem


def _add_streams(app: FastAPI, parts: AppParts, viewers: Viewers, video: Video, view: ViewContext) -> None:
    """Add the routes of the streams and of the phone camera."""
    camera = parts.config.camera
    source = source_from_text(camera.source).name
    phone = PhoneEndpoint(hub=parts.hub, viewers=viewers, receiver=parts.phone, source=source)
    app.include_router(streams_router(camera_name=camera.name, video=video, view=view, phone=phone))


def _mount_files(app: FastAPI, config: Config) -> None:
    """Mount the guide, then the page, which matches every path."""
    mount_guide(app)
    mount_page(app, camera=config.camera.name, folder=page_folder())


def _add_people(app: FastAPI, parts: AppParts) -> None:
    """Add the routes of sessions, invitations and audit log."""
    everywhere = parts.config.server.host in ALL_INTERFACES
    app.include_router(session_router(parts.people))
    app.include_router(people_router(parts.people, listens_everywhere=everywhere))
    app.include_router(audit_router(None if parts.people is None else parts.people.audit))


def _add_supervision(app: FastAPI, parts: AppParts, viewers: Viewers) -> RoomHub:
    """Add the routes of alarms, supervision and co-signatures; return the room."""
    service = parts.alarms or AlarmService(parts.config)
    storage = None if parts.store is None else HoldRequestFile(parts.store.home.folder)
    holds, signatures = HoldRequests(service, storage=storage), None
    if parts.steps is not None and parts.store is not None:
        signatures = SignatureService(parts.store, parts.steps.procedure)
        app.include_router(signatures_router(signatures))
    room_hub = RoomHub(
        hub=parts.hub,
        holds=holds,
        signatures=signatures,
        fades_after_s=parts.config.supervision.drawings_fade_after_s,
    )
    app.include_router(alarms_router(service, holds))
    app.include_router(room_router(room_hub, viewers))
    if parts.recordings is not None:
        room_hub.on_mark = parts.recordings.put_mark
        app.include_router(recordings_router(parts.recordings))
        if parts.jobs is not None and parts.store is not None:
            review = RecordingReview(parts.recordings, parts.jobs)
            comments = RecordingComments(parts.store, parts.recordings)
            exports = RecordingExports(parts.recordings, parts.jobs, parts.store.home)
            app.include_router(recording_review_router(review, comments))
            scenes = ReviewScenes(review, parts.store, admit=_admitted(viewers), cut=abort_connection)
            app.state.review_scenes = scenes
            app.include_router(review_scenes_router(scenes))
            app.include_router(drillings_router(review))
            app.include_router(recording_exports_router(exports))
    return room_hub


def _admitted(viewers: Viewers) -> Admit:
    """Return a function that registers a viewer of a 3-D scene."""
    return lambda person: viewers.register(ViewerKind.SCENE, person=person)


def _add_procedure(app: FastAPI, parts: AppParts) -> None:
    """Add the routes of cases, jobs and procedure steps."""
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
        app.include_router(
            certificates_router(parts.steps.certificates, parts.steps.accuracy, parts.store.home)
        )
        app.include_router(accuracy_router(parts.steps.accuracy, parts.store.home))
        app.include_router(ct_router(parts.steps.ct, parts.steps.ct_provider, parts.store.home))
        app.include_router(received_router(parts.steps.ct, parts.dicom))
        app.include_router(navigation_ct_router(parts.steps.navigation_ct))
        app.include_router(placements_router(parts.steps.placement))
        app.include_router(
            plan_router(
                parts.steps.plan,
                parts.steps.ct_provider,
                parts.store.home,
                min_landmarks=parts.config.registration.min_points,
            )
        )
        app.include_router(
            procedure_router(
                parts.steps.procedure,
                parts.steps.confirm,
                parts.recordings,
                setup_check=parts.steps.setup_check,
            )
        )
        app.include_router(registration_router(parts.steps.registration))
        app.include_router(sweep_router(parts.steps.registration.sweep))
        app.include_router(needles_router(parts.steps.registration, parts.steps.ct_provider))
        app.include_router(surface_router(parts.steps.surface, parts.store, parts.store.home))
        app.include_router(labels_router(parts.steps.labels, parts.steps.plan, parts.store, parts.store.home))
