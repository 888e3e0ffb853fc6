"""Another planned channel is proposed while the drill stays nearer to it, from valid poses only."""

from collections.abc import Callable

import numpy as np
import pytest

from tracker.navigation.nearest_channel import NearestChannelMonitor, distance_to_channel_mm
from tracker.plan import Channel

RATE_HZ = 10.0


def channel(name: str, x_mm: float) -> Channel:
    """40 mm along z, at this place."""
    return Channel(
        name=name,
        entry_in_vertebra_mm=np.array([x_mm, 0.0, 0.0]),
        target_in_vertebra_mm=np.array([x_mm, 0.0, 40.0]),
        radius_mm=3.0,
    )


LEFT, RIGHT, BELOW = channel("left", 0.0), channel("right", -30.0), channel("below", 30.0)
OTHERS = {"right": RIGHT, "below": BELOW}


class Hand:
    """A drill that is held at one place after another."""

    def __init__(self) -> None:
        self.monitor = NearestChannelMonitor()
        self.at_s = 0.0

    def hold(self, x_mm: float | None, for_s: float, z_mm: float = -2.0) -> str | None:
        """Return what is proposed after the last image."""
        proposed = None
        for _ in range(round(for_s * RATE_HZ)):
            self.at_s += 1.0 / RATE_HZ
            tip = None if x_mm is None else np.array([x_mm, 0.0, z_mm])
            proposed = self.monitor.step(tip, self.at_s, active=LEFT, others=OTHERS)
        return proposed


@pytest.mark.parametrize(
    ("point", "distance_mm"),
    [([3.0, 4.0, 20.0], 5.0), ([0.0, 4.0, -3.0], 5.0), ([3.0, 0.0, 44.0], 5.0), ([0.0, 0.0, 0.0], 0.0)],
    ids=["beside-it", "before-the-entry", "past-the-target", "at-the-entry"],
)
def test_the_distance_is_that_from_the_planned_part_of_the_axis(
    point: list[float], distance_mm: float
) -> None:
    assert distance_to_channel_mm(np.array(point), LEFT) == pytest.approx(distance_mm)


def test_a_channel_is_proposed_after_a_second_beside_it_and_no_longer_when_the_drill_returns() -> None:
    hand = Hand()
    assert hand.hold(-28.0, 0.9) is None
    assert hand.hold(-28.0, 0.3) == "right"
    # 14 mm from the active one and 16 mm from the other: no longer nearer.
    assert hand.hold(-14.0, 0.1) is None


def test_between_two_channels_nothing_changes() -> None:
    hand = Hand()
    # 2 mm nearer are too few to begin, and enough to stay.
    assert hand.hold(-16.5, 3.0) is None
    assert hand.hold(-28.0, 1.2) == "right"
    assert hand.hold(-16.5, 3.0) == "right"


def test_another_channel_replaces_a_proposal_only_after_its_own_second() -> None:
    hand = Hand()
    assert hand.hold(-28.0, 1.2) == "right"
    assert hand.hold(28.0, 0.5) is None
    assert hand.hold(28.0, 0.7) == "below"


@pytest.mark.parametrize(
    "interruption",
    [lambda hand: hand.hold(None, 0.1), lambda hand: setattr(hand, "at_s", hand.at_s + 0.6)],
    ids=["a-pose-is-missing", "images-are-missing"],
)
def test_a_missing_pose_ends_a_proposal(interruption: Callable[["Hand"], object]) -> None:
    hand = Hand()
    assert hand.hold(-28.0, 1.2) == "right"
    interruption(hand)
    assert hand.hold(-28.0, 0.9) is None
    assert hand.hold(-28.0, 0.3) == "right"


def test_far_from_all_channels_nothing_is_proposed() -> None:
    assert Hand().hold(-30.0, 3.0, z_mm=-18.0) is None
