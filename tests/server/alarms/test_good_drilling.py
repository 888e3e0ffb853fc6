"""From true poses to alarms: none while drilling correctly, one when the drill is held at a limit."""

import pytest

from tests.benchmarks.alarms.drilling_theatre import AlarmCounts, DrillingTheatre
from tests.benchmarks.alarms.good_drilling import raised_while_stationary
from tracker.navigation.alarms import Condition


def test_good_drilling_raises_nothing() -> None:
    theatre, counts = DrillingTheatre(7), AlarmCounts()
    theatre.drill(theatre.simulated, seconds=40.0, rate_hz=10.0, counts=counts)
    assert counts.clear_images == counts.images == 400
    assert 1.5 < counts.min_mm < 4.0
    assert counts.raised == {}


def test_a_breach_is_raised_and_no_sooner_than_it_is_true() -> None:
    theatre, counts = DrillingTheatre(7, skill="breaching"), AlarmCounts()
    theatre.drill(theatre.simulated, seconds=24.0, rate_hz=10.0, counts=counts)
    assert counts.min_mm < -1.0
    assert counts.raised[Condition.BREACH] == 1
    assert counts.raised_while_clear[Condition.BREACH] == 0


@pytest.mark.parametrize(
    ("limit_mm", "condition", "times"),
    [
        # A warning needs half a second without interruption, which a tremor at the limit never gives.
        pytest.param(1.0, Condition.CLEARANCE_LOW, 0, id="at-the-warning-distance"),
        pytest.param(0.8, Condition.CLEARANCE_LOW, 1, id="under-the-warning-distance"),
        pytest.param(0.0, Condition.BREACH, 1, id="at-the-wall"),
    ],
)
def test_a_drill_held_at_a_limit_does_not_chatter(limit_mm: float, condition: Condition, times: int) -> None:
    assert raised_while_stationary(7, limit_mm, condition, seconds=8.0) == times
