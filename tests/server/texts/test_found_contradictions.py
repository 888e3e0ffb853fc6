"""Contradictions found by earlier attacks, each as the moment in which it appeared."""

from collections.abc import Mapping
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from server.alarms import AlarmService
from server.alarms.service import alarm_limits
from server.config import Config
from server.live import ProcessState, ProcessStatus, SourceState, SourceStatus
from server.texts import Headline, alarm_text, headline_of
from tests.server.texts.drilled_rod import CAMERA_FROM_VERTEBRA, UNSEEN, concluded, seen_at, setup_of
from tests.tracker.navigation.alarms.alarm_stream import Stream
from tests.tracker.navigation.assessed import drill, drill_reference
from tests.tracker.navigation.bones import ROD_CHANNEL
from tracker.geometry import Rigid, Tool, Vertebra, rotation_between
from tracker.navigation import (
    Absent,
    AbsentReason,
    Assessment,
    Direction,
    FigureName,
    NavigationSnapshot,
    Verdict,
    bullseye_view,
)
from tracker.navigation.alarms import (
    NOT_KNOWN,
    Alarm,
    AlarmSnapshot,
    AlarmState,
    Condition,
    Presence,
)
from tracker.navigation.directions import Wall, channel_directions
from tracker.plan.pedicle import Side

RUNS = SourceStatus(name="rehearsal", state=SourceState.RUNNING)
WORKS = ProcessStatus(state=ProcessState.RUNNING)
DIED = ProcessStatus(state=ProcessState.RESTARTING)
PATH = (25.0, 0.1, 0.0, 0.2, 0.1, 1.0)
BREACH = (29.0, 4.5, 0.0, 0.0, 0.0, 1.0)
RISKY = (28.0, 0.0, 2.2, 0.0, 0.0, 6.0)
NEAR = (29.0, 2.4, 0.0, 0.0, 0.0, 0.5)


class Theatre:
    """One or two drills in the rod, ten images a second."""

    def __init__(self, *names: str) -> None:
        self.setup = setup_of(names or ("drill",))
        self.at_s, self.number = 100.0, 0
        self.service = AlarmService(
            Config(), clock=lambda: self.at_s, wall_clock=lambda: datetime.fromtimestamp(self.at_s, tz=UTC)
        )
        self.snapshot: NavigationSnapshot | None = None

    def images(
        self, seconds: float, where: Mapping[str, tuple[float, ...]], **changes: object
    ) -> AlarmSnapshot:
        """Tools that are not given are unseen."""
        setup = replace(self.setup, **changes)  # pyrefly: ignore[bad-argument-type]  # any field of it
        for _ in range(round(seconds * 10)):
            self.at_s += 0.1
            self.number += 1
            sightings = {
                name: seen_at(where[name], tool) if name in where else UNSEEN
                for name, tool in setup.tools.items()
            }
            self.snapshot = concluded(
                setup, drill_reference(), sightings, number=self.number, captured_at_s=self.at_s - 0.01
            )
            self.service.observe(self.snapshot, RUNS, WORKS)
        return self.service.picture

    @property
    def headline(self) -> Headline:
        return headline_of(self.snapshot, self.service.picture)

    def alarm(self, condition: Condition) -> Alarm:
        return next(one for one in self.service.picture.alarms if one.condition is condition)

    def sentence(self, condition: Condition) -> str:
        return alarm_text(self.alarm(condition), unix_offset_s=0.0).sentence["en"]


@pytest.mark.parametrize("side", ["left", "right"])
def test_medial_is_medial_beside_a_channel_that_runs_straight_forwards(side: Side) -> None:
    across = channel_directions(ROD_CHANNEL, side)
    for depth_mm, verdict in ((-10.0, Verdict.CORRECT_ENTRY), (29.0, Verdict.NEAR_WALL)):
        theatre = Theatre()
        placed: Rigid[Vertebra, Tool] = Rigid(
            rotation=rotation_between([0.0, 0.0, 1.0], across.axis),
            translation_mm=across.entry_mm + depth_mm * across.axis + 2.4 * across.medial,
        )
        seen = replace(
            seen_at(PATH, drill()),
            camera_from_marker=CAMERA_FROM_VERTEBRA @ placed @ drill().marker_from_tool.inverse,
        )
        setup = replace(theatre.setup, side=side)
        snapshot = concluded(
            setup, replace(drill_reference(), side=side), {"drill": seen}, number=1, captured_at_s=0.0
        )
        assessment = snapshot.assessments["drill"]
        assert isinstance(assessment, Assessment)
        assert assessment.verdict is verdict
        assert [one.towards for one in assessment.corrections] == [Direction.LATERAL]
        assert assessment.wall in (None, Wall.MEDIAL)
        along = bullseye_view(placed, ROD_CHANNEL, side)
        assert along.medial_is_right == (along.tip_mm[0] > 0.0)


