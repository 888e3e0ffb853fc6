"""The recorder in its own process: stopped, killed, and its requests to tracking."""

import os
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from server.alarms import AlarmService
from server.config import Config
from server.errors import RecordingError
from server.live import Problem, ProcessState, ProcessStatus, SourceState, SourceStatus
from server.logs import LogSettings
from server.loop.ring import ImageRing
from server.loop.shared_status import ProcessView
from server.recording.messages import session_message
from server.recording.process import RecordingOrder
from server.recording.recorder import Recorder
from server.recording.replay import check_recording
from server.recording_file import RecordingReader, Topic, WriterLimits
from server.setup import Preparation
from tests.server.recording.recorded import Image, RecordedTheatre

DEADLINE_S = 60.0
RUNNING = ProcessStatus(state=ProcessState.RUNNING)
SOURCE = SourceStatus(name="rehearsal", state=SourceState.RUNNING)


class Tracked:
    """The tracking system: one process that answers requests for its state."""

    def __init__(self, ring: ImageRing) -> None:
        self.current = ProcessView(process=RUNNING, generation=1, ring=ring)
        self.requests: list[bool] = []

    def record(self, *, is_recording: bool) -> None:
        self.requests.append(is_recording)


class Recorded:
    """A recorder with a theatre whose images it records."""

    def __init__(self, theatre: RecordedTheatre) -> None:
        self.theatre = theatre
        self.tracked = Tracked(theatre.ring)
        self.ends: list[Problem | None] = []
        self.alarms = AlarmService(Config())
        session = session_message(
            theatre.config, case_id="0", started_at="", unix_offset_s=0.0, product_version="0"
        )
        order = RecordingOrder(
            path=theatre.path,
            limits=WriterLimits(max_bytes=1e12, min_free_bytes=0.0),
            session=session,
            log=LogSettings(as_json=True),
        )
        self.recorder = Recorder(order, tracked=self.tracked, alarms=self.alarms, on_end=self.ends.append)

    def until(self, true: Callable[[], bool]) -> None:
        deadline_s = time.monotonic() + DEADLINE_S
        while not true():
            assert time.monotonic() < deadline_s, "it did not become true"
            time.sleep(0.005)

    def until_recorded(self, images: int) -> None:
        """Return when this many images are recorded."""
        self.until(lambda: self.recorder.status.images >= images)

    def track(self, number: int) -> None:
        self.theatre.track(number)
        self.alarms.observe(None, SOURCE, RUNNING)


@pytest.fixture
def made_recorder(
    drilling: tuple[Config, Preparation, list[Image]], tmp_path: Path
) -> Iterator[Callable[[], Recorded]]:
    config, preparation, images = drilling
    made: list[Recorded] = []

    def make() -> Recorded:
        theatre = RecordedTheatre(
            path=tmp_path / "case.mcap", images=images, preparation=preparation, config=config
        )
        made.append(Recorded(theatre))
        return made[-1]

    yield make
    for one in made:
        one.recorder.stop()


def record_images(recorded: Recorded, count: int) -> None:
    """Track images, the first with the requested state."""
    recorded.until(lambda: True in recorded.tracked.requests)
    recorded.theatre.answer_state()
    for number in range(count):
        recorded.track(number)
        recorded.until_recorded(number + 1)


def test_images_are_recorded_until_it_is_stopped_and_replayed_exactly(
    made_recorder: Callable[[], Recorded],
) -> None:
    recorded = made_recorder()
    record_images(recorded, 3)
    recorded.recorder.put_text(Topic.MARKS, '{"by": "Ben"}')
    status = recorded.recorder.stop("the test")
    assert (status.images, status.missing_images, status.problem, status.is_ended) == (3, 0, None, True)
    assert recorded.ends == [None]
    assert recorded.tracked.requests[-1] is False
    report = check_recording(recorded.theatre.path)
    assert report.is_whole
    assert report.is_equal
    assert report.images == 3
    topics = [message.topic for message in RecordingReader(recorded.theatre.path).messages()]
    assert {Topic.SESSION, Topic.STATE, Topic.ALARM_STATE, Topic.MARKS, Topic.NOTE} <= set(topics)


def images_on_disk(path: Path) -> int:
    """Number of images in the chunks that are complete."""
    try:
        return sum(message.topic is Topic.IMAGE for message in RecordingReader(path).messages())
    except RecordingError:
        return 0


def test_a_killed_process_is_reported_and_its_file_is_readable(
    made_recorder: Callable[[], Recorded],
) -> None:
    recorded = made_recorder()
    record_images(recorded, 2)
    pid = recorded.recorder.pid
    assert pid is not None
    recorded.until(lambda: images_on_disk(recorded.theatre.path) == 2)
    os.kill(pid, signal.SIGKILL)
    recorded.until(lambda: recorded.ends != [])
    (problem,) = recorded.ends
    assert problem is not None
    assert problem.code == "RECORDING_PROCESS_ENDED"
    assert "SIGKILL" in problem.message
    report = check_recording(recorded.theatre.path)
    assert not report.is_whole
    assert report.images == 2
    assert report.is_equal


def test_a_file_that_cannot_be_made_is_reported(
    made_recorder: Callable[[], Recorded], tmp_path: Path
) -> None:
    (tmp_path / "case.mcap").write_bytes(b"older")
    recorded = made_recorder()
    recorded.until(lambda: recorded.ends != [])
    (problem,) = recorded.ends
    assert problem is not None
    assert problem.code == "RECORDING_NOT_WRITTEN"
