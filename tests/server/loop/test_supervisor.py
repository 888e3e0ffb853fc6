"""The tracking process is killed, hangs, or fails repeatedly; nothing of it remains."""

import os
import signal
from collections.abc import Callable, Iterator

import pytest

from server.config import Config
from server.live import Instant, Problem, ProcessState, ProcessStatus
from server.logs import LogSettings
from server.loop.compiling import Progress
from server.loop.processor_wait import ProcessorWait
from server.loop.publisher import Publisher
from server.loop.report import Report, ReportPacker
from server.loop.ring import ImageRing
from server.loop.shared_status import SharedStatus
from server.loop.supervisor import Supervisor, Target, WatchdogSettings
from server.loop.worker import WorkerOrder
from server.setup import CaseSetup, nominal_camera
from server.stream.messages import process_message
from tests.server.loop.fake_workers import (
    Seen,
    echoing_worker,
    failing_worker,
    made_image,
    made_snapshot,
    made_source,
    silent_worker,
    steady_worker,
)

COMPILED = Progress(done=3, total=3)


class AlwaysWaiting(ProcessorWait):
    """A process that gets no processor, until `is_served`."""

    is_served = False

    def since_last(self, elapsed_s: float) -> float:
        return 0.0 if self.is_served else elapsed_s


class Stage:
    """Supervisor and publisher around a process that the test chooses."""

    def __init__(
        self,
        target: Target,
        watchdog: WatchdogSettings,
        compiled: Callable[[], Progress] = lambda: COMPILED,
        processor_wait: Callable[[int], ProcessorWait] = ProcessorWait,
    ) -> None:
        self.hub = Seen()
        # Stopped unless a test advances it: start times of processes are not tested.
        self.now_s = 0.0
        status = SharedStatus("made")
        order = WorkerOrder(config=Config(), log=LogSettings(as_json=True))
        self.supervisor = Supervisor(
            order=order,
            status=status,
            watchdog=watchdog,
            target=target,
            clock=lambda: self.now_s,
            compiled=compiled,
            processor_wait=processor_wait,
        )
        self.publisher = Publisher(status=status, hub=self.hub)
        self.supervisor.start()
        self.publisher.start()

    def end(self) -> None:
        self.publisher.stop()
        self.supervisor.stop()


@pytest.fixture
def staged() -> Iterator[Callable[[Target, WatchdogSettings], Stage]]:
    stages = []

    def make(target: Target, watchdog: WatchdogSettings) -> Stage:
        stages.append(Stage(target, watchdog))
        return stages[-1]

    yield make
    for stage in stages:
        stage.end()


def shows_image(instant: Instant) -> bool:
    return instant.snapshot is not None


def is_compiling(instant: Instant) -> bool:
    problem = instant.process.problem
    return problem is not None and problem.code == "TRACKER_COMPILING"


def is_dead(instant: Instant) -> bool:
    return instant.process.state is ProcessState.RESTARTING


def number(instant: Instant) -> int:
    assert instant.snapshot is not None
    return instant.snapshot.image_number


