"""Sinks: each receives the newest message; a sink's fault is reported and delays nobody."""

import json
import os
import sys
import time
from collections.abc import Callable, Iterator
from math import inf
from pathlib import Path

import pytest
from structlog.testing import capture_logs

from server.config_file import load_config
from server.errors import ConfigError
from server.live import Instant, LiveHub, ProcessState, ProcessStatus, SourceState, SourceStatus
from server.logs import LogSettings
from server.loop.forks import forking_context
from server.plugins import SINKS, plugin_names
from server.sinks import Sink, Sinks
from server.stream.messages import live_message

PATIENCE_S = 120.0
SETTINGS = LogSettings(as_json=True)
# A sink writes what it receives, and behaves as the message's source name orders.
MODULE = """
import os
from pathlib import Path

FOLDER = Path({folder!r})
(FOLDER / "imported").touch()


class Sink:
    def receive(self, text):
        with (FOLDER / "received").open("a") as file:
            file.write(text + "\\n")
        if '"name":"raise"' in text:
            raise ValueError("the far side is gone")
        if '"name":"long"' in text:
            raise ValueError("begins " + 10_000 * "and goes on ")
        if '"name":"exit"' in text:
            os._exit(3)
        if '"name":"wait"' in text:
            with (FOLDER / "gate").open() as gate:
                gate.read()

    def close(self):
        (FOLDER / "closed").touch()


def broken():
    raise OSError("no such printer")
"""
ENTRY_POINTS = """[coaxial.sinks]
file = example_sink:Sink
broken = example_sink:broken
absent = no_such_module:Sink
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder of a package with sinks, on the import path of this process and its children."""
    (tmp_path / "example_sink.py").write_text(MODULE.format(folder=str(tmp_path)))
    metadata = tmp_path / "example_sink-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: example-sink\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(ENTRY_POINTS)
    monkeypatch.syspath_prepend(str(tmp_path))
    return tmp_path


class Theatre:
    """A hub, and a sink that follows it."""

    def __init__(self, name: str, **times_s: float) -> None:
        forking_context()
        self.hub = LiveHub()
        self.sequence = 0
        self.sink = Sink(name, self.hub, write=self.text, settings=SETTINGS, **times_s)  # pyrefly: ignore[bad-argument-type]  # times only
        self.sink.start()

    @staticmethod
    def text(instant: Instant) -> str:
        return live_message(instant, now_s=0.0).model_dump_json()

    def publish(self, source: str = "camera") -> Instant:
        self.sequence += 1
        instant = Instant(
            sequence=self.sequence,
            source=SourceStatus(name=source, state=SourceState.OPENING),
            process=ProcessStatus(state=ProcessState.STARTING),
        )
        self.hub.publish(instant)
        return instant

    def problem(self) -> str | None:
        problem = self.sink.status.problem
        return None if problem is None else problem.code

    def until(self, true: Callable[[], object]) -> None:
        deadline_s = time.monotonic() + PATIENCE_S
        while not true():
            assert time.monotonic() < deadline_s, f"it did not become true: {self.sink.status}"
            time.sleep(0.005)


@pytest.fixture
def theatre() -> Iterator[Callable[..., Theatre]]:
    made: list[Theatre] = []

    def make(name: str = "file", **times_s: float) -> Theatre:
        made.append(Theatre(name, **times_s))
        return made[-1]

    yield make
    for one in made:
        one.sink.stop()


def received(folder: Path) -> list[str]:
    file = folder / "received"
    return file.read_text().splitlines() if file.exists() else []


def test_a_sink_receives_the_message_of_the_sockets(folder: Path, theatre: Callable[..., Theatre]) -> None:
    running = theatre()
    instant = running.publish()
    running.until(lambda: received(folder))
    assert received(folder) == [Theatre.text(instant)]
    assert running.sink.status.problem is None
    running.sink.stop()
    assert (folder / "closed").exists()


def test_a_slow_sink_is_reported_skips_to_the_newest_and_delays_no_other(
    folder: Path, theatre: Callable[..., Theatre]
) -> None:
    os.mkfifo(folder / "gate")
    running = theatre(slow_after_s=0.05)
    running.publish("wait")
    running.until(lambda: received(folder))
    for _ in range(100):
        running.publish()
    running.until(lambda: running.problem() == "SINK_SLOW")
    (folder / "gate").write_text("go on")
    running.until(lambda: len(received(folder)) == 2)
    assert [json.loads(text)["sequence"] for text in received(folder)] == [1, 101]
    running.until(lambda: running.problem() is None)
    # It counts a message after it has sent it.
    running.until(lambda: (running.sink.status.messages, running.sink.status.skipped) == (2, 99))


