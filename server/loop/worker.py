"""The tracking process itself: newest image in, report and image out.

Two threads do the work: one captures, the main one tracks. A third only listens to the server: for what the
open case knows, and for the end, which is when the server lets go of its end of the pipe (also by dying).
"""

import contextlib
import os
import signal
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from multiprocessing.connection import Connection
from typing import Generic, TypeAlias, TypeVar

import cv2
import structlog

from server.capture.capture import Capture
from server.capture.choose import source_from_config
from server.capture.industrial import IndustrialCameraSource
from server.capture.local_camera import LocalCameraSource
from server.capture.rehearsal import RehearsalSource
from server.capture.shot import Shot, Source
from server.config import Config
from server.live import Problem
from server.logs import LogSettings, configure_logging
from server.loop.parent import die_with_parent
from server.loop.phone_inbox import PhoneInbox
from server.loop.report import Report, ReportPacker
from server.loop.ring import ImageRing
from server.loop.staging import SceneOrder, Staging
from server.loop.still_files import StillFiles
from server.loop.tracking import Tracking
from server.setup import CaseSetup, Preparation, build_setup
from server.store.home import home_folder
from tracker.errors import NavigationError

# A sign of life when no image comes.
HEARTBEAT_S = 0.5
STOP_GRACE_S = 0.7

Told = TypeVar("Told")

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkerOrder:
    """What a tracking process is told when it is started.

    Attributes:
        config: the settings.
        log: how to log.
        case: what the open case knows; later changes come through `WorkerLink.orders`.
        first_number: the number of its first image, above all that were reported before.
        skipped_before: images that were skipped before.
        scene: of the rehearsal, in place of what the settings say; None while no other one was ordered.
        inbox: where the images of a phone come in; None for every other source.
    """

    config: Config
    log: LogSettings
    case: CaseSetup = field(default_factory=CaseSetup)
    first_number: int = 0
    skipped_before: int = 0
    scene: SceneOrder | None = None
    inbox: PhoneInbox | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkerLink:
    """The ends of a tracking process that the server holds the other ends of.

    Attributes:
        ring: where reports and images go.
        notice: one byte in here says that something was written; never blocks.
        orders: from the server: a `CaseSetup` when the open case changes, a `SceneOrder` when another scene
            is rehearsed; closed when the process shall end.
    """

    ring: ImageRing
    notice: Connection
    orders: Connection
    _packer: ReportPacker = field(default_factory=ReportPacker)

    def send(self, report: Report, shot: Shot | None = None) -> None:
        """Write a report, and wake the server."""
        self.ring.write(self._packer.pack(report), None if shot is None else shot.image)
        # A full pipe has woken it already.
        with contextlib.suppress(BlockingIOError):
            os.write(self.notice.fileno(), b".")


class Newest(Generic[Told]):
    """What the server told, handed from the thread that listens to the one that tracks; newest wins."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._told: Told | None = None

    def put(self, told: Told) -> None:
        """Replace what has not been taken yet."""
        with self._lock:
            self._told = told

    def take(self) -> Told | None:
        """What changed since it was last taken; None if nothing did."""
        with self._lock:
            told, self._told = self._told, None
        return told


NewestCase: TypeAlias = Newest[CaseSetup]
NewestScene: TypeAlias = Newest[SceneOrder]


def run_worker(order: WorkerOrder, link: WorkerLink) -> None:
    """The tracking process, from start to end."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    die_with_parent()
    configure_logging(order.log, process="tracking")
    os.set_blocking(link.notice.fileno(), False)
    # Two: one core is left to the server, and the tracker's images are small.
    cv2.setNumThreads(2)
    stop = threading.Event()
    newest, scenes = NewestCase(), NewestScene()
    listening = (link.orders, newest, scenes, stop)
    threading.Thread(target=_listen, args=listening, name="orders", daemon=True).start()
    try:
        preparation = build_setup(_config_of(order))
        source, staging = _staged(order, preparation, stop)
        tracking = Tracking(preparation)
        tracking.adopt(order.case)
        work(order, link, stop, source, tracking, newest=newest, scenes=scenes, staging=staging)
    except BrokenPipeError:
        # The server is gone.
        os._exit(0)
    except Exception:
        log.exception("the tracking process failed")
        os._exit(1)


