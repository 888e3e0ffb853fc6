"""From reports to instants, with time and process controlled by the test."""

from collections.abc import Callable

import pytest

from server.alarms import without_alarms
from server.live import Problem, ProcessState, ProcessStatus, SourceState, SourceStatus
from server.loop.publisher import AlarmCheck, Publisher
from server.loop.report import Report, ReportPacker
from server.loop.ring import ImageRing
from server.loop.shared_status import SharedStatus
from tests.server.loop.fake_workers import Seen, made_image, made_snapshot, made_source
from tracker.navigation import NavigationSnapshot
from tracker.navigation.alarms import QUIET, AlarmSnapshot

RUNNING = ProcessStatus(state=ProcessState.STARTING)
DEAD = ProcessStatus(
    state=ProcessState.RESTARTING, restarts=1, problem=Problem(code="DEAD", message="m", remedy="r")
)


class Stage:
    """A publisher on a board with a ring, and what it has published."""

    def __init__(
        self,
        check_alarms: AlarmCheck = without_alarms,
        picture_problem: Callable[[], Problem | None] = lambda: None,
    ) -> None:
        self.hub = Seen()
        self.status = SharedStatus("made")
        self.ring = ImageRing(image_bytes=100_000)
        self.packer = ReportPacker()
        self.tracked = 0
        self.publisher = Publisher(
            status=self.status,
            hub=self.hub,
            check_alarms=check_alarms,
            picture_problem=picture_problem,
        )
        self.status.post(RUNNING, self.ring)

    def report_image(self, number: int) -> None:
        self.tracked += 1
        report = Report(
            source=made_source(number + 1), snapshot=made_snapshot(number), tracked_images=self.tracked
        )
        self.ring.write(self.packer.pack(report), made_image(number))

    def later(self, monkeypatch: pytest.MonkeyPatch, by_s: float) -> None:
        now_s = self.publisher._last_at_s + by_s
        monkeypatch.setattr("server.loop.publisher.time.monotonic", lambda: now_s)


def test_image_and_snapshot_of_an_instant_belong_together() -> None:
    stage = Stage()
    stage.report_image(5)
    stage.publisher.publish_newest()
    instant = stage.hub.instants[-1]
    assert instant.snapshot is not None
    assert instant.snapshot.image_number == 5
    assert instant.image is not None
    assert instant.image[0, 0, 0] == 5, "without the overlay"
    assert instant.process.state is ProcessState.RUNNING
    assert instant.source == made_source(6)


def test_the_newest_wins_and_what_was_dropped_is_counted() -> None:
    stage = Stage()
    for number in range(4):
        stage.report_image(number)
    stage.publisher.publish_newest()
    stage.report_image(4)
    stage.publisher.publish_newest()
    shown = [instant.snapshot.image_number for instant in stage.hub.instants if instant.snapshot]
    assert shown == [3, 4]
    assert stage.hub.instants[-1].process.dropped_images == 3


def test_a_dead_process_takes_its_picture_with_it_at_once() -> None:
    stage = Stage()
    stage.report_image(0)
    stage.publisher.publish_newest()
    stage.report_image(1)
    stage.status.post(DEAD, None)
    stage.publisher.publish_newest()
    instant = stage.hub.instants[-1]
    assert instant.snapshot is None
    assert instant.image is None
    assert instant.process == DEAD
    assert instant.source.state is SourceState.OPENING
    assert instant.source.images == 1


def test_a_process_that_dies_while_its_image_is_looked_at_is_not_shown_any_more() -> None:
    def look(snapshot: NavigationSnapshot | None, _: SourceStatus, _process: ProcessStatus) -> AlarmSnapshot:
        if snapshot is not None:
            stage.status.post(DEAD, None)
        return QUIET

    stage = Stage(check_alarms=look)
    stage.report_image(0)
    stage.publisher.publish_newest()
    assert [instant.snapshot for instant in stage.hub.instants] == [None]


def test_a_sign_of_life_carries_no_old_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage()
    stage.report_image(0)
    stage.publisher.publish_newest()
    stage.later(monkeypatch, 0.5)
    stage.publisher.publish_newest()
    assert len(stage.hub.instants) == 1
    stage.later(monkeypatch, 0.95)
    stage.publisher.publish_newest()
    assert len(stage.hub.instants) == 2
    assert stage.hub.instants[-1].snapshot is None
    assert stage.hub.instants[-1].process.state is ProcessState.RUNNING


def test_sequences_grow_by_one_over_images_deaths_and_signs_of_life() -> None:
    stage = Stage()
    stage.report_image(0)
    stage.publisher.publish_newest()
    stage.status.post(DEAD, None)
    stage.publisher.publish_newest()
    stage.ring = ImageRing(image_bytes=100_000)
    stage.status.post(RUNNING, stage.ring)
    stage.publisher.publish_newest()
    stage.report_image(1)
    stage.publisher.publish_newest()
    assert [instant.sequence for instant in stage.hub.instants] == list(range(len(stage.hub.instants)))
    assert stage.hub.instants[-1].snapshot is not None


def test_a_picture_that_cannot_be_drawn_is_reported_and_the_figures_go_on() -> None:
    failed = Problem(code="OVERLAY_FAILED", message="m", remedy="r")
    stage = Stage(picture_problem=lambda: failed)
    stage.report_image(0)
    stage.publisher.publish_newest()
    instant = stage.hub.instants[-1]
    assert instant.snapshot is not None
    assert instant.process.problem == failed
    stage.status.post(DEAD, None)
    stage.publisher.publish_newest()
    assert stage.hub.instants[-1].process.problem == DEAD.problem, "what is worse is said"
