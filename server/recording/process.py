"""The recording process: reads every entry of the ring in order, and writes the file.

It only reads the shared memory and has a low priority, so that it does not slow tracking. The ring buffers
half a second of images for it. Images that are overwritten before they are read are missing from the file: a
note records this, and a new tracking state is requested, from which a replay is exact again.

Encoding a state takes a tenth of a second. A thread does it, while later messages wait in memory.
"""

import contextlib
import signal
import time
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import TypeAlias

import structlog

from server.alarms.evaluation import AlarmState, AlarmStep
from server.errors import RecordingError
from server.live import Problem, SourceStatus
from server.logs import LogSettings, configure_logging
from server.loop.report import Report, ReportUnpacker
from server.loop.ring import Entry, ImageRing
from server.loop.tracking_state import unpickled_state
from server.priority import lower_process_priority
from server.recording.messages import (
    AlarmStepMessage,
    DocumentsMessage,
    NoteMessage,
    PosesMessage,
    SessionMessage,
    TrackedMessage,
    alarm_step_message,
    controls_message,
    poses_message,
)
from server.recording_file import ImagePacker, RecordingWriter, Topic, WriterLimits, encoded_value
from server.recording_file.writer import compressed_json
from server.stream.alarm_messages import AlarmsMessage, alarms_message
from server.stream.message import Message
from server.stream.messages import SourceMessage, source_message
from server.stream.snapshot_messages import SnapshotMessage, snapshot_message
from tracker.navigation.alarms import AlarmSnapshot

POLL_S = 0.01
STATUS_PERIOD_S = 0.25
# A request after each lost image would fill the file with states.
MIN_REQUEST_INTERVAL_S = 5.0
# A part that is cut out starts with a state. A state takes 2 ms of tracking and 4 MB of the file.
STATE_PERIOD_S = 60.0
# Limit for packed images that wait for a state; more are dropped and recorded as missing.
MAX_WAITING_BYTES = 256 * 2**20

Write: TypeAlias = Callable[[], None]
log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingOrder:
    """What is recorded where.

    Attributes:
        path: of the new file.
        limits: when it is stopped.
        session: first message of the file.
        log: log settings.
    """

    path: Path
    limits: WriterLimits
    session: SessionMessage
    log: LogSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class RingChanged:
    """Another tracking process, or none."""

    ring: ImageRing | None


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmsBegin:
    """State of the alarms before the steps that follow."""

    state: AlarmState
    at_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class StepsTaken:
    """Steps of the alarms with their results, in order.

    Attributes:
        steps: each with its result.
        missing: number of steps before them that were dropped.
    """

    steps: Sequence[tuple[AlarmStep, AlarmSnapshot]]
    missing: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class TextMessage:
    """A message of a topic, as JSON."""

    topic: Topic
    text: str
    at_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Stop:
    """End of the recording."""

    reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class StateNeeded:
    """Request for the tracking state before the next image."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmsNeeded:
    """Request for the state of the alarms: images are recorded exactly from now on."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingStatus:
    """State of the recording.

    Attributes:
        written_bytes: Size of the file.
        images: Number of recorded images.
        missing_images: Number of tracked images that are not in the file.
        problem: Why it was stopped; None while it runs.
        is_ended: Whether the file is closed.
    """

    written_bytes: int = 0
    images: int = 0
    missing_images: int = 0
    problem: Problem | None = None
    is_ended: bool = False


FromServer: TypeAlias = RingChanged | AlarmsBegin | StepsTaken | TextMessage | Stop
ToServer: TypeAlias = StateNeeded | AlarmsNeeded | RecordingStatus

SCHEMAS: dict[Topic, type[Message]] = {
    Topic.SESSION: SessionMessage,
    Topic.TRACKED: TrackedMessage,
    Topic.POSES: PosesMessage,
    Topic.SNAPSHOT: SnapshotMessage,
    Topic.SOURCE: SourceMessage,
    Topic.ALARM_STEP: AlarmStepMessage,
    Topic.ALARMS: AlarmsMessage,
    Topic.DOCUMENTS: DocumentsMessage,
    Topic.NOTE: NoteMessage,
}


