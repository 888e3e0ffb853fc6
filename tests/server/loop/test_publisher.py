"""From reports to instants, with time and process controlled by the test."""

import pytest

from server.alarms import without_alarms
from server.live import Problem, ProcessState, ProcessStatus, SourceState
from server.loop.publisher import AlarmCheck, Image, PictureEncoder, Publisher
from server.loop.report import Report, ReportPacker
from server.loop.ring import ImageRing
from server.loop.shared_status import SharedStatus
from tests.server.loop.fake_workers import Seen, made_image, made_snapshot, made_source
from tracker.navigation import NavigationSnapshot
from tracker.navigation.alarms import AlarmSnapshot

RUNNING = ProcessStatus(state=ProcessState.STARTING)
DEAD = ProcessStatus(
    state=ProcessState.RESTARTING, restarts=1, problem=Problem(code="DEAD", message="m", remedy="r")
)


class Stage:
    """A publisher on a board with a ring, and what it has published."""

    def __init__(
        self, picture: PictureEncoder | None = None, check_alarms: AlarmCheck = without_alarms
    ) -> None:
        self.hub = Seen()
        self.status = SharedStatus("made")
        self.ring = ImageRing(image_bytes=100_000)
        self.packer = ReportPacker()
        self.tracked = 0
        self.publisher = Publisher(
            status=self.status,
            hub=self.hub,
            picture=picture
            or PictureEncoder(
                draw=lambda image, _snapshot, _alarms: image + 1, encode=lambda image: image.tobytes()[:2]
            ),
            check_alarms=check_alarms,
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


def test_picture_and_snapshot_of_an_instant_belong_together() -> None:
    stage = Stage()
    stage.report_image(5)
    stage.publisher.publish_newest()
    instant = stage.hub.instants[-1]
    assert instant.snapshot is not None
    assert instant.snapshot.image_number == 5
    assert instant.jpeg == bytes([6, 6])
    assert instant.image is not None
    assert instant.image[0, 0, 0] == 5, "without the overlay"
    assert set(instant.server_ms) == {"overlay", "encode"}
    assert instant.process.state is ProcessState.RUNNING
    assert instant.source == made_source(6)


def test_nothing_is_drawn_for_nobody() -> None:
    drawn: list[Image] = []

    def draw(image: Image, _snapshot: NavigationSnapshot, _alarms: AlarmSnapshot) -> Image:
        drawn.append(image)
        return image

    watched = False
    stage = Stage(PictureEncoder(draw=draw, encode=lambda _: b"jpeg", is_watched=lambda: watched))
    stage.report_image(0)
    stage.publisher.publish_newest()
    unwatched = stage.hub.instants[-1]
    assert (drawn, unwatched.jpeg, unwatched.drawn, unwatched.server_ms) == ([], b"", None, {})
    assert unwatched.has_picture, "whoever comes now still gets this image"
    watched = True
    stage.report_image(1)
    stage.publisher.publish_newest()
    assert (len(drawn), stage.hub.instants[-1].jpeg) == (1, b"jpeg")


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
    assert instant.jpeg == b""
    assert instant.process == DEAD
    assert instant.source.state is SourceState.OPENING
    assert instant.source.images == 1


def test_a_process_that_dies_while_its_picture_is_drawn_is_not_shown_any_more() -> None:
    def draw(image: Image, snapshot: NavigationSnapshot, _alarms: AlarmSnapshot) -> Image:
        del snapshot
        stage.status.post(DEAD, None)
        return image

    stage = Stage(PictureEncoder(draw=draw, encode=lambda _: b"jpeg"))
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


def test_a_failing_overlay_is_told_and_shows_nothing() -> None:
    def draw(image: Image, snapshot: NavigationSnapshot, _alarms: AlarmSnapshot) -> Image:
        raise ZeroDivisionError(f"a bug in image {snapshot.image_number} of {image.shape}")

    stage = Stage(PictureEncoder(draw=draw, encode=lambda _: b"jpeg"))
    stage.report_image(0)
    stage.publisher.publish_newest()
    instant = stage.hub.instants[-1]
    assert (instant.snapshot, instant.jpeg) == (None, b"")
    assert instant.process.problem is not None
    assert instant.process.problem.code == "OVERLAY_FAILED"
