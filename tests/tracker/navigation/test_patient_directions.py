"""Deviation in the patient's directions: by hand, mirrored, and consistent with the pedicle measurement."""

from typing import Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.geometry import Rigid, Tool, Vertebra, rotation_between
from tracker.navigation import deviation_from_channel
from tracker.navigation.directions import Wall, channel_directions, side_of
from tracker.plan import Channel
from tracker.plan.pedicle import Side, axis_from_angles

ENTRY = np.array([16.0, 20.0, 5.0])


def _channel(side: Side, transverse_deg: float, sagittal_deg: float = 0.0) -> Channel:
    entry = ENTRY if side == "left" else ENTRY * [-1.0, 1.0, 1.0]
    axis = axis_from_angles(side, transverse_deg=transverse_deg, sagittal_deg=sagittal_deg)
    return Channel(
        name="L3", entry_in_vertebra_mm=entry, target_in_vertebra_mm=entry + 40.0 * axis, radius_mm=3.5
    )


def _drill(tip_mm: np.ndarray, direction: np.ndarray) -> Rigid[Vertebra, Tool]:
    return Rigid(rotation=rotation_between([0.0, 0.0, 1.0], direction), translation_mm=tip_mm)


@pytest.mark.parametrize(
    ("side", "shift_mm", "lateral_mm", "cranial_mm"),
    [
        pytest.param("left", (2.0, 0.0, 0.0), 2.0, 0.0, id="left-pedicle-to-the-left-is-lateral"),
        pytest.param("right", (2.0, 0.0, 0.0), -2.0, 0.0, id="right-pedicle-to-the-left-is-medial"),
        pytest.param("left", (0.0, 0.0, 1.5), 0.0, 1.5, id="to-the-head"),
        pytest.param("right", (-3.0, 0.0, -4.0), 3.0, -4.0, id="both-at-once"),
    ],
)
def test_the_entry_offset_is_split_as_a_surgeon_calls_it(
    side: Side, shift_mm: tuple[float, float, float], lateral_mm: float, cranial_mm: float
) -> None:
    channel = _channel(side, 0.0)
    drill = _drill(channel.entry_in_vertebra_mm + shift_mm, channel.axis_in_vertebra)
    deviation = deviation_from_channel(drill, channel, side)
    assert deviation.entry_lateral_mm == pytest.approx(lateral_mm, abs=1e-9)
    assert deviation.entry_cranial_mm == pytest.approx(cranial_mm, abs=1e-9)


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize(("more_transverse", "more_sagittal"), [(0, 0), (5, 0), (-7, 0), (0, 4), (6, -3)])
def test_angles_are_those_of_the_pedicle_s_measure(
    side: Literal["left", "right"], more_transverse: float, more_sagittal: float
) -> None:
    channel = _channel(side, 12.0, 3.0)
    turned = axis_from_angles(side, transverse_deg=12.0 + more_transverse, sagittal_deg=3.0 + more_sagittal)
    deviation = deviation_from_channel(_drill(channel.entry_in_vertebra_mm, turned), channel)
    assert deviation.transverse_deg == pytest.approx(more_transverse, abs=1e-9)
    assert deviation.sagittal_deg == pytest.approx(more_sagittal, abs=1e-9)


finite = st.floats(-20.0, 20.0)
slopes = st.floats(-0.6, 0.6)


@given(finite, finite, finite, slopes, slopes)
def test_the_two_parts_of_the_offset_make_the_whole(x: float, y: float, z: float, a: float, b: float) -> None:
    deviation = deviation_from_channel(
        _drill(np.array([x, y, z]), np.array([a, -1.0, b])), _channel("left", 15.0, 8.0)
    )
    parts = np.hypot(deviation.entry_lateral_mm, deviation.entry_cranial_mm)
    assert parts == pytest.approx(deviation.entry_offset_mm, abs=1e-9)


@given(finite, finite, finite, slopes, slopes)
def test_a_mirrored_patient_gives_the_same_numbers(x: float, y: float, z: float, a: float, b: float) -> None:
    tip, way, mirror = np.array([x, y, z]), np.array([a, -1.0, b]), np.array([-1.0, 1.0, 1.0])
    left = deviation_from_channel(_drill(tip, way), _channel("left", 15.0, 8.0))
    right = deviation_from_channel(_drill(tip * mirror, way * mirror), _channel("right", 15.0, 8.0))
    for name in left.__slots__:
        assert getattr(right, name) == pytest.approx(getattr(left, name), abs=1e-9)


def test_a_drill_across_the_channel_has_no_offset_to_split() -> None:
    channel = _channel("left", 0.0)
    deviation = deviation_from_channel(_drill(channel.entry_in_vertebra_mm, np.array([1.0, 0, 0])), channel)
    assert deviation.entry_lateral_mm == deviation.entry_cranial_mm == np.inf


def test_the_plan_s_side_is_believed_over_the_way_the_channel_runs() -> None:
    straying = _channel("left", -3.0)
    assert side_of(straying) == "right"
    assert channel_directions(straying, "left").medial[0] < 0.0


@pytest.mark.parametrize(
    ("towards", "wall"),
    [
        ((-1.0, 0.0, 0.0), Wall.MEDIAL),
        ((1.0, -0.5, 0.0), Wall.LATERAL),
        ((0.1, 0.0, 1.0), Wall.CRANIAL),
        ((0.0, 0.0, -2.0), Wall.CAUDAL),
        ((0.3, -1.0, 0.3), Wall.ANTERIOR),
    ],
)
def test_a_wall_is_called_by_its_direction(towards: tuple[float, float, float], wall: Wall) -> None:
    assert channel_directions(_channel("left", 0.0)).wall_towards(np.array(towards)) is wall


def test_a_channel_along_the_body_still_has_directions() -> None:
    up = Channel(
        name="odd",
        entry_in_vertebra_mm=np.zeros(3),
        target_in_vertebra_mm=np.array([0, 0, 30.0]),
        radius_mm=3,
    )
    across = channel_directions(up)
    basis = np.stack([across.axis, across.medial, across.cranial])
    np.testing.assert_allclose(basis @ basis.T, np.eye(3), atol=1e-12)
