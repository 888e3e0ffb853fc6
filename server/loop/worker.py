"""The tracking process: receives the newest image, and returns a report with the image.

One thread captures, the main thread tracks, and a third one receives case data from the server. The process
ends when the server closes its end of the pipe, also when the server dies.
"""

import contextlib
import os
import signal
import threading
import time
from dataclasses import dataclass, field, replace
from multiprocessing.connection import Connection
from typing import Generic, TypeAlias, TypeVar

import cv2
import structlog

from server.capture.capture import Capture
from server.capture.industrial import IndustrialCameraSource
from server.capture.local_camera import LocalCameraSource
from server.capture.rehearsal import RehearsalSource
from server.capture.shot import Shot, Source
from server.capture.source_factory import source_from_config
from server.config import Config
from server.home_folder import home_folder
from server.live import Problem
from server.logs import LogSettings, configure_logging
from server.loop.parent import die_with_parent
from server.loop.phone_inbox import PhoneInbox
from server.loop.report import Report, ReportPacker
from server.loop.ring import ImageRing
from server.loop.staging import SceneOrder, Staging
from server.loop.still_files import StillFiles
from server.loop.tracking import Tracking
from server.loop.tracking_state import StateRequest, tracking_state_bytes
from server.setup import CaseSetup, Preparation, build_setup
from tracker.errors import NavigationError

# Report interval without images.
HEARTBEAT_S = 0.5
STOP_GRACE_S = 0.7
# One core is left to the server; on two cores, a second thread of OpenCV costs more than it saves.
OPENCV_THREADS = min(2, max(1, (os.cpu_count() or 1) - 1))

Value = TypeVar("Value")

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkerOrder:
    """Start parameters of a tracking process.

    Attributes:
        config: settings.
        log: log settings.
        case: data of the open case; later changes come through `WorkerLink.orders`.
        first_number: Number of its first image, above all reported numbers.
        skipped_before: Number of images skipped before.
        scene: Scene of the rehearsal that replaces that of the settings; None if none was ordered.
        inbox: images of a phone; None for every other source.
        is_recording: Whether a recording is running, which needs the state before the first image.
    """

    config: Config
    log: LogSettings
    case: CaseSetup = field(default_factory=CaseSetup)
    first_number: int = 0
    skipped_before: int = 0
    scene: SceneOrder | None = None
    inbox: PhoneInbox | None = None
    is_recording: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkerLink:
    """The tracking process's ends of its connections to the server.

    Attributes:
        ring: reports and images to the server.
        notice: one byte per report wakes the server; never blocks.
        orders: from the server: a `CaseSetup` when the open case changes, a `SceneOrder` for another scene, a
            `StateRequest` of a recording; closed to end the process.
    """

    ring: ImageRing
    notice: Connection
    orders: Connection
    _packer: ReportPacker = field(default_factory=ReportPacker)

    def send(self, report: Report, shot: Shot | None = None) -> None:
        """Write a report, and wake the server."""
        content = self._packer.pack(report)
        if shot is None:
            self.ring.write(content)
        else:
            self.ring.write(content, shot.image, encoded=shot.jpeg)
        # A full pipe wakes the server anyway.
        with contextlib.suppress(BlockingIOError):
            os.write(self.notice.fileno(), b".")


