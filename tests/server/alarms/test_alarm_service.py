"""All causes that raise or end an alarm, with a clock set by the test."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from typing import Any

import pytest

from server.alarms import AlarmService, ProcedureFacts
from server.alarms.entries import Entry, Line
from server.config import Config
from server.live import ProcessState, ProcessStatus, SourceState, SourceStatus
from tracker.navigation import Absent, AbsentReason, NavigationSnapshot
from tracker.navigation.alarms import AlarmSnapshot, Condition, Sound

RUNS = SourceStatus(name="made", state=SourceState.RUNNING)
WORKS = ProcessStatus(state=ProcessState.RUNNING)
SnapshotOf = Callable[..., NavigationSnapshot]


@dataclass(slots=True)
class Retained:
    """A log in memory."""

    lines: list[Line] = field(default_factory=list)
    is_well: bool = True
    free_mb: float | None = 1e5

    def append(self, entries: Sequence[Entry]) -> None:
        self.lines += [entry.line for entry in entries]

    def flush(self) -> None:
        pass

    def newest(self, count: int) -> list[Line]:
        return self.lines[-count:]


class Room:
    """A service, its clock and its images."""

    def __init__(self, snapshot_of: SnapshotOf) -> None:
        self.now_s = 1000.0
        self.slept_s = 0.0
        self.stored = Retained()
        self.service = AlarmService(
            Config(),
            log=self.stored,
            clock=lambda: self.now_s,
            wall_clock=lambda: datetime(2026, 11, 21, 9, 0, tzinfo=UTC),
            slept_s=lambda: self.slept_s,
        )
        self.snapshot_of = snapshot_of
        self.number = 0
        self.service.report_screen("theatre-1", armed=True)

    def image(self, **how: Any) -> AlarmSnapshot:  # noqa: ANN401  arguments of the snapshot
        """One image, captured 40 ms ago."""
        self.now_s += 1 / 30
        self.number += 1
        self.service.report_screen("theatre-1", armed=True)
        snapshot = self.snapshot_of(image_number=self.number, captured_at_s=self.now_s - 0.04, **how)
        return self.service.observe(snapshot, RUNS, WORKS)

    def images(self, seconds: float, **how: Any) -> AlarmSnapshot:  # noqa: ANN401  arguments of the snapshot
        for _ in range(round(seconds * 30)):
            picture = self.image(**how)
        return picture

    def silence(
        self, seconds: float, source: SourceStatus = RUNS, process: ProcessStatus = WORKS
    ) -> AlarmSnapshot:
        for _ in range(round(seconds * 20)):
            self.now_s += 0.05
            self.service.report_screen("theatre-1", armed=True)
            picture = self.service.observe(None, source, process)
        return picture


@pytest.fixture
def room(snapshot_of: SnapshotOf) -> Room:
    return Room(snapshot_of)


def conditions(picture: AlarmSnapshot) -> list[Condition]:
    return [alarm.condition for alarm in picture.alarms]


def test_too_deep_is_reported_with_its_image_and_kept_with_the_pose(room: Room) -> None:
    assert room.images(1.0).alarms == ()
    room.image(tip_in_vertebra_mm=(0.0, 0.0, 40.6))
    picture = room.image(tip_in_vertebra_mm=(0.0, 0.0, 40.6))
    assert conditions(picture) == [Condition.PAST_DEPTH]
    line = room.stored.lines[-1]
    assert {key: line[key] for key in ("at", "change", "condition", "priority", "limit", "unit")} == {
        "at": "2026-11-21T09:00:00.000Z",
        "change": "raised",
        "condition": "PAST_DEPTH",
        "priority": "high",
        "limit": 0.0,
        "unit": "mm",
    }
    assert line["value"] == pytest.approx(0.6, abs=0.2)
    assert line["image_number"] == room.number
    tools = line["tools"]
    assert isinstance(tools, dict)
    assert set(tools["drill"]) >= {"camera_from_tool", "depth_mm", "angle_deg"}


def test_a_drill_beside_the_patient_is_not_too_deep(room: Room) -> None:
    assert room.images(2.0, tip_in_vertebra_mm=(90.0, 0.0, 60.0)).alarms == ()


@pytest.mark.parametrize("missing", ["registered", "planned", "with_tool", "calibrated"])
def test_set_up_is_silent_whatever_comes_and_goes(room: Room, missing: str) -> None:
    room.images(1.0, **{missing: False}, seen=True)
    room.images(5.0, **{missing: False}, seen=False)
    picture = room.silence(5.0, source=replace(RUNS, state=SourceState.RECONNECTING))
    assert picture.alarms == ()


def test_a_drill_that_goes_out_of_sight_is_missed_after_its_time_and_put_away_after_long(room: Room) -> None:
    room.images(1.0)
    assert room.images(0.9, seen=False).alarms == ()
    assert conditions(room.images(0.3, seen=False)) == [Condition.DRILL_UNSEEN]
    room.now_s += 120.0
    assert room.images(1.1, seen=False).alarms == ()
    assert room.images(1.0).alarms == ()


def test_a_camera_that_stalls_and_one_that_is_gone_are_one_alarm_each(room: Room) -> None:
    room.images(1.0)
    assert room.silence(0.4).alarms == ()
    assert conditions(room.silence(0.3)) == [Condition.CAMERA_STALLED]
    room.images(2.0)
    gone = replace(RUNS, state=SourceState.RECONNECTING)
    assert conditions(room.silence(0.05, source=gone)) == [Condition.CAMERA_GONE]
    assert conditions(room.silence(10.0, source=gone)) == [Condition.CAMERA_GONE]
    assert room.images(2.0).alarms == ()
    dead = ProcessStatus(state=ProcessState.RESTARTING)
    assert conditions(room.silence(1.0, process=dead)) == [Condition.TRACKING_STOPPED]


@pytest.mark.parametrize(
    ("loss", "alarm"),
    [
        (
            {
                "process": ProcessStatus(state=ProcessState.RESTARTING),
                "source": replace(RUNS, state=SourceState.OPENING),
            },
            Condition.TRACKING_STOPPED,
        ),
        ({"source": replace(RUNS, state=SourceState.RECONNECTING)}, Condition.CAMERA_GONE),
        ({}, Condition.CAMERA_STALLED),
    ],
    ids=["tracking stopped", "camera gone", "camera stalled"],
)
def test_a_drill_that_was_not_seen_is_not_missed_while_nothing_is_tracked(
    room: Room, loss: dict[str, Any], alarm: Condition
) -> None:
    room.images(1.0)
    assert conditions(room.images(2.0, seen=False)) == [Condition.DRILL_UNSEEN]
    assert conditions(room.silence(3.0, **loss)) == [alarm]
    assert conditions(room.images(2.0, seen=False)) == [Condition.DRILL_UNSEEN]


def test_a_breach_of_depth_is_not_forgotten_when_the_camera_goes(room: Room) -> None:
    room.images(0.5, tip_in_vertebra_mm=(0.0, 0.0, 42.0))
    picture = room.silence(5.0)
    assert picture.sound is Sound.HIGH
    assert conditions(picture) == [Condition.PAST_DEPTH, Condition.CAMERA_STALLED]


def test_navigation_that_is_ended_in_the_plan_ends_its_alarms(room: Room) -> None:
    room.images(1.0)
    room.images(2.0, seen=False)
    assert room.images(2.0, planned=False).alarms == ()


def test_the_late_images_of_a_start_are_no_stalled_camera(room: Room, snapshot_of: SnapshotOf) -> None:
    late = snapshot_of(image_number=500, captured_at_s=room.now_s - 2.0)
    assert room.service.observe(late, RUNS, WORKS).alarms == ()
    assert room.images(1.0).alarms == ()
    late = snapshot_of(image_number=501, captured_at_s=room.now_s - 2.0)
    assert conditions(room.service.observe(late, RUNS, WORKS)) == [Condition.CAMERA_STALLED]


def test_a_patient_that_goes_out_of_sight_is_missed_with_or_without_the_drill(room: Room) -> None:
    for seen in (True, False):
        room.images(1.0)
        for number in range(int(1.2 * 30)):
            room.now_s += 1 / 30
            snapshot = room.snapshot_of(
                image_number=10_000 + number, captured_at_s=room.now_s - 0.04, seen=seen
            )
            gone = Absent(reason=AbsentReason.REFERENCE_UNSEEN)
            picture = room.service.observe(
                replace(snapshot, vertebra=gone, deviations={"drill": gone}), RUNS, WORKS
            )
        missed = {Condition.REFERENCE_UNSEEN} | (set() if seen else {Condition.DRILL_UNSEEN})
        assert set(conditions(picture)) == missed
        room.images(2.0)


def test_a_moved_camera_alarms_and_does_not_end_navigation(room: Room, snapshot_of: SnapshotOf) -> None:
    room.images(1.0)
    for number in range(1000, 1030):
        room.now_s += 1 / 30
        snapshot = snapshot_of(image_number=number, captured_at_s=room.now_s)
        moved = replace(snapshot, deviations={"drill": Absent(reason=AbsentReason.CAMERA_MOVED)})
        picture = room.service.observe(moved, RUNS, WORKS)
    assert conditions(picture) == [Condition.CAMERA_MOVED]
    assert picture.sound is Sound.HIGH


def test_a_theatre_without_sound_is_reported_once_navigation_is_on(snapshot_of: SnapshotOf) -> None:
    room = Room(snapshot_of)
    room.service.close_screen("theatre-1")
    room.service.report_screen = lambda *_args, **_keys: room.service.picture  # pyrefly: ignore[method-assign]  # mute
    assert room.images(4.0).alarms == ()
    assert conditions(room.images(3.0)) == [Condition.NO_ARMED_SCREEN]


def test_an_armed_screen_that_falls_silent_is_lost_and_one_that_is_closed_is_not(room: Room) -> None:
    room.images(1.0)
    room.service.report_screen("tablet-22", armed=True)
    room.service.report_screen("phone-333", armed=True)
    room.service.close_screen("phone-333")
    picture = room.images(7.0)
    assert conditions(picture) == [Condition.VIEWER_LOST]
    room.service.acknowledge([picture.alarms[0].number], by="nurse")
    assert room.images(2.0).alarms == ()


def test_the_log_tells_when_a_guiding_sound_was_on_and_who_heard_it(room: Room) -> None:
    def reported() -> list[tuple[object, object, object]]:
        lines = [line for line in room.stored.lines if "screen" in line]
        return [(line["change"], line["screen"], line["by"]) for line in lines]

    for _ in range(3):
        room.service.report_screen("tablet-22", armed=True, guiding_by="M. Ito")
    assert reported() == [("guiding_on", "tablet-22", "M. Ito")]
    room.service.report_screen("tablet-22", armed=True)
    assert reported()[1:] == [("guiding_off", "tablet-22", "M. Ito")]
    # A screen that is closed, or of which nothing is heard any more, has none.
    room.service.report_screen("tablet-22", armed=False, guiding_by="M. Ito")
    room.service.report_screen("phone-333", armed=False, guiding_by="Dr Sato")
    room.service.close_screen("phone-333")
    room.images(7.0)
    assert {(change, who) for change, _, who in reported()[4:]} == {
        ("guiding_off", "Dr Sato"),
        ("guiding_off", "M. Ito"),
    }


def test_what_people_do_is_kept_with_their_name(room: Room) -> None:
    room.service.request_hold(by="Dr Sato")
    number = room.service.picture.alarms[0].number
    room.service.pause(30.0, by="nurse")
    room.service.resume(by="nurse")
    room.service.acknowledge([number], by="surgeon")
    room.service.release_hold(by="Dr Sato")
    assert [(line["change"], line.get("by")) for line in room.stored.lines] == [
        ("raised", "Dr Sato"),
        ("paused", "nurse"),
        ("resumed", "nurse"),
        ("acknowledged", "surgeon"),
        ("cleared", "Dr Sato"),
    ]


def test_facts_of_the_procedure_are_evaluated(room: Room) -> None:
    room.images(1.0)
    room.service.set_facts(ProcedureFacts(registration_current=False, checked_at_s=room.now_s - 1801.0))
    assert conditions(room.image()) == [Condition.REGISTRATION_OUT_OF_DATE, Condition.CHECK_DUE]
    room.service.set_facts(ProcedureFacts(navigating=False))
    assert room.images(2.0).alarms == ()


def test_a_check_becomes_due_while_the_computer_sleeps(room: Room) -> None:
    room.slept_s = 5000.0
    room.images(1.0)
    room.service.set_facts(ProcedureFacts(checked_at_s=room.now_s - 60.0))
    assert conditions(room.image()) == []
    room.slept_s += 1750.0
    assert conditions(room.image()) == [Condition.CHECK_DUE]


def test_a_log_or_disk_that_fails_is_an_alarm_at_any_time(room: Room) -> None:
    room.stored.is_well, room.stored.free_mb = False, 500.0
    assert set(conditions(room.service.picture)) == {Condition.RECORDING_STOPPED, Condition.DISK_NEARLY_FULL}


def test_a_change_that_no_image_brought_is_reported(room: Room) -> None:
    reported: list[int] = []
    room.service.on_change = lambda: reported.append(1)
    room.service.request_hold(by="Dr Sato")
    room.service.pause(10.0, by="x")
    room.service.acknowledge([1], by="x")
    assert len(reported) == 3


def test_a_registration_that_goes_out_of_date_under_the_hand_is_an_alarm_though_the_numbers_are_gone(
    room: Room,
) -> None:
    room.images(1.0)
    room.service.set_facts(ProcedureFacts(registration_current=False))
    picture = room.images(2.0, registered=False)
    assert Condition.REGISTRATION_OUT_OF_DATE in conditions(picture)
    # A new registration ends it; what was never navigated raises nothing.
    room.service.set_facts(ProcedureFacts())
    room.service.acknowledge([one.number for one in picture.alarms], by="ito")
    assert room.images(2.0, registered=False).alarms == ()
    room.service.set_facts(ProcedureFacts(registration_current=False))
    assert room.images(2.0, registered=False).alarms == ()
