"""A tracking system without images, and a recorder without a process."""

from collections.abc import Callable
from pathlib import Path

from server.alarms import AlarmService
from server.config import Config
from server.live import Problem, ProcessState, ProcessStatus
from server.logs import LogSettings
from server.loop.shared_status import ProcessView
from server.recording.process import RecordingOrder, RecordingStatus
from server.recording.recorder import Recorder, TrackedImages
from server.recording.service import RecordingService
from server.recording_file import Topic
from server.store import CaseStore


class NoImages:
    """A tracking system that has not started."""

    def __init__(self) -> None:
        self.requests: list[bool] = []
        self.current = ProcessView(
            process=ProcessStatus(state=ProcessState.STARTING), generation=0, ring=None
        )

    def record(self, *, is_recording: bool) -> None:
        self.requests.append(is_recording)


class NoRecorder(Recorder):
    """Writes a few bytes instead of a recording."""

    def __init__(
        self,
        order: RecordingOrder,
        *,
        tracked: TrackedImages,
        alarms: AlarmService,
        on_end: Callable[[Problem | None], None] = lambda _: None,
    ) -> None:
        del tracked, alarms
        self.path: Path = order.path
        self.order = order
        self.texts: list[tuple[Topic, str]] = []
        self.reason: str | None = None
        self.now = RecordingStatus(written_bytes=1000, images=3)
        self._on_end = on_end
        order.path.write_bytes(b"recorded")

    @property
    def status(self) -> RecordingStatus:
        return self.now

    def put_text(self, topic: Topic, text: str) -> None:
        self.texts.append((topic, text))

    def fail(self, problem: Problem) -> None:
        """End by itself."""
        self.now = RecordingStatus(written_bytes=1000, images=3, problem=problem, is_ended=True)
        self._on_end(problem)

    def stop(self, reason: str = "") -> RecordingStatus:
        self.reason = reason
        self.now = RecordingStatus(written_bytes=1000, images=3, problem=self.now.problem, is_ended=True)
        return self.now


def recordings_without_process(
    store: CaseStore, config: Config, alarms: AlarmService | None = None
) -> RecordingService:
    """Return the recordings of a server that writes none."""
    return RecordingService(
        tracked=NoImages(),
        alarms=alarms or AlarmService(config),
        store=store,
        config=config,
        log_settings=LogSettings(as_json=True),
        product_version="0",
        make_recorder=NoRecorder,
    )