def exists(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def test_a_killed_process_is_reported_at_once_and_replaced(
    staged: Callable[[Target, WatchdogSettings], Stage],
) -> None:
    stage = staged(steady_worker, WatchdogSettings())
    before = stage.hub.until(shows_image)
    pid = stage.supervisor.pid
    assert pid is not None
    os.kill(pid, signal.SIGKILL)
    dead = stage.hub.until(is_dead)
    assert dead.snapshot is None
    assert dead.image is None
    assert dead.process.problem is not None
    assert dead.process.problem.message == "the tracking process ended"
    assert dead.process.problem.context == {
        "process_problem": "ended",
        "pid": pid,
        "how": "by signal 9 (SIGKILL)",
    }
    again = stage.hub.until(shows_image, after=dead.sequence)
    assert again.process.restarts == 1
    assert again.process.problem is None
    assert number(again) > number(before)
    sequences = [instant.sequence for instant in stage.hub.instants]
    assert sequences == list(range(len(sequences)))
    # From its death to the first new image there is no picture.
    between = stage.hub.instants[dead.sequence : again.sequence]
    assert all(instant.snapshot is None for instant in between)


def test_a_process_that_hangs_is_killed_and_replaced(
    staged: Callable[[Target, WatchdogSettings], Stage],
) -> None:
    stage = staged(silent_worker, WatchdogSettings(silent_after_s=0.3, poll_interval_s=0.05))
    stage.hub.until(shows_image)
    pid = stage.supervisor.pid
    assert pid is not None
    dead = stage.hub.until(is_dead)
    assert dead.process.problem is not None
    assert "limit 0.3 s" in dead.process.problem.message
    stage.hub.until(shows_image, after=dead.sequence)
    assert not exists(pid)


def test_a_process_that_waits_for_a_processor_is_named_and_not_killed() -> None:
    waits: list[AlwaysWaiting] = []

    def always_waiting(pid: int) -> ProcessorWait:
        waits.append(AlwaysWaiting(pid))
        return waits[-1]

    watchdog = WatchdogSettings(silent_after_s=0.3, starved_after_s=0.1, poll_interval_s=0.02)
    stage = Stage(silent_worker, watchdog, processor_wait=always_waiting)
    try:
        stage.hub.until(shows_image)
        pid = stage.supervisor.pid

        def is_starved_beyond_the_limit(instant: Instant) -> bool:
            problem = instant.process.problem
            if problem is None or problem.code != "TRACKING_STARVED":
                return False
            return float(str(problem.context["silent_s"])) > 2 * watchdog.silent_after_s

        starved = stage.hub.until(is_starved_beyond_the_limit)
        assert starved.process.state is ProcessState.RUNNING
        assert starved.is_stopped, "no figures are shown meanwhile"
        assert stage.supervisor.pid == pid
        waits[0].is_served = True
        dead = stage.hub.until(is_dead)
        assert dead.process.problem is not None
        assert dead.process.problem.code == "TRACKING_PROCESS_ENDED"
    finally:
        stage.end()


def test_the_first_image_after_a_starvation_ends_its_problem_and_stays_shown(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("server.loop.publisher.HEARTBEAT_S", 600.0)
    status = SharedStatus("made")
    hub = Seen()
    publisher = Publisher(status=status, hub=hub)
    ring = ImageRing()
    try:
        packer = ReportPacker()
        status.post(ProcessStatus(state=ProcessState.STARTING), ring)
        for number in (0, 1):
            report = Report(
                source=made_source(number + 1), snapshot=made_snapshot(number), tracked_images=number + 1
            )
            ring.write(packer.pack(report), made_image(number))
            publisher.publish_newest()
            shown = hub.instants[-1]
            assert shown.snapshot is not None
            assert shown.process.problem is None
            publisher.publish_newest()
            assert hub.instants[-1] is shown
            if number == 0:
                status.set_problem(Problem(code="TRACKING_STARVED", message="starved", remedy="wait"))
                publisher.publish_newest()
                assert hub.instants[-1].is_stopped
    finally:
        ring.close()


def test_a_process_that_always_fails_is_given_up_and_tried_again_later(
    staged: Callable[[Target, WatchdogSettings], Stage],
) -> None:
    stage = staged(failing_worker, WatchdogSettings(restarts=2, window_s=60.0, poll_interval_s=0.01))
    given_up = stage.hub.until(lambda instant: instant.process.state is ProcessState.GIVEN_UP)
    problem = given_up.process.problem
    assert given_up.process.restarts == 2
    assert problem is not None
    assert problem.code == "TRACKING_GIVEN_UP"
    assert "2 times in 60 s" in problem.message
    assert problem.message.endswith("the last time: the tracking process ended")
    assert problem.remedy
    shown = process_message(given_up.process).problem
    assert shown is not None
    assert shown.message.de == (
        "der Tracking-Prozess wurde 2-mal in 60 s neu gestartet und endete wieder; "
        "zuletzt: der Tracking-Prozess endete"
    )
    assert shown.remedy.de.startswith("Den Grund im Protokoll des Servers suchen.")
    stage.now_s = 60.0
    later = stage.hub.until(lambda instant: instant.process.restarts > 2, after=given_up.sequence)
    assert later.snapshot is None


def test_stopping_ends_the_process(staged: Callable[[Target, WatchdogSettings], Stage]) -> None:
    stage = staged(steady_worker, WatchdogSettings())
    stage.hub.until(shows_image)
    pid = stage.supervisor.pid
    assert pid is not None
    stage.end()
    assert not exists(pid)
    assert stage.supervisor.pid is None


def width(instant: Instant) -> int:
    return 0 if instant.snapshot is None else instant.snapshot.setup.camera.size_wh_px[0]


def test_what_the_open_case_knows_reaches_the_process_and_the_one_after_it(
    staged: Callable[[Target, WatchdogSettings], Stage],
) -> None:
    stage = staged(echoing_worker, WatchdogSettings(restarts=5))
    stage.hub.until(lambda instant: width(instant) == 64)
    stage.supervisor.adopt(CaseSetup(camera=nominal_camera((320, 240))))
    stage.hub.until(lambda instant: width(instant) == 320)
    seen = len(stage.hub.instants)
    assert stage.supervisor.pid is not None
    os.kill(stage.supervisor.pid, signal.SIGKILL)
    dead = stage.hub.until(is_dead, after=seen)
    after = stage.hub.until(shows_image, after=stage.hub.instants.index(dead))
    assert width(after) == 320


def test_while_the_tracker_is_compiled_its_progress_is_shown_and_then_it_starts() -> None:
    seen = [Progress(done=1, total=3), Progress(done=2, total=3)]
    stage = Stage(
        steady_worker, WatchdogSettings(poll_interval_s=0.01), lambda: seen.pop(0) if seen else COMPILED
    )
    try:
        stage.hub.until(shows_image)
        reported = [one for one in stage.hub.instants if is_compiling(one)]
        assert reported, "somebody who opens the page meanwhile is told"
        assert all(one.process.state is ProcessState.STARTING and one.snapshot is None for one in reported)
        assert not is_compiling(stage.hub.instants[-1])
    finally:
        stage.end()


def test_compiling_that_is_stuck_is_not_waited_for() -> None:
    stage: list[Stage] = []

    def stuck() -> Progress:
        if stage:
            stage[0].now_s += 1.0
        return Progress(done=1, total=3)

    stage.append(Stage(steady_worker, WatchdogSettings(poll_interval_s=0.01, compiles_within_s=5.0), stuck))
    try:
        stage[0].hub.until(shows_image)
        assert stage[0].now_s > 5.0, "it was waited for as long as that"
    finally:
        stage[0].end()
