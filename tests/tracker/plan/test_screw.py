"""Clearance, grade, tolerance and proposal of a screw, on a pedicle with simple dimensions."""

import dataclasses

import numpy as np
import pytest

from tracker.errors import PlanError
from tracker.plan import (
    Channel,
    PedicleMeasure,
    PedicleSpread,
    ScrewCatalogue,
    Volume,
    channel_from_measure,
    channel_from_points,
    plan_screw,
    propose_screw,
)
from tracker.plan.screw import (
    USUAL_CATALOGUE,
    clearance_along,
    clearance_of,
    grade_of_breach,
    tolerance_of,
)

AROUND = np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)
FORWARDS = np.array([0.0, -1.0, 0.0])


def pedicle(side: str = "left") -> PedicleMeasure:
    """8 x 12 mm, straight forwards, isthmus at the origin, entry 15 mm behind, front wall 35 mm ahead."""
    outline = np.stack([4.0 * np.cos(AROUND), np.zeros(720), 6.0 * np.sin(AROUND)], axis=1)
    return PedicleMeasure(
        side="left" if side == "left" else "right",
        width_mm=8.0,
        height_mm=12.0,
        transverse_deg=0.0,
        sagittal_deg=0.0,
        length_mm=50.0,
        isthmus_lps_mm=np.zeros(3),
        axis_lps=FORWARDS,
        entry_lps_mm=np.array([0.0, 15.0, 0.0]),
        front_lps_mm=np.array([0.0, -35.0, 0.0]),
        outline_lps_mm=outline,
        seed_lps_mm=np.zeros(3),
        cortex_mm=1.0,
        sd=PedicleSpread(
            width_mm=0.1, height_mm=0.1, transverse_deg=0.3, sagittal_deg=0.3, length_mm=0.3, isthmus_mm=0.1
        ),
    )


def shifted(x_mm: float, z_mm: float = 0.0) -> Channel:
    return channel_from_points(
        "by hand", entry_lps_mm=(x_mm, 15.0, z_mm), target_lps_mm=(x_mm, -30.0, z_mm), diameter_mm=4.0
    )


def test_the_channel_has_the_least_width_as_its_diameter_and_ends_before_the_front() -> None:
    channel = channel_from_measure("L3 left", pedicle())
    assert channel.radius_mm == pytest.approx(4.0)
    assert channel.target_in_vertebra_mm == pytest.approx([0.0, -30.0, 0.0])


def test_clearance_to_each_wall_in_the_middle() -> None:
    room = clearance_of(shifted(0.0), pedicle(), diameter_mm=5.0, length_mm=45.0)
    assert (room.medial_mm, room.lateral_mm) == pytest.approx((1.5, 1.5), abs=0.02)
    assert (room.superior_mm, room.inferior_mm) == pytest.approx((3.5, 3.5), abs=1.3)
    assert room.superior_mm <= 3.5
    assert room.anterior_mm == pytest.approx(5.0)
    assert room.grade == "A"


@pytest.mark.parametrize(("side", "medial"), [("left", 2.5), ("right", 0.5)])
def test_medial_is_towards_the_middle_of_the_patient(side: str, medial: float) -> None:
    # Moved by 1 mm to the patient's left: away from the canal on the left side, towards it on the right.
    room = clearance_of(shifted(1.0), pedicle(side), diameter_mm=5.0, length_mm=45.0)
    assert room.medial_mm == pytest.approx(medial, abs=0.25)
    assert room.lateral_mm == pytest.approx(3.0 - medial, abs=0.25)


@pytest.mark.parametrize(
    ("breach", "grade"), [(0.0, "A"), (0.1, "B"), (1.99, "B"), (2.0, "C"), (4.0, "D"), (5.9, "D"), (6.0, "E")]
)
def test_grades_of_gertzbein_and_robbins(breach: float, grade: str) -> None:
    assert grade_of_breach(breach) == grade


def test_a_screw_too_far_to_the_side_breaks_out() -> None:
    room = clearance_of(shifted(3.0), pedicle(), diameter_mm=5.0, length_mm=45.0)
    assert room.breach_mm == pytest.approx(1.5, abs=0.05)
    assert room.grade == "B"
    outside = clearance_of(shifted(8.5), pedicle(), diameter_mm=5.0, length_mm=45.0)
    assert outside.grade == "E"


