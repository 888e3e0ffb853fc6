"""`RecordingService`: starts and stops recordings of the open case, and lists, protects and deletes them.

A recording is a file in the folder of its case, but not a file of the store: those are removed at the next
start if they are incomplete, while a recording must be readable after a crash. It is not part of an exported
archive, and is deleted with its case.
"""

import hashlib
import json
import re
import secrets
import shutil
import threading
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal

import structlog

from server.alarms import AlarmService
from server.clock import utc_now, utc_text
from server.config import Config
from server.disk import sync_file, sync_path
from server.errors import RecordingError, SetupOrderError
from server.live import Problem
from server.logs import LogSettings
from server.procedure.open_case import require_open_case
from server.recording.consent import NAME as CONSENT_NAME
from server.recording.consent import Consent, ConsentRecord, ConsentState, stored_consent
from server.recording.messages import DocumentMessage, DocumentsMessage, session_message
from server.recording.process import RecordingOrder, RecordingStatus
from server.recording.recorder import Recorder, TrackedImages
from server.recording.timeline import index_path
from server.recording_file import Topic, WriterLimits
from server.recording_file.locations import read_duration_s
from server.recording_file.topics import SUFFIX
from server.store import Case, CaseStore, Change, DocumentKind, NotFound, StoreError
from server.store.home import PRIVATE, RECORDINGS

# Time of the start, a number that increases from recording to recording, because clocks can be set back, and
# random digits. Recordings of earlier versions have no number.
NAME = re.compile(r"\d{8}T\d{6}Z(?:-(?P<number>\d{6,}))?-[0-9a-f]{4}\.mcap")
TIME_FORMAT = "%Y%m%dT%H%M%SZ"
PROTECTED = ".protected"
# Rotation leaves a fifth of the budget for the new recording.
MAX_STORED_RATIO = 0.8
EXPORTS = ".exports"
POLL_S = 0.25
# Waiting time after a failure, instead of an attempt at each of the four polls per second.
RETRY_AFTER_S = 30.0
# Documents that configure tracking, alarms and overlay, and the bone of the 3-D scene.
RECORDED_KINDS = (
    DocumentKind.CAMERA,
    DocumentKind.MARKER,
    DocumentKind.TOOL,
    DocumentKind.SURFACE,
    DocumentKind.PLAN,
    DocumentKind.REGISTRATION,
    DocumentKind.CHECK,
    DocumentKind.CONFIRMATION,
    DocumentKind.PLACEMENT,
    DocumentKind.SIGNATURE,
)

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class StoredRecording:
    """A recording of a case.

    Attributes:
        name: Name of its file.
        began_at: UTC, ISO 8601.
        duration_s: Time from its first to its last message; None while it runs, and if it is incomplete.
        size_bytes: Size of its file.
        is_protected: Whether it cannot be deleted.
        is_running: Whether it is being written.
    """

    name: str
    began_at: str
    duration_s: float | None
    size_bytes: int
    is_protected: bool
    is_running: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingState:
    """State of the recording.

    Attributes:
        name: Name of the running recording; empty without one.
        duration_s: Time since its start.
        status: Status of the running or the last recording.
        problem: Why the last one ended without a request; None if it did not.
        remaining_s: Time until disk or budget are used up at the present rate; None if unknown.
    """

    name: str = ""
    duration_s: float = 0.0
    status: RecordingStatus | None = None
    problem: Problem | None = None
    remaining_s: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class _Running:
    recorder: Recorder
    case: Case
    name: str
    began_at_s: float
    max_bytes: float
    in_use: ExitStack