class LatestValue(Generic[Value]):
    """Passes the newest value from the listening thread to the tracking thread; older ones are replaced."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._value: Value | None = None

    def put(self, value: Value) -> None:
        """Replace a value that was not taken yet."""
        with self._lock:
            self._value = value

    def take(self) -> Value | None:
        """Return a new value; None without one."""
        with self._lock:
            value, self._value = self._value, None
        return value


LatestRequest: TypeAlias = LatestValue[StateRequest]


@dataclass(frozen=True, slots=True)
class ReceivedOrders:
    """The newest orders of the server, of each kind."""

    cases: LatestValue[CaseSetup] = field(default_factory=LatestValue)
    scenes: LatestValue[SceneOrder] = field(default_factory=LatestValue)
    requests: LatestRequest = field(default_factory=LatestValue)

    def put(self, order: CaseSetup | SceneOrder | StateRequest) -> None:
        """Replace the order of this kind."""
        if isinstance(order, SceneOrder):
            self.scenes.put(order)
        elif isinstance(order, StateRequest):
            self.requests.put(order)
        else:
            self.cases.put(order)


class StateSender:
    """Stores the tracking state in the ring when a recording needs it.

    Args:
        ring: Ring of the reports.
        requests: Requests of the recording.
        is_recording: Whether a recording is running from the start.
    """

    def __init__(self, ring: ImageRing, requests: LatestRequest, *, is_recording: bool) -> None:
        self._ring = ring
        self._requests = requests
        self._is_recording = self._is_due = is_recording

    def note_changed_case(self) -> None:
        """Note that the next state does not follow from the previous one."""
        self._is_due = self._is_recording

    def store(self, tracking: Tracking) -> int:
        """Store the state before the next image if it is due; return `Report.state`."""
        request = self._requests.take()
        if request is not None:
            self._is_recording = self._is_due = request.is_recording
        if not self._is_due:
            return 0
        self._is_due = False
        content = tracking_state_bytes(tracking)
        return (self._ring.write_state(content) if content else 0) or -1


def run_worker(order: WorkerOrder, link: WorkerLink) -> None:
    """Run the tracking process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    die_with_parent()
    configure_logging(order.log, process="tracking")
    os.set_blocking(link.notice.fileno(), False)
    cv2.setNumThreads(OPENCV_THREADS)
    stop = threading.Event()
    received = ReceivedOrders()
    listening = (link.orders, received, stop)
    threading.Thread(target=_listen, args=listening, name="orders", daemon=True).start()
    try:
        preparation = build_setup(_config_of(order))
        source, staging = _staged(order, preparation, stop)
        tracking = Tracking(preparation)
        tracking.adopt(order.case)
        states = StateSender(link.ring, received.requests, is_recording=order.is_recording)
        work(order, link, stop, source, tracking, received=received, staging=staging, states=states)
    except BrokenPipeError:
        # The server has exited.
        os._exit(0)
    except Exception:
        log.exception("the tracking process failed")
        os._exit(1)


def _config_of(order: WorkerOrder) -> Config:
    """Return the settings with the last ordered scene."""
    if order.scene is None:
        return order.config
    return order.config.model_copy(update={"rehearsal": order.scene.rehearsal})


def _staged(
    order: WorkerOrder, preparation: Preparation, stop: threading.Event
) -> tuple[Source, Staging | None]:
    """Return the source of images, and the scene preparation of a rehearsal."""
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
        played_scene=None if order.scene is None else order.scene.played_scene(order.first_number),
        outages=theatre.settings.events,
    )
    return source, Staging(source, renderer, store) if isinstance(source, RehearsalSource) else None


def work(
    order: WorkerOrder,
    link: WorkerLink,
    stop: threading.Event,
    source: Source,
    tracking: Tracking,
    *,
    received: ReceivedOrders,
    staging: Staging | None = None,
    states: StateSender | None = None,
) -> None:
    """Track the newest image of the source until `stop` is set."""
    # A real camera takes no processor time, so that rendering must not slow tracking.
    capture = Capture(
        source,
        stop=stop,
        taken_before=order.first_number - order.skipped_before,
        is_simulated=staging is not None,
    )
    capture.start()
    link.send(Report(source=capture.status()))
    tracked = 0
    problem: Problem | None = None
    while not stop.is_set():
        shot = capture.take(HEARTBEAT_S)
        case = received.cases.take()
        if case is not None:
            tracking.adopt(case)
            if states is not None:
                states.note_changed_case()
            if isinstance(source, LocalCameraSource | IndustrialCameraSource):
                source.adopt(tracking.calibrated_camera)
        scene = received.scenes.take()
        if scene is not None and staging is not None:
            staging.order(scene)
        report = Report(
            source=capture.status(), played_scene=None if staging is None else staging.played_scene
        )
        if shot is None:
            link.send(replace(report, problem=problem, tracked_images=tracked))
            continue
        if states is not None:
            report = replace(report, state=states.store(tracking))
        report = replace(report, is_predicted=shot.is_predicted)
        try:
            camera = report.source.camera
            snapshot = tracking.process(
                shot,
                skipped_images=report.source.skipped_images,
                controls=None if camera is None else camera.controls,
                device=report.source.device,
            )
            problem = tracking.problem
            link.send(replace(report, snapshot=snapshot, problem=problem, tracked_images=tracked + 1), shot)
            tracked += 1
        except NavigationError as error:
            if problem is None or problem.code != error.code:
                log.warning(error.message, code=error.code, remedy=error.remedy)
            problem = Problem.from_error(error)
            link.send(replace(report, problem=problem, tracked_images=tracked))
    capture.close(STOP_GRACE_S)


def _listen(orders: Connection, received: ReceivedOrders, stop: threading.Event) -> None:
    """Pass on the server's messages; end this process when the server closes its end of the pipe."""
    with contextlib.suppress(EOFError, OSError):
        while True:
            received.put(orders.recv())
    stop.set()
    time.sleep(STOP_GRACE_S)
    # Do not wait for a hanging driver or stream.
    os._exit(0)