def test_tolerance_is_what_keeps_the_cylinder_within_the_walls() -> None:
    left = tolerance_of(shifted(0.0), pedicle(), diameter_mm=5.0)
    assert left.max_offset_mm == pytest.approx(1.5, abs=0.02)
    assert left.max_angle_deg == pytest.approx(np.degrees(np.arctan(1.5 / 18.0)), abs=0.1)
    assert left.deg_at_offset[-1] == pytest.approx(0.0, abs=1e-9)
    # Checked against the walls: the worst combination is still inside, slightly more is not.
    for share, inside in ((0.98, True), (1.15, False)):
        tilt = np.tan(np.radians(left.both_deg)) * share
        start = left.both_mm * share
        channel = channel_from_points(
            "worst",
            entry_lps_mm=(start, 15.0, 0.0),
            target_lps_mm=(start + 45.0 * tilt, -30.0, 0.0),
            diameter_mm=5.0,
        )
        room = clearance_of(channel, pedicle(), diameter_mm=5.0, length_mm=40.0)
        assert (room.grade == "A") is inside


def test_a_longer_pedicle_leaves_less_angle() -> None:
    long = dataclasses.replace(pedicle(), opens_ahead_mm=9.0)
    left = tolerance_of(shifted(0.0), long, diameter_mm=5.0)
    assert left.max_offset_mm == pytest.approx(1.5, abs=0.02)
    assert left.max_angle_deg == pytest.approx(np.degrees(np.arctan(1.5 / 24.0)), abs=0.1)
    assert left.deg_at_offset[-1] == pytest.approx(0.0, abs=1e-9)
    # The part that leaves the longer pedicle is a breach, which the isthmus alone would not show.
    tilted = channel_from_points(
        "tilted",
        entry_lps_mm=(0.0, 15.0, 0.0),
        target_lps_mm=(45.0 * 1.7 / 21.0, -30.0, 0.0),
        diameter_mm=4.0,
    )
    assert clearance_of(tilted, pedicle(), diameter_mm=5.0, length_mm=40.0).grade == "A"
    assert clearance_of(tilted, long, diameter_mm=5.0, length_mm=40.0).grade == "B"


def test_a_plan_without_room_leaves_no_tolerance() -> None:
    left = tolerance_of(shifted(3.0), pedicle(), diameter_mm=5.0)
    assert (left.max_offset_mm, left.max_angle_deg) == (0.0, 0.0)


def test_the_thickest_and_longest_that_fit_are_proposed() -> None:
    assert propose_screw(shifted(0.0), pedicle(), USUAL_CATALOGUE) == (7.0, 45.0)
    assert propose_screw(shifted(0.0), pedicle(), USUAL_CATALOGUE, wall_margin_mm=1.0) == (6.0, 45.0)


def test_without_a_fitting_screw_the_error_has_the_numbers() -> None:
    with pytest.raises(PlanError, match=r"4\.0 mm to the nearest wall") as caught:
        propose_screw(shifted(0.0), pedicle(), ScrewCatalogue(diameters_mm=(9.0,), lengths_mm=(40.0,)))
    assert caught.value.code == "NO_SCREW_FITS"
    with pytest.raises(PlanError, match="needed one or more"):
        ScrewCatalogue(diameters_mm=(), lengths_mm=(40.0,))


def test_bone_along_the_screw_is_read_from_the_ct() -> None:
    affine = np.eye(4)
    affine[:3, 3] = [-20.0, -40.0, -20.0]
    hu = np.zeros((41, 61, 41), np.int16)
    hu[:, :30] = 300
    screw = plan_screw(
        Volume(hu=hu, lps_from_ijk=affine), shifted(0.0), pedicle(), diameter_mm=5.0, length_mm=45.0
    )
    assert screw.bone.hu[0] == pytest.approx(0.0)
    assert screw.bone.hu[-1] == pytest.approx(300.0)
    assert screw.bone.mean_hu == pytest.approx(300.0 * 19.5 / 45.0, abs=10.0)
    assert screw.bone.inside_ratio == 1.0


def test_a_screw_in_other_units_is_rejected() -> None:
    volume = Volume(hu=np.zeros((3, 3, 3), np.int16), lps_from_ijk=np.eye(4))
    with pytest.raises(PlanError, match="allowed are diameters"):
        plan_screw(volume, shifted(0.0), pedicle(), diameter_mm=55.0, length_mm=45.0)