class RecordingService:
    """Recordings of one server. Thread-safe.

    Args:
        tracked: The tracking system.
        alarms: The alarms.
        store: The cases.
        config: The settings.
        log_settings: Log settings of the recording process.
        product_version: Version of this program.
        make_recorder: Creates a recorder; replaced in tests.
    """

    def __init__(
        self,
        *,
        tracked: TrackedImages,
        alarms: AlarmService,
        store: CaseStore,
        config: Config,
        log_settings: LogSettings,
        product_version: str,
        make_recorder: Callable[..., Recorder] = Recorder,
    ) -> None:
        self._tracked = tracked
        self._alarms = alarms
        self._store = store
        self._config = config
        self._log_settings = log_settings
        self._product_version = product_version
        self._make_recorder = make_recorder
        self._lock = threading.RLock()
        self._running: _Running | None = None
        # Names of recordings whose processes are still writing.
        self._closing: set[str] = set()
        self._last: RecordingStatus | None = None
        self._problem: Problem | None = None
        self._documents: tuple[str, ...] | None = None
        # By file, with the size and modification time for which they are valid.
        self._durations: dict[Path, tuple[tuple[int, int], float | None]] = {}
        self._failed_at_s = -RETRY_AFTER_S
        self._is_autostart_suspended = False
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._follow, name="recordings", daemon=True)

    def follow(self) -> None:
        """Start and stop recordings automatically as set, from now on."""
        self._thread.start()

    def close(self) -> None:
        """Stop the running recording and this service."""
        self._stop.set()
        if self._thread.is_alive():
            self._thread.join(5.0)
        self._end("the server was stopped")

    @property
    def when(self) -> Literal["navigating", "manual", "never"]:
        """When recordings start, from the settings."""
        return self._config.recording.when

    @property
    def consent(self) -> Consent:
        """Return whether the patient of the open case consented to recordings."""
        case = self._store.get_open_case()
        if self._config.recording.consent == "not_required":
            return Consent(state=ConsentState.NOT_REQUIRED)
        return (
            Consent(state=ConsentState.NOT_ANSWERED) if case is None else stored_consent(self._store, case.id)
        )

    def answer_consent(self, case_id: str, *, is_given: bool, made_by: str) -> Consent:
        """Store whether the patient consented to recordings of the open case; end the running one if not.

        Args:
            case_id: The case that was open when the question was asked.
            is_given: The answer.
            made_by: Name of the person who answers.

        Raises:
            SetupOrderError: NO_CASE_OPEN, CASE_NOT_OPEN.
            StoreError: The answer cannot be stored.
        """
        case = require_open_case(self._store)
        if case.id != case_id:
            raise SetupOrderError(
                "CASE_NOT_OPEN",
                "another case was opened since the question was asked",
                "Answer for the case that is open now.",
                {"case_id": case.id},
            )
        record = ConsentRecord(is_given=is_given)
        self._store.put(
            case.id, DocumentKind.CONSENT, CONSENT_NAME, record.model_dump(mode="json"), made_by=made_by
        )
        if not is_given:
            self._end("the patient does not consent to recordings")
        return self.consent

    @property
    def state(self) -> RecordingState:
        """Return the state of the recording."""
        with self._lock:
            running, problem, last = self._running, self._problem, self._last
        if running is None:
            return RecordingState(status=last, problem=problem)
        status = running.recorder.status
        return RecordingState(
            name=running.name,
            duration_s=time.monotonic() - running.began_at_s,
            status=status,
            problem=problem,
            remaining_s=self._remaining_s(running, status),
        )

    def start(self) -> RecordingState:
        """Start a recording of the open case; a running recording continues.

        Raises:
            RecordingError: RECORDING_SWITCHED_OFF, RECORDING_BUDGET_EXCEEDED, RECORDING_DISK_FULL.
            SetupOrderError: NO_CASE_OPEN, RECORDING_CONSENT_MISSING.
            StoreError: the folder of the case cannot be used.
        """
        with self._lock:
            if self._running is None:
                self._begin()
            self._is_autostart_suspended = False
        return self.state

    def stop(self) -> RecordingState:
        """Stop the recording, wait until its file is closed, and return the state."""
        with self._lock:
            # Not started again automatically before navigation ends.
            self._is_autostart_suspended = True
            self._problem = None
        self._alarms.set_recording_runs(runs=True)
        self._end("stopped on request")
        return self.state

    def list(self) -> Sequence[StoredRecording]:
        """Return the recordings of the open case, oldest first.

        Raises:
            SetupOrderError: NO_CASE_OPEN.
        """
        folder = self._folder(require_open_case(self._store))
        with self._lock:
            written = {*self._closing, self.state.name}
        found = []
        for path in sorted(folder.glob(f"*{SUFFIX}"), key=_age_order) if folder.is_dir() else []:
            began_at = _began_at(path.name)
            if began_at is None or not path.is_file():
                continue
            # It may have been deleted meanwhile.
            with suppress(FileNotFoundError):
                found.append(
                    StoredRecording(
                        name=path.name,
                        began_at=began_at,
                        duration_s=None if path.name in written else self._duration_s(path),
                        size_bytes=path.stat().st_size,
                        is_protected=_protection(path).exists(),
                        is_running=path.name in written,
                    )
                )
        return found

    def path(self, name: str) -> Path:
        """Return the file of a recording of the open case.

        Raises:
            NotFound: RECORDING_UNKNOWN.
            SetupOrderError: NO_CASE_OPEN.
        """
        path = self._folder(require_open_case(self._store)) / name
        if not NAME.fullmatch(name) or not path.is_file():
            raise NotFound(
                "RECORDING_UNKNOWN",
                f"the open case has no recording {name!r}",
                "Load the list of recordings again.",
                {"name": name},
            )
        return path

    def ended_path(self, name: str) -> Path:
        """Return the file of a recording that is not being written.

        Raises:
            RecordingError: RECORDING_RUNS.
            NotFound: RECORDING_UNKNOWN.
            SetupOrderError: NO_CASE_OPEN.
        """
        path = self.path(name)
        with self._lock:
            self._reject_running(name)
        return path

    def require_space(self) -> None:
        """Reject an export if the disk of the recordings is nearly full.

        Raises:
            RecordingError: RECORDING_DISK_FULL.
        """
        min_free_gb = self._config.recording.min_free_gb
        free_bytes = self._store.home.free_bytes()
        if free_bytes < min_free_gb * 1e9:
            raise RecordingError(
                "RECORDING_DISK_FULL",
                f"{free_bytes / 1e9:.2f} GB are free on the disk of the cases, and "
                f"{min_free_gb:g} GB must stay free (recording.min_free_gb)",
                "Free disk space first.",
                {"free_bytes": free_bytes, "free_gb": free_bytes / 1000000000.0, "min_free_gb": min_free_gb},
            )

    def protect(self, name: str, *, is_protected: bool) -> None:
        """Protect a recording from deletion, or remove the protection. Raises the same errors as `path`."""
        mark = _protection(self.path(name))
        if is_protected:
            mark.touch(mode=0o600)
        else:
            mark.unlink(missing_ok=True)
        sync_path(mark.parent)

    def delete(self, name: str) -> None:
        """Delete a recording.

        Raises:
            RecordingError: RECORDING_RUNS, RECORDING_PROTECTED.
            NotFound: RECORDING_UNKNOWN.
        """
        with self._lock:
            path = self.path(name)
            self._reject_running(name)
            if _protection(path).exists():
                raise RecordingError(
                    "RECORDING_PROTECTED",
                    f"{name} is protected from deletion",
                    "Remove its protection first, if it is no longer needed.",
                    {"name": name},
                )
            self._delete_file(path)

    def _delete_file(self, path: Path) -> None:
        path.unlink()
        self._durations.pop(path, None)
        # Including the remains of a killed job.
        for index in path.parent.glob(f"{index_path(path).name}*"):
            index.unlink(missing_ok=True)
        shutil.rmtree(exports_folder(path), ignore_errors=True)
        sync_path(path.parent)

    def _rotate(self) -> None:
        """Delete the oldest unprotected recordings of all cases, until enough of the budget is free.

        Nothing is deleted where that is not possible, because protected ones take too much of it.
        """
        over_bytes = self._total_bytes() - MAX_STORED_RATIO * self._config.recording.max_total_gb * 1e9
        unprotected = sorted(
            (
                path
                for path in self._store.home.cases.glob(f"*/{RECORDINGS}/*{SUFFIX}")
                if NAME.fullmatch(path.name)
                and path.name not in self._closing
                and not _protection(path).exists()
            ),
            key=_age_order,
        )
        sizes = [_sum_of_sizes((path, *exports_folder(path).glob("*"))) for path in unprotected]
        if sum(sizes) < over_bytes:
            return
        for path, size in zip(unprotected, sizes, strict=True):
            if over_bytes <= 0.0:
                return
            case_id = path.parents[1].name
            log.warning("a recording is deleted by rotation", file=path.name, case=case_id)
            try:
                self._delete_file(path)
            except OSError:
                log.warning("a recording cannot be deleted", file=path.name, exc_info=True)
            else:
                over_bytes -= size
                change = Change(case_id=case_id, kind="rotation", name=path.name, before="stored", after=None)
                self._store.record_change(change)

    def put_export(self, recording: Path, made: Path) -> Path:
        """Move an exported file beside its recording, replacing the previous one; return its path.

        Raises:
            NotFound: RECORDING_UNKNOWN: The recording was deleted meanwhile.
            OSError: The file cannot be stored.
        """
        # Synced before it is renamed, so that a power failure leaves no incomplete file.
        with made.open("rb") as file:
            sync_file(file.fileno())
        with self._lock:
            if not recording.exists():
                raise NotFound(
                    "RECORDING_UNKNOWN",
                    f"{recording.name} was deleted meanwhile",
                    "Load the list of recordings again.",
                    {"name": recording.name},
                )
            folder = exports_folder(recording)
            folder.mkdir(mode=PRIVATE, exist_ok=True)
            stored = made.replace(folder / made.name)
            for earlier in folder.glob(f"*{made.suffix}"):
                if earlier != stored:
                    earlier.unlink(missing_ok=True)
            sync_path(folder)
            return stored

    def put_mark(self, text: str) -> None:
        """Record a mark of a supervisor, as JSON. Returns at once."""
        running = self._running
        if running is not None:
            running.recorder.put_text(Topic.MARKS, text)

    def _reject_running(self, name: str) -> None:
        if name in self._closing or (self._running is not None and self._running.name == name):
            raise RecordingError(
                "RECORDING_RUNS", f"{name} is being written", "Stop the recording first.", {"name": name}
            )

    def _begin(self) -> None:
        settings = self._config.recording
        if settings.when == "never":
            raise RecordingError(
                "RECORDING_SWITCHED_OFF",
                "recording.when is never",
                "Set recording.when to manual or navigating, and start the program again.",
            )
        case = require_open_case(self._store)
        if not self.consent.state.permits_recording:
            raise SetupOrderError(
                "RECORDING_CONSENT_MISSING",
                "nobody has stated that the patient consented to a recording",
                "State it on the operator's page, or with POST /api/recordings/consent.",
            )
        folder = self._folder(case)
        self.require_space()
        if settings.rotate:
            self._rotate()
        left_bytes = settings.max_total_gb * 1e9 - self._total_bytes()
        if left_bytes <= 0.0:
            raise RecordingError(
                "RECORDING_BUDGET_EXCEEDED",
                f"all recordings together have reached recording.max_total_gb, {settings.max_total_gb:g} GB",
                "Delete recordings that are not needed, or raise recording.max_total_gb.",
                {"max_total_gb": settings.max_total_gb},
            )
        now, number = utc_now(), self._next_number()
        name = f"{now:{TIME_FORMAT}}-{number:06}-{secrets.token_hex(2)}{SUFFIX}"
        with ExitStack() as stack:
            # Prevents the deletion of the case during the recording.
            stack.enter_context(self._store.in_use(case.id))
            folder.mkdir(mode=PRIVATE, parents=True, exist_ok=True)
            sync_path(folder.parent)
            order = RecordingOrder(
                path=folder / name,
                limits=WriterLimits(max_bytes=left_bytes, min_free_bytes=settings.min_free_gb * 1e9),
                session=session_message(
                    self._config,
                    case_id=case.id,
                    started_at=utc_text(now),
                    unix_offset_s=now.timestamp() - time.monotonic(),
                    product_version=self._product_version,
                ),
                log=self._log_settings,
            )
            recorder = self._make_recorder(
                order, tracked=self._tracked, alarms=self._alarms, on_end=self._note_end
            )
            self._running = _Running(
                recorder=recorder,
                case=case,
                name=name,
                began_at_s=time.monotonic(),
                max_bytes=left_bytes,
                in_use=stack.pop_all(),
            )
        self._problem, self._documents = None, None
        self._alarms.set_recording_runs(runs=True)
        self._put_documents()
        log.info("recording started", file=name, case=case.id)

    def _end(self, reason: str) -> None:
        with self._lock:
            running, self._running = self._running, None
            if running is None:
                return
            self._closing.add(running.name)
        try:
            self._last = running.recorder.stop(reason)
        finally:
            with self._lock:
                self._closing.discard(running.name)
        path = self._folder(running.case) / running.name
        # A recording that failed to start has no file.
        with suppress(FileNotFoundError):
            self._duration_s(path)
        running.in_use.close()
        log.info("recording ended", file=running.name, images=self._last.images, why=reason)

    def _note_end(self, problem: Problem | None) -> None:
        """Raise the alarm for a recording that ended without a request; called from the recorder's thread."""
        if problem is None:
            return
        log.error(problem.message, code=problem.code, remedy=problem.remedy)
        with self._lock:
            self._problem = problem
            self._failed_at_s = time.monotonic()
        self._alarms.set_recording_runs(runs=False)

    def _follow(self) -> None:
        while not self._stop.wait(POLL_S):
            try:
                self.poll()
            except StoreError as error:
                log.warning(error.message, code=error.code, remedy=error.remedy)
            except Exception:
                log.exception("starting or stopping a recording failed")

    def poll(self) -> None:
        """End a recording whose case was closed, start one if due, and record changed documents."""
        case = self._store.get_open_case()
        with self._lock:
            running = self._running
        if running is not None and running.recorder.status.is_ended:
            self._end("it failed")
        elif running is not None and (case is None or case.id != running.case.id):
            self._end("its case was closed")
        elif running is not None and not self.consent.state.permits_recording:
            self._end("the consent to it was withdrawn")
        elif running is not None:
            self._put_documents()
        if self._config.recording.when == "navigating":
            self._follow_navigation(case)

    def _follow_navigation(self, case: Case | None) -> None:
        navigates = self._alarms.is_navigating
        with self._lock:
            is_running = self._running is not None
            waits = time.monotonic() - self._failed_at_s < RETRY_AFTER_S
            if not navigates:
                self._is_autostart_suspended = False
            is_due = (
                navigates and case is not None and not (is_running or waits or self._is_autostart_suspended)
            )
        # A missing consent prevents the start, but is not a failure of the recording.
        is_due = is_due and self.consent.state.permits_recording
        if is_running and not navigates:
            self._end("navigation ended")
        elif is_due:
            try:
                self.start()
            except (RecordingError, SetupOrderError, StoreError) as error:
                self._note_end(Problem.from_error(error))

    def _put_documents(self) -> None:
        """Record the documents that are in use, if they have changed."""
        with self._lock:
            running = self._running
        if running is None:
            return
        documents = [
            document for kind in RECORDED_KINDS for document in self._store.all_current(running.case.id, kind)
        ]
        ids = tuple(document.id for document in documents)
        if ids == self._documents:
            return
        self._documents = ids
        message = DocumentsMessage(
            documents=[
                DocumentMessage(
                    id=document.id,
                    kind=document.kind.value,
                    name=document.name,
                    made_at=document.made_at,
                    made_by=document.made_by,
                    sha256=_sha256(dict(document.content)),
                    content=dict(document.content),
                )
                for document in documents
            ]
        )
        running.recorder.put_text(Topic.DOCUMENTS, message.model_dump_json())

    def _remaining_s(self, running: _Running, status: RecordingStatus) -> float | None:
        duration_s = time.monotonic() - running.began_at_s
        if status.written_bytes <= 0 or duration_s < 1.0:
            return None
        left_bytes = min(
            running.max_bytes - status.written_bytes,
            self._store.home.free_bytes() - self._config.recording.min_free_gb * 1e9,
        )
        return max(0.0, left_bytes) * duration_s / status.written_bytes

    def _duration_s(self, path: Path) -> float | None:
        """Return the duration of a finished recording; its file is read again only if it has changed."""
        found = path.stat()
        version = found.st_size, found.st_mtime_ns
        known = self._durations.get(path)
        if known is None or known[0] != version:
            known = self._durations[path] = version, read_duration_s(path)
        return known[1]

    def _next_number(self) -> int:
        paths = self._store.home.cases.glob(f"*/{RECORDINGS}/*{SUFFIX}")
        return 1 + max((_age_order(path)[0] for path in paths), default=0)

    def _total_bytes(self) -> int:
        patterns = (f"*{SUFFIX}", f"*{EXPORTS}/*")
        cases = self._store.home.cases
        return _sum_of_sizes(path for pattern in patterns for path in cases.glob(f"*/{RECORDINGS}/{pattern}"))

    def _folder(self, case: Case) -> Path:
        return self._store.home.cases / case.id / RECORDINGS


def _sum_of_sizes(paths: Iterable[Path]) -> int:
    """Return the size of the files in bytes; one that was deleted meanwhile has none."""
    total = 0
    for path in paths:
        with suppress(FileNotFoundError):
            total += path.stat().st_size
    return total


def _age_order(path: Path) -> tuple[int, str]:
    """Return the key by which recordings are sorted, oldest first; those without a number by their times."""
    found = NAME.fullmatch(path.name)
    return int(found["number"] or 0) if found else 0, path.name


def _began_at(name: str) -> str | None:
    """Return the start time of a recording; None for the name of another file."""
    if not NAME.fullmatch(name):
        return None
    try:
        return utc_text(datetime.strptime(name.partition("-")[0], TIME_FORMAT).replace(tzinfo=UTC))
    except ValueError:
        return None


def exports_folder(recording: Path) -> Path:
    """Return the folder of the exports of a recording, which is deleted with it."""
    return recording.with_name(recording.name + EXPORTS)


def _protection(path: Path) -> Path:
    return path.with_name(path.name + PROTECTED)


def _sha256(content: dict[str, object]) -> str:
    text = json.dumps(content, sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    return hashlib.sha256(text.encode()).hexdigest()