def _config_of(order: WorkerOrder) -> Config:
    """The settings, with the scene that was ordered last."""
    if order.scene is None:
        return order.config
    return order.config.model_copy(update={"rehearsal": order.scene.rehearsal})


def _staged(
    order: WorkerOrder, preparation: Preparation, stop: threading.Event
) -> tuple[Source, Staging | None]:
    """The source of images, and what changes its scene where it is the rehearsal."""
    theatre = preparation.theatre
    if theatre is None:
        calibration = preparation.with_case(order.case).calibrated_camera
        source = source_from_config(
            order.config,
            stop=stop,
            first_number=order.first_number,
            calibration=calibration,
            inbox=order.inbox,
        )
        return source, None
    store = StillFiles(home_folder())
    renderer = theatre.renderer(store=store)
    if theatre.settings.events:
        renderer.prepare()
    source = source_from_config(
        order.config,
        stop=stop,
        renderer=renderer,
        first_number=order.first_number,
        begun=None if order.scene is None else order.scene.begun(order.first_number),
        silences=theatre.settings.events,
    )
    return source, Staging(source, renderer, store) if isinstance(source, RehearsalSource) else None


def work(
    order: WorkerOrder,
    link: WorkerLink,
    stop: threading.Event,
    source: Source,
    tracking: Tracking,
    *,
    newest: NewestCase,
    scenes: NewestScene | None = None,
    staging: Staging | None = None,
    clock: Callable[[], float] = time.monotonic,
) -> None:
    """Track the newest image of the source until `stop` is set."""
    capture = Capture(source, stop=stop, taken_before=order.first_number - order.skipped_before)
    capture.start()
    link.send(Report(source=capture.status()))
    tracked = 0
    problem: Problem | None = None
    while not stop.is_set():
        shot = capture.take(HEARTBEAT_S)
        case = newest.take()
        if case is not None:
            tracking.adopt(case)
            if isinstance(source, LocalCameraSource | IndustrialCameraSource):
                source.adopt(tracking.calibrated_camera)
        scene = None if scenes is None else scenes.take()
        if scene is not None and staging is not None:
            staging.order(scene)
        told = Report(source=capture.status(), begun=None if staging is None else staging.begun)
        if shot is None:
            link.send(replace(told, problem=problem, tracked_images=tracked))
            continue
        try:
            camera = told.source.camera
            snapshot = tracking.conclude(
                shot,
                skipped_images=told.source.skipped_images,
                controls=None if camera is None else camera.controls,
                clock=clock,
            )
            problem = tracking.problem
            link.send(replace(told, snapshot=snapshot, problem=problem, tracked_images=tracked + 1), shot)
            tracked += 1
        except NavigationError as error:
            if problem is None or problem.code != error.code:
                log.warning(error.message, code=error.code, remedy=error.remedy)
            problem = Problem.from_error(error)
            link.send(replace(told, problem=problem, tracked_images=tracked))
    capture.close(STOP_GRACE_S)


def _listen(orders: Connection, newest: NewestCase, scenes: NewestScene, stop: threading.Event) -> None:
    """Hands on what the server says, and ends this process when it lets go of its end of the pipe."""
    with contextlib.suppress(EOFError, OSError):
        while True:
            told = orders.recv()
            if isinstance(told, SceneOrder):
                scenes.put(told)
            else:
                newest.put(told)
    stop.set()
    time.sleep(STOP_GRACE_S)
    # Whatever still hangs (a driver, a stream that does not answer) is not worth waiting for.
    os._exit(0)
