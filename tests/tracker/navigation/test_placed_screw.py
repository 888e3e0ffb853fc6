"""The screw on the axis of a drill: its ends from the geometry, and drills that are not in the channel."""

import numpy as np
import pytest

from tracker.errors import RegistrationError
from tracker.geometry import Rigid, Tool, Vertebra, rotation_between
from tracker.navigation import PlacedScrew, ScrewSize
from tracker.plan import Channel

CHANNEL = Channel(
    name="L3 left",
    entry_in_vertebra_mm=np.array([15.0, 14.0, 2.0]),
    target_in_vertebra_mm=np.array([15.0, -26.0, 2.0]),
    radius_mm=3.0,
)
SCREW = ScrewSize(radius_mm=2.75, length_mm=40.0)


def drill(tip_mm: list[float], direction: list[float]) -> Rigid[Vertebra, Tool]:
    along = np.array(direction) / np.linalg.norm(direction)
    return Rigid(rotation=rotation_between([0.0, 0.0, 1.0], along), translation_mm=np.array(tip_mm))


def test_the_screw_starts_where_an_oblique_drill_meets_the_entry_plane() -> None:
    # 3-4-5: 8 mm deep along the channel, 10 mm along the drill, 6 mm sideways.
    placed = PlacedScrew.on_drill(CHANNEL, drill([12.0, 6.0, 2.0], [-3.0, -4.0, 0.0]), SCREW)
    np.testing.assert_allclose(placed.head_in_vertebra_mm, [18.0, 14.0, 2.0], atol=1e-12)
    np.testing.assert_allclose(placed.tip_in_vertebra_mm, [18.0 - 24.0, 14.0 - 32.0, 2.0], atol=1e-12)


@pytest.mark.parametrize("shift_mm", [0.0, 3.0, -9.0])
def test_a_drill_parallel_to_the_channel(shift_mm: float) -> None:
    placed = PlacedScrew.on_drill(CHANNEL, drill([15.0 + shift_mm, -10.0, 2.0], [0.0, -1.0, 0.0]), SCREW)
    np.testing.assert_allclose(placed.head_in_vertebra_mm, [15.0 + shift_mm, 14.0, 2.0], atol=1e-12)
    np.testing.assert_allclose(placed.tip_in_vertebra_mm, [15.0 + shift_mm, -26.0, 2.0], atol=1e-12)
    assert placed.radius_mm == SCREW.radius_mm
    assert placed.name == "L3 left"


@pytest.mark.parametrize(
    ("tip_mm", "direction", "code"),
    [
        ([15.0, 14.5, 2.0], [0.0, -1.0, 0.0], "DRILL_NOT_IN_BONE"),
        ([15.0, -10.0, 2.0], [0.0, 1.0, 0.0], "DRILL_NOT_IN_CHANNEL"),
        ([15.0, -10.0, 2.0], [1.1, -1.0, 0.0], "DRILL_NOT_IN_CHANNEL"),
        ([-15.0, -10.0, 2.0], [0.0, -1.0, 0.0], "DRILL_NOT_IN_CHANNEL"),
    ],
)
def test_a_drill_elsewhere_places_nothing(tip_mm: list[float], direction: list[float], code: str) -> None:
    with pytest.raises(RegistrationError) as rejected:
        PlacedScrew.on_drill(CHANNEL, drill(tip_mm, direction), SCREW)
    assert rejected.value.code == code