def run_recording(order: RecordingOrder, connection: Connection) -> None:
    """Record until the server requests the end or has exited."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    lower_process_priority()
    configure_logging(order.log, process="recording")
    try:
        recording = Recording(order, send=connection.send)
    except RecordingError as error:
        connection.send(RecordingStatus(problem=Problem.from_error(error), is_ended=True))
        return
    problem: Problem | None = None
    try:
        follow_server(recording, connection)
    except RecordingError as error:
        log.warning(error.message, code=error.code, remedy=error.remedy)
        problem = Problem.from_error(error)
    with contextlib.suppress(RecordingError):
        recording.close()
    # The server may have exited.
    with contextlib.suppress(OSError):
        connection.send(recording.status(problem=problem, is_ended=True))


def follow_server(recording: "Recording", connection: Connection) -> None:
    """Record until the server requests the end; if it exits, up to the last image of the ring."""
    while True:
        try:
            while connection.poll(0.0 if recording.is_late else POLL_S):
                message: FromServer = connection.recv()
                if isinstance(message, Stop):
                    recording.read_all()
                    recording.note("STOPPED", message.reason or "the recording was stopped")
                    return
                recording.take(message)
        except (EOFError, OSError):
            recording.read_all()
            recording.note("STOPPED", "the server ended")
            return
        recording.read_newer()
        recording.tick()


class Recording:
    """One recording, driven by messages of the server and entries of the ring.

    Args:
        order: What is recorded.
        send: Sends a message to the server.
        clock: Monotonic clock.

    Raises:
        RecordingError: The file cannot be created.
    """

    def __init__(
        self,
        order: RecordingOrder,
        *,
        send: Callable[[ToServer], None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._send = send
        self._clock = clock
        self._writer = RecordingWriter(
            order.path,
            limits=order.limits,
            unix_offset_s=order.session.unix_offset_s,
            library=f"coaxial {order.session.product_version}",
        )
        for topic, model in SCHEMAS.items():
            self._writer.register(topic, model.model_json_schema())
        self._writer.register(Topic.MARKS)
        self._packer = ImagePacker()
        self._encoder = ThreadPoolExecutor(max_workers=1, thread_name_prefix="state")
        self._encoding: Future[bytes] | None = None
        self._waiting: deque[Write] = deque()
        self._waiting_bytes = 0
        self._ring: ImageRing | None = None
        self._unpacker = ReportUnpacker()
        self._read = 0
        self._tracked: int | None = None
        self._has_state = False
        self._requested_at_s = -MIN_REQUEST_INTERVAL_S
        self._state_at_s = clock()
        self._images = self._missing = 0
        self._revision = -1
        self._source: SourceMessage | None = None
        self._reported_at_s = 0.0
        self.is_late = False
        self._writer.add_json(Topic.SESSION, clock(), order.session.model_dump_json())

    def status(self, *, problem: Problem | None = None, is_ended: bool = False) -> RecordingStatus:
        """Return the state of this recording."""
        return RecordingStatus(
            written_bytes=self._writer.written_bytes,
            images=self._images,
            missing_images=self._missing,
            problem=problem,
            is_ended=is_ended,
        )

    def take(self, message: FromServer) -> None:
        """Process a message of the server."""
        match message:
            case RingChanged():
                self._change_ring(message.ring)
            case AlarmsBegin():
                content, at_s = compressed_json(encoded_value(message.state)), message.at_s
                self._write(lambda: self._writer.add_compressed(Topic.ALARM_STATE, at_s, content))
            case StepsTaken():
                if message.missing:
                    self.note("STEPS_MISSING", f"{message.missing} alarm steps are missing")
                for step, picture in message.steps:
                    self._take_step(step, picture)
            case TextMessage():
                text = message
                self._write(lambda: self._writer.add_json(text.topic, text.at_s, text.text))
            case Stop():  # ends the loop that calls this
                pass

    def read_all(self) -> None:
        """Read all entries of the ring, and wait for a state that is being encoded."""
        while self.read_newer():
            pass
        if self._encoding is not None:
            self._encoding.exception()
        self._drain()

    def read_newer(self) -> bool:
        """Read the next entry of the ring; return whether there was one."""
        entry = None if self._ring is None else self._ring.next_after(self._read)
        self.is_late = entry is not None
        if entry is not None:
            self._read = entry.sequence
            self._take_entry(entry)
        self._drain()
        return entry is not None

    def tick(self) -> None:
        """Write pending messages, request a state if one is needed, and report.

        Raises:
            RecordingError: The recording cannot continue.
        """
        now_s = self._clock()
        self._writer.tick(now_s)
        is_old = now_s - self._state_at_s >= STATE_PERIOD_S
        can_request = self._ring is not None and now_s - self._requested_at_s >= MIN_REQUEST_INTERVAL_S
        if can_request and (is_old or not self._has_state):
            self._requested_at_s = now_s
            self._tell(StateNeeded())
        if now_s - self._reported_at_s >= STATUS_PERIOD_S:
            self._reported_at_s = now_s
            self._tell(self.status())

    def note(self, code: str, message: str, *, images: int = 0) -> None:
        """Write a remark on the recording."""
        text, at_s = NoteMessage(code=code, message=message, images=images).model_dump_json(), self._clock()
        self._write(lambda: self._writer.add_json(Topic.NOTE, at_s, text))

    def close(self) -> None:
        """Close the file.

        Raises:
            RecordingError: The file cannot be written.
        """
        self._encoder.shutdown(cancel_futures=True)
        self._encoding = None
        try:
            self._drain()
        finally:
            self._writer.close()

    def _tell(self, message: ToServer) -> None:
        # A server that has exited is noticed where its messages are received; what is recorded is kept.
        with contextlib.suppress(OSError):
            self._send(message)

    def _change_ring(self, ring: ImageRing | None) -> None:
        if self._ring is not None:
            while self.read_newer():
                pass
            self.note("PROCESS_CHANGED", "the tracking process ended")
        newest = None if ring is None else ring.newest()
        self._ring, self._read = ring, 0 if newest is None else newest.sequence
        self._unpacker, self._tracked = ReportUnpacker(), None
        self._has_state = False
        # A tracking process that starts during a recording sends its state without a request.
        self._requested_at_s = -MIN_REQUEST_INTERVAL_S

    def _take_entry(self, entry: Entry) -> None:
        report = self._unpacker.unpack(entry.payload)
        self._note_source(report.source)
        snapshot = report.snapshot
        if snapshot is None or entry.image is None or self._ring is None:
            return
        missing = 0 if self._tracked is None else report.tracked_images - self._tracked - 1
        self._tracked = report.tracked_images
        if missing > 0 and self._images:
            self._lose(missing)
        if report.state:
            self._take_state(report, self._ring)
        if self._images == 0 and not self._has_state:
            # A recording starts with a state.
            return
        if self._waiting_bytes > MAX_WAITING_BYTES:
            self._lose(1)
            return
        self._write_image(report, entry)

    def _lose(self, images: int) -> None:
        self._missing += images
        self._has_state = False
        self.note("IMAGES_MISSING", f"{images} tracked images are missing before this one", images=images)

    def _take_state(self, report: Report, ring: ImageRing) -> None:
        content = ring.state(report.state) if report.state > 0 else b""
        if not content:
            if report.state < 0 and not self._has_state:
                self.note("STATE_MISSING", "the tracking state could not be captured")
                # Images are still recorded for review.
                self._has_state = True
            return
        snapshot = report.snapshot
        if snapshot is None:
            return
        number, at_s = snapshot.image_number, snapshot.captured_at_s
        if self._encoding is not None:
            # A second state has to wait for the first one, to keep the order.
            self._encoding.exception()
            self._drain()
        self._has_state, self._state_at_s = True, self._clock()
        self._encoding = self._encoder.submit(
            lambda: compressed_json(encoded_value(unpickled_state(content)))
        )
        encoding = self._encoding
        self._waiting.append(lambda: self._write_state(encoding, number, at_s))
        self._tell(AlarmsNeeded())

    def _write_state(self, encoding: Future[bytes], number: int, at_s: float) -> None:
        error = encoding.exception()
        if error is not None:
            log.error("the tracking state could not be recorded", why=str(error))
            text = NoteMessage(code="STATE_MISSING", message=str(error)).model_dump_json()
            self._writer.add_json(Topic.NOTE, at_s, text)
            return
        self._writer.add_compressed(Topic.STATE, at_s, encoding.result(), sequence=number)

    def _write_image(self, report: Report, entry: Entry) -> None:
        snapshot, image = report.snapshot, entry.image
        if snapshot is None or image is None:
            return
        number, at_s = snapshot.image_number, snapshot.captured_at_s
        camera = report.source.camera
        tracked = TrackedMessage(
            image_number=number,
            captured_at_s=at_s,
            skipped_images=snapshot.skipped_images,
            controls=controls_message(None if camera is None else camera.controls),
            device=report.source.device,
            is_predicted=report.is_predicted,
        ).model_dump_json()
        packed = self._packer.pack(image, entry.encoded)
        poses = poses_message(snapshot).model_dump_json()
        text = snapshot_message(snapshot).model_dump_json()

        def write() -> None:
            self._writer.add_json(Topic.TRACKED, at_s, tracked, sequence=number)
            self._writer.add_image(packed, number=number, at_s=at_s)
            self._writer.add_json(Topic.POSES, at_s, poses, sequence=number)
            self._writer.add_json(Topic.SNAPSHOT, at_s, text, sequence=number)

        self._images += 1
        self._write(write, size=len(packed.content))

    def _take_step(self, step: AlarmStep, picture: AlarmSnapshot) -> None:
        text = alarm_step_message(step, picture).model_dump_json()
        number = step.image_number or 0
        self._write(lambda: self._writer.add_json(Topic.ALARM_STEP, step.at_s, text, sequence=number))
        if picture.revision != self._revision:
            self._revision = picture.revision
            shown = alarms_message(picture, now_s=picture.at_s).model_dump_json()
            self._write(lambda: self._writer.add_json(Topic.ALARMS, step.at_s, shown))

    def _note_source(self, source: SourceStatus) -> None:
        message = source_message(source)
        fixed = message.model_copy(update={"images": 0, "skipped_images": 0, "rate_hz": 0.0})
        if fixed != self._source:
            self._source, at_s = fixed, self._clock()
            text = message.model_dump_json()
            self._write(lambda: self._writer.add_json(Topic.SOURCE, at_s, text))

    def _write(self, write: Write, *, size: int = 0) -> None:
        """Write now, or after the state that is being encoded."""
        if self._encoding is None:
            write()
            return
        self._waiting_bytes += size
        self._waiting.append(write)

    def _drain(self) -> None:
        if self._encoding is not None and not self._encoding.done():
            return
        self._encoding = None
        while self._waiting:
            self._waiting.popleft()()
        self._waiting_bytes = 0