def test_a_sink_that_never_answers_is_stopped(folder: Path, theatre: Callable[..., Theatre]) -> None:
    os.mkfifo(folder / "gate")
    running = theatre()
    running.publish("wait")
    running.until(lambda: received(folder))
    running.sink.stop()
    assert not running.sink.is_alive


def test_sinks_that_were_not_started_can_be_stopped() -> None:
    # As where the start of the server fails.
    Sinks(["file"], LiveHub(), SETTINGS).stop()


def test_a_sink_that_raises_is_named_and_receives_the_next_message(
    folder: Path, theatre: Callable[..., Theatre]
) -> None:
    running = theatre()
    running.publish("raise")
    running.until(lambda: running.problem() == "SINK_FAILED")
    problem = running.sink.status.problem
    assert problem is not None
    assert "ValueError: the far side is gone" in problem.message
    running.publish()
    running.until(lambda: running.problem() is None)
    assert len(received(folder)) == 2


def test_a_sink_that_fails_at_every_other_image_does_not_fill_the_log(
    folder: Path, theatre: Callable[..., Theatre], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("server.sinks.sink.LOG_AGAIN_AFTER_S", inf)
    running = theatre()
    with capture_logs() as logged:
        for _ in range(2):
            running.publish("raise")
            running.until(lambda: running.problem() == "SINK_FAILED")
            running.publish()
            running.until(lambda: running.problem() is None)
    assert len(received(folder)) == 4
    assert [one.get("code") for one in logged] == ["SINK_FAILED"]


def test_the_words_of_a_failure_are_shortened(folder: Path, theatre: Callable[..., Theatre]) -> None:
    running = theatre()
    running.publish("long")
    running.until(lambda: running.problem() == "SINK_FAILED")
    problem = running.sink.status.problem
    assert problem is not None
    assert "ValueError: begins" in problem.message
    assert len(problem.message) < 500
    assert received(folder)


def test_a_sink_whose_process_ends_is_named_and_started_again(
    folder: Path, theatre: Callable[..., Theatre]
) -> None:
    running = theatre(restart_after_s=0.0)
    running.publish("exit")
    running.until(lambda: running.problem() == "SINK_ENDED")
    running.publish()
    running.until(lambda: len(received(folder)) == 2)
    running.until(lambda: running.problem() is None)


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("broken", "no such printer"),
        ("absent", "no_such_module"),
        ("other", "installed: absent, broken, file"),
    ],
)
@pytest.mark.usefixtures("folder")
def test_a_sink_that_cannot_be_opened_is_named(
    theatre: Callable[..., Theatre], name: str, reason: str
) -> None:
    running = theatre(name)
    running.until(lambda: running.problem() == "SINK_NOT_LOADED")
    problem = running.sink.status.problem
    assert problem is not None
    assert reason in problem.message


def test_what_is_installed_and_not_named_is_not_imported(folder: Path, tmp_path: Path) -> None:
    assert plugin_names(SINKS) == ["absent", "broken", "file"]
    sinks = Sinks(load_config(environment={}).plugins.sinks, LiveHub(), SETTINGS)
    sinks.start()
    sinks.stop()
    settings = tmp_path / "config.yaml"
    settings.write_text("plugins: {sinks: [file]}")
    assert load_config(settings, environment={}).plugins.sinks == ["file"]
    assert not (folder / "imported").exists()
    assert "example_sink" not in sys.modules


@pytest.mark.usefixtures("folder")
def test_a_plugin_that_is_not_installed_stops_the_start(tmp_path: Path) -> None:
    settings = tmp_path / "config.yaml"
    settings.write_text("plugins: {sinks: [fiel]}\ncamera: {source: 'plugin:xray:7'}")
    with pytest.raises(ConfigError) as stopped:
        load_config(settings, environment={})
    assert "'fiel', allowed: absent, broken, file" in stopped.value.message
    assert "'xray', allowed: none" in stopped.value.message