def test_another_drill_does_not_speak_for_one_lost_in_a_breach() -> None:
    theatre = Theatre("drill", "awl")
    theatre.images(1.0, {"drill": BREACH, "awl": PATH})
    theatre.images(5.0, {"awl": PATH})
    assert theatre.alarm(Condition.BREACH).state is AlarmState.ACTIVE
    assert theatre.sentence(Condition.BREACH).startswith("Not tracked. drill: Was 1.6 mm through")
    assert theatre.headline.tone != "good"
    theatre.service.acknowledge([one.number for one in theatre.service.picture.alarms], by="Ito")
    theatre.images(5.0, {"awl": PATH})
    assert theatre.alarm(Condition.BREACH).state is AlarmState.ACKNOWLEDGED
    assert theatre.headline.tone != "good"
    theatre.images(3.0, {"drill": PATH, "awl": PATH})
    assert {one.condition for one in theatre.service.picture.alarms} <= {Condition.NO_ARMED_SCREEN}


def test_a_past_alarm_claims_nothing_about_now_without_a_measurement() -> None:
    theatre = Theatre()
    theatre.images(1.0, {"drill": BREACH})
    theatre.images(3.0, {"drill": PATH})
    assert theatre.sentence(Condition.BREACH).endswith("Not through now.")
    theatre.images(3.0, {})
    assert "now" not in theatre.sentence(Condition.BREACH)


def test_a_channel_that_is_removed_in_a_breach_ends_it_without_saying_that_it_is_over() -> None:
    theatre = Theatre()
    theatre.images(1.0, {"drill": BREACH})
    for _ in range(30):
        theatre.images(0.1, {"drill": BREACH}, channel=Absent(reason=AbsentReason.NO_PLAN))
        assert "now" not in theatre.sentence(Condition.BREACH)
    assert theatre.alarm(Condition.BREACH).state is AlarmState.LATCHED


def test_a_number_that_is_not_measured_any_more_is_not_reported_as_of_now() -> None:
    stream = Stream()
    stream.images(2.0, tip_sd_mm=2.4, max_tip_sd_mm=1.0)
    picture = stream.images(
        1.0, pose_certain=False, tip_sd_mm=NOT_KNOWN, clearance_mm=NOT_KNOWN, breach_ratio=NOT_KNOWN
    )
    (alarm,) = picture.alarms
    words = alarm_text(alarm, unix_offset_s=0.0)
    assert words.sentence["en"] == "Tip position too uncertain to be shown."


def test_when_tracking_dies_in_a_breach_its_number_is_at_once_of_the_past() -> None:
    theatre = Theatre()
    before = theatre.images(1.0, {"drill": BREACH})
    picture = theatre.service.observe(None, RUNS, DIED)
    assert theatre.alarm(Condition.BREACH).presence is Presence.UNKNOWN
    assert theatre.sentence(Condition.BREACH).startswith("Not tracked. Was ")
    # A publisher that publishes on change publishes this one.
    assert picture.revision > before.revision


def test_a_drill_at_the_wall_that_is_through_in_every_other_image_is_alarmed() -> None:
    stream = Stream()
    raised: set[Condition] = set()
    for number in range(60):
        picture = stream.image(clearance_mm=-0.1 if number % 2 else 0.1, breach_ratio=0.5)
        raised |= {one.condition for one in picture.alarms}
    assert Condition.CLEARANCE_LOW in raised


def test_a_breach_alone_raises_no_second_alarm_beside_it() -> None:
    stream = Stream()
    picture = stream.images(3.0, clearance_mm=-0.8, breach_ratio=1.0)
    assert [one.condition for one in picture.alarms] == [Condition.BREACH]


def test_the_risk_of_one_drill_is_not_reported_of_another() -> None:
    theatre = Theatre("drill", "awl")
    theatre.images(2.0, {"drill": NEAR, "awl": RISKY})
    snapshot = theatre.snapshot
    assert snapshot is not None
    risks = {
        name: one.figures[FigureName.RISK].value
        for name, one in snapshot.assessments.items()
        if isinstance(one, Assessment)
    }
    assert risks["awl"] > risks["drill"]
    assert theatre.sentence(Condition.BREACH_LIKELY).startswith(f"awl: Risk of breach {risks['awl']:.0f} %")


@pytest.mark.parametrize(
    ("key", "value", "limit"), [("warning_distance_mm", 1.04, 1.1), ("breach_ratio", 0.055, 0.05)]
)
def test_alarm_and_figure_have_one_limit(key: str, value: float, limit: float) -> None:
    limits = alarm_limits(Config.model_validate({"alarms": {key: value}}))
    assert getattr(limits, key) == pytest.approx(limit)


def test_an_alarm_with_the_smallest_limit_can_be_cleared() -> None:
    limits = alarm_limits(Config.model_validate({"alarms": {"breach_ratio": 0.01}}))
    stream = Stream()
    stream.engine._limits = limits
    assert stream.images(1.0, breach_ratio=0.3).alarms
    assert stream.images(4.0, breach_ratio=0.01).alarms == ()


def test_aimed_components_are_never_larger_than_the_angle() -> None:
    random = np.random.default_rng(5)
    theatre = Theatre()
    for _ in range(50):
        where = (5.0, 0.0, 0.0, *random.uniform(-60, 60, 2).tolist(), 1.0)
        theatre.images(0.1, {"drill": where})
        assert theatre.snapshot is not None
        deviation = theatre.snapshot.deviations["drill"]
        assert not isinstance(deviation, Absent)
        parts = np.hypot(deviation.angle_medial_deg, deviation.angle_cranial_deg)
        assert parts == pytest.approx(deviation.angle_deg, abs=1e-9)