def test_a_pedicle_tilted_as_a_whole_has_the_same_clearance() -> None:
    straight = clearance_of(shifted(0.0), pedicle(), diameter_mm=5.0, length_mm=45.0)
    turn = np.array([[np.cos(0.3), -np.sin(0.3), 0.0], [np.sin(0.3), np.cos(0.3), 0.0], [0.0, 0.0, 1.0]])
    one = pedicle()
    turned = dataclasses.replace(
        one,
        axis_lps=turn @ one.axis_lps,
        entry_lps_mm=turn @ one.entry_lps_mm,
        front_lps_mm=turn @ one.front_lps_mm,
        outline_lps_mm=one.outline_lps_mm @ turn.T,
    )
    room = clearance_of(channel_from_measure("t", turned), turned, diameter_mm=5.0, length_mm=45.0)
    assert room.medial_mm == pytest.approx(straight.medial_mm, abs=1e-6)
    assert room.anterior_mm == pytest.approx(straight.anterior_mm, abs=1e-6)


def signed_distance_mm(x_mm: np.ndarray, z_mm: np.ndarray) -> np.ndarray:
    """Distance of points from the ellipse of the pedicle, positive inside; from its implicit equation."""
    angle = np.linspace(0.0, 2.0 * np.pi, 20_000)
    away = np.hypot(x_mm[:, None] - 4.0 * np.cos(angle), z_mm[:, None] - 6.0 * np.sin(angle)).min(axis=1)
    return np.asarray(np.where((x_mm / 4.0) ** 2 + (z_mm / 6.0) ** 2 < 1.0, away, -away))


@pytest.mark.parametrize(
    ("entry_xz_mm", "target_xz_mm", "min_depth_mm"),
    [
        pytest.param((0.0, 0.0), (0.0, 0.0), None, id="on-the-axis"),
        pytest.param((-1.0, 0.5), (9.0, 6.0), 24.0, id="nearing-the-wall-and-through-it"),
        pytest.param((7.0, -1.0), (0.0, 2.0), 12.0, id="through-the-wall-and-back-inside"),
        pytest.param((6.0, 4.0), (8.0, 4.0), None, id="outside"),
    ],
)
def test_clearance_by_depth_is_the_distance_to_the_solid(
    entry_xz_mm: tuple[float, float], target_xz_mm: tuple[float, float], min_depth_mm: float | None
) -> None:
    channel = channel_from_points(
        "by hand",
        entry_lps_mm=(entry_xz_mm[0], 15.0, entry_xz_mm[1]),
        target_lps_mm=(target_xz_mm[0], -30.0, target_xz_mm[1]),
        diameter_mm=4.0,
    )
    long = dataclasses.replace(pedicle(), opens_ahead_mm=9.0)
    found = clearance_along(channel, long, diameter_mm=5.0, length_mm=45.0)
    assert found is not None
    points = channel.entry_in_vertebra_mm + found.depth_mm[:, None] * channel.axis_in_vertebra
    # From 3 mm behind the isthmus to where the pedicle opens.
    assert points[[0, -1], 1] == pytest.approx([3.0, -9.0])
    assert np.diff(found.depth_mm).max() <= 0.5 + 1e-9
    assert found.clearance_mm == pytest.approx(signed_distance_mm(points[:, 0], points[:, 2]) - 2.5, abs=2e-3)
    if min_depth_mm is not None:
        along = float(channel.axis_in_vertebra @ FORWARDS)
        assert found.min_depth_mm * along == pytest.approx(min_depth_mm, abs=1e-6)
    # The figures beside it and the grade are of the same walls.
    figures = clearance_of(channel, long, diameter_mm=5.0, length_mm=45.0)
    assert max(-found.min_mm, 0.0) == pytest.approx(figures.breach_mm, abs=1e-9)
    assert found.min_mm == pytest.approx(figures.min_mm, abs=1e-9)


def test_clearance_by_depth_is_known_only_where_the_screw_is_in_the_pedicle() -> None:
    short = clearance_along(shifted(0.0), pedicle(), diameter_mm=5.0, length_mm=14.0)
    assert short is not None
    assert short.depth_mm[[0, -1]] == pytest.approx([12.0, 14.0])
    assert clearance_along(shifted(0.0), pedicle(), diameter_mm=5.0, length_mm=11.0) is None
    across = channel_from_points("across", entry_lps_mm=(-9, 0, 0), target_lps_mm=(9, 0, 0), diameter_mm=4.0)
    assert clearance_along(across, pedicle(), diameter_mm=5.0, length_mm=15.0) is None
