"""The bull's-eye view: patient's left on the left, head up, a parallel drill is a point."""

import numpy as np
import pytest

from tracker.geometry import Array, Rigid, Tool, Vertebra, rotation_between
from tracker.navigation import bullseye_view
from tracker.plan import Channel


def straight(*, left: bool = True) -> Channel:
    """Forward through the patient (LPS: -y), on one side, 40 mm long, slightly medial."""
    side = 1.0 if left else -1.0
    return Channel(
        name="L3",
        entry_in_vertebra_mm=np.array([15.0 * side, 10.0, 0.0]),
        target_in_vertebra_mm=np.array([14.999 * side, -30.0, 0.0]),
        radius_mm=4.0,
    )


def drill(tip_mm: tuple[float, float, float], direction: tuple[float, float, float]) -> Rigid[Vertebra, Tool]:
    return Rigid(rotation=rotation_between([0, 0, 1], direction), translation_mm=np.array(tip_mm))


@pytest.mark.parametrize(
    ("tip_mm", "direction", "tip", "at_entry", "at_target"),
    [
        pytest.param((15, 10, 0), (0, -1, 0), (0, 0), (0, 0), (0, 0), id="true"),
        pytest.param((17, 10, 0), (0, -1, 0), (-2, 0), (-2, 0), (-2, 0), id="to-the-patients-left"),
        pytest.param((15, 0, 3), (0, -1, 0), (0, 3), (0, 3), (0, 3), id="to-the-head"),
        pytest.param((15, -10, 0), (-1, -20, 0), (0, 0), (-1, 0), (1, 0), id="turned-to-the-right"),
    ],
)
def test_places_in_the_view(
    tip_mm: tuple[float, float, float],
    direction: tuple[float, float, float],
    tip: tuple[float, float],
    at_entry: tuple[float, float],
    at_target: tuple[float, float],
) -> None:
    seen = bullseye_view(drill(tip_mm, direction), straight())
    # The channel itself is inclined by a thousandth of a millimetre.
    np.testing.assert_allclose(seen.tip_mm, tip, atol=2e-3)
    np.testing.assert_allclose(seen.at_entry_mm, at_entry, atol=2e-3)
    np.testing.assert_allclose(seen.at_target_mm, at_target, atol=2e-3)


def test_the_middle_of_the_patient_is_on_the_right_of_a_left_pedicle() -> None:
    pose = drill((15, 10, 0), (0, -1, 0))
    assert bullseye_view(pose, straight(left=True)).medial_is_right
    assert not bullseye_view(pose, straight(left=False)).medial_is_right


def test_a_drill_across_the_channel_meets_no_plane_of_it() -> None:
    seen = bullseye_view(drill((15, 0, 0), (1, 0, 0)), straight())
    assert not np.isfinite(seen.at_entry_mm).any()
    assert not np.isfinite(seen.at_target_mm).any()


def test_the_view_keeps_lengths_across_the_channel() -> None:
    seen = bullseye_view(drill((12, 0, 4), (0, -1, 0)), straight())
    expected: Array = np.hypot(3.0, 4.0)
    np.testing.assert_allclose(np.hypot(*seen.tip_mm), expected, atol=2e-3)
