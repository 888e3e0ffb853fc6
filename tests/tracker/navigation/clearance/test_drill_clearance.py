"""Clearance of the whole drill: by hand on a rod, and in the rehearsed vertebra with slipping drills."""

from functools import lru_cache

import numpy as np
import pytest

from tests.tracker.navigation.bones import ROD_CHANNEL, drill_at, rod
from tracker.geometry import Rigid, Tool, Vertebra
from tracker.navigation.clearance import (
    DrillClearance,
    NearestWall,
    NotEntered,
    WallDistanceField,
    WallProximity,
    WallSource,
    bone_distance_field,
    channel_distance_field,
    clearance_of_drill,
    drill_rings,
    outline_distance_field,
    screw_clearance_along,
    select_wall,
)
from tracker.navigation.directions import Wall
from tracker.plan import Channel, Surface
from tracker.plan.pedicle import PedicleMeasure, PedicleSpread
from tracker.plan.screw import GertzbeinRobbins
from tracker.rehearsal.anatomy import bone_field, pedicle_channels, vertebra_surface

LEFT = pedicle_channels()[0]


@lru_cache(maxsize=4)
def _field(name: str) -> WallDistanceField:
    if name == "rod":
        return bone_distance_field(rod(), ROD_CHANNEL, margin_mm=20.0)
    return bone_distance_field(vertebra_surface(), pedicle_channels()[("left", "right").index(name)])


def _clearance(
    pose: Rigid[Vertebra, Tool],
    channel: Channel,
    wall: WallDistanceField,
    *,
    radius_mm: float = 2.0,
    screw_radius_mm: float | None = None,
) -> DrillClearance:
    rings = drill_rings(
        pose, channel, wall, radius_mm=radius_mm, length_mm=100.0, screw_radius_mm=screw_radius_mm
    )
    return clearance_of_drill(rings, pose, channel, "right" if "right" in channel.name else "left")


def _mm(closest: NearestWall | NotEntered) -> float:
    assert isinstance(closest, NearestWall)
    return closest.clearance_mm


@pytest.mark.parametrize(
    ("depth_mm", "medial_mm", "cranial_mm", "clearance_mm", "wall"),
    [
        pytest.param(30.0, 0.5, 0.0, 2.5, Wall.MEDIAL, id="half-a-millimetre-medial"),
        pytest.param(30.0, 3.0, 0.0, 0.0, Wall.MEDIAL, id="touching-the-wall"),
        pytest.param(30.0, -4.0, 0.0, -1.0, Wall.LATERAL, id="one-through-laterally"),
        pytest.param(30.0, 0.0, 6.0, -3.0, Wall.CRANIAL, id="three-through-above"),
        pytest.param(30.0, 0.0, -3.5, -0.5, Wall.CAUDAL, id="half-through-below"),
        pytest.param(59.0, 0.0, 0.0, 1.0, Wall.ANTERIOR, id="one-before-the-front-wall"),
        pytest.param(61.5, 0.0, 0.0, -1.5, Wall.ANTERIOR, id="through-the-front-wall"),
        pytest.param(20.0, 9.0, 0.0, -6.0, Wall.MEDIAL, id="slipped-off-and-gone-down-beside-the-bone"),
    ],
)
def test_clearance_is_what_a_hand_measures(
    depth_mm: float, medial_mm: float, cranial_mm: float, clearance_mm: float, wall: Wall
) -> None:
    pose = drill_at(ROD_CHANNEL, depth_mm, medial_mm=medial_mm, cranial_mm=cranial_mm)
    now = _clearance(pose, ROD_CHANNEL, _field("rod")).now
    assert isinstance(now, NearestWall)
    assert now.clearance_mm == pytest.approx(clearance_mm, abs=0.1)
    assert now.wall is wall


def test_a_tilted_drill_is_nearest_at_its_rim_where_it_is_deepest() -> None:
    pose = drill_at(ROD_CHANNEL, 30.0, medial_deg=3.0)
    now = _clearance(pose, ROD_CHANNEL, _field("rod")).now
    # The axis is off by 30 tan 3 = 1.57 there, and the rim is closer by the cosine.
    assert _mm(now) == pytest.approx(5.0 - 1.572 - 2.0 * np.cos(np.radians(3.0)), abs=0.1)
    assert isinstance(now, NearestWall)
    assert now.point_in_vertebra_mm[1] == pytest.approx(-10.0, abs=1.2)


def test_the_shaft_is_through_where_the_tip_is_not() -> None:
    # In through the posterior side wall, tip back on the axis in front.
    pose = drill_at(ROD_CHANNEL, 40.0, medial_mm=5.0, medial_deg=float(np.degrees(np.arctan(-5.0 / 40.0))))
    now = _clearance(pose, ROD_CHANNEL, _field("rod")).now
    assert isinstance(now, NearestWall)
    assert now.clearance_mm < -1.0
    assert now.point_in_vertebra_mm[1] > 10.0


@pytest.mark.parametrize("depth_mm", [-30.0, -5.0, -0.1, 1.5])
@pytest.mark.parametrize("medial_mm", [0.0, 4.0, -12.0])
def test_a_drill_that_hovers_is_no_breach(depth_mm: float, medial_mm: float) -> None:
    pose = drill_at(ROD_CHANNEL, depth_mm, medial_mm=medial_mm, medial_deg=4.0)
    assert _clearance(pose, ROD_CHANNEL, _field("rod")).now == NotEntered()


def test_a_drill_elsewhere_on_the_patient_is_not_measured_against_this_pedicle() -> None:
    pose = drill_at(ROD_CHANNEL, 15.0, cranial_mm=35.0)
    assert _clearance(pose, ROD_CHANNEL, _field("rod")).now == NotEntered()


@pytest.mark.parametrize(("tilt_deg", "grade"), [(0.0, "A"), (4.0, "A"), (6.0, "B"), (9.0, "D"), (14.0, "E")])
def test_the_present_direction_gives_its_class_before_it_is_drilled(tilt_deg: float, grade: str) -> None:
    clearance = _clearance(
        drill_at(ROD_CHANNEL, -2.0, medial_deg=tilt_deg), ROD_CHANNEL, _field("rod"), screw_radius_mm=1.0
    )
    assert isinstance(clearance.now, NotEntered)
    # At the planned 55 mm the axis is off by 57 tan less what it was off at the entry.
    assert grade_of(clearance.at_end) is GertzbeinRobbins(grade)


def test_soon_is_two_millimetres_further() -> None:
    clearance = _clearance(drill_at(ROD_CHANNEL, 57.0), ROD_CHANNEL, _field("rod"))
    assert _mm(clearance.lookahead) == pytest.approx(1.0, abs=0.1)
    assert clearance.past_planned_mm == pytest.approx(2.0)


def test_the_channel_s_own_wall_is_reported_too() -> None:
    clearance = _clearance(drill_at(ROD_CHANNEL, 30.0, medial_mm=2.5), ROD_CHANNEL, _field("rod"))
    assert _mm(clearance.channel) == pytest.approx(4.0 - 2.5 - 2.0)
    assert grade_of(clearance.channel) is GertzbeinRobbins.B
    assert grade_of(clearance.now) is GertzbeinRobbins.A


def test_the_channel_alone_stands_in_where_no_bone_is_known() -> None:
    clearance = _clearance(
        drill_at(ROD_CHANNEL, 30.0, medial_mm=2.5), ROD_CHANNEL, channel_distance_field(ROD_CHANNEL)
    )
    assert clearance.against is WallSource.CHANNEL
    assert _mm(clearance.now) == pytest.approx(_mm(clearance.channel), abs=0.05)


def _round_pedicle(radius_mm: float) -> PedicleMeasure:
    turn = 2.0 * np.pi * np.arange(72) / 72
    isthmus = np.array([0.0, 2.0, 0.0])
    ring = radius_mm * np.stack([np.cos(turn), np.zeros(72), np.sin(turn)], axis=1)
    return PedicleMeasure(
        side="left",
        width_mm=2 * radius_mm,
        height_mm=2 * radius_mm,
        transverse_deg=0.0,
        sagittal_deg=0.0,
        length_mm=60.0,
        isthmus_lps_mm=isthmus,
        axis_lps=np.array([0.0, -1.0, 0.0]),
        entry_lps_mm=np.array([0.0, 20.0, 0.0]),
        front_lps_mm=np.array([0.0, -40.0, 0.0]),
        outline_lps_mm=isthmus + ring,
        seed_lps_mm=isthmus,
        cortex_mm=1.0,
        sd=PedicleSpread(
            width_mm=0.1, height_mm=0.1, transverse_deg=1, sagittal_deg=1, length_mm=1, isthmus_mm=0.5
        ),
    )


@pytest.mark.parametrize(("medial_mm", "clearance_mm"), [(0.5, 2.0), (3.0, -0.5)])
def test_the_isthmus_s_outline_stands_in_for_the_bone(medial_mm: float, clearance_mm: float) -> None:
    field = outline_distance_field(_round_pedicle(4.5), ROD_CHANNEL)
    clearance = _clearance(drill_at(ROD_CHANNEL, 30.0, medial_mm=medial_mm), ROD_CHANNEL, field)
    assert clearance.against is WallSource.PEDICLE
    assert _mm(clearance.now) == pytest.approx(clearance_mm, abs=0.1)


def test_the_bone_is_the_wall_where_it_is_known_and_agrees_with_the_plan() -> None:
    chosen = select_wall(ROD_CHANNEL, rod(), _round_pedicle(4.5), radius_mm=2.0)
    assert (chosen.wall.against, chosen.remarks) == (WallSource.BONE, ())


@pytest.mark.parametrize(
    ("surface", "measured", "codes"),
    [
        pytest.param(None, True, [], id="no-surface"),
        pytest.param(None, False, [], id="no-surface-and-no-pedicle"),
        pytest.param(rod(1.7), True, ["BONE_CONTRADICTS_PLAN"], id="walls-eaten-by-a-threshold"),
        pytest.param(
            Surface(vertices_mm=rod().vertices_mm + 99.0, faces=rod().faces),
            True,
            ["BONE_NOT_AT_CHANNEL"],
            id="a-surface-elsewhere",
        ),
    ],
)
def test_without_a_surface_that_fits_the_plan_the_next_best_wall_is_taken_and_reported(
    surface: Surface | None, *, measured: bool, codes: list[str]
) -> None:
    chosen = select_wall(ROD_CHANNEL, surface, _round_pedicle(4.5) if measured else None, radius_mm=2.0)
    assert chosen.wall.against is (WallSource.PEDICLE if measured else WallSource.CHANNEL)
    assert [remark.code for remark in chosen.remarks] == codes


@pytest.mark.parametrize(
    ("depth_mm", "medial_mm", "cranial_mm", "medial_deg", "wall"),
    [
        pytest.param(25.0, 0.0, 0.0, 15.0, Wall.MEDIAL, id="into-the-canal"),
        pytest.param(20.0, 14.0, 0.0, 0.0, Wall.MEDIAL, id="through-the-canal-s-middle"),
        pytest.param(25.0, 0.0, 0.0, -15.0, Wall.LATERAL, id="out-at-the-side"),
        pytest.param(20.0, 0.0, -12.0, 0.0, Wall.CAUDAL, id="into-the-foramen-below"),
        pytest.param(12.0, -15.0, 0.0, 0.0, Wall.LATERAL, id="slipped-off-past-the-transverse-process"),
        pytest.param(62.0, 0.0, 0.0, 0.0, Wall.ANTERIOR, id="out-in-front"),
    ],
)
@pytest.mark.parametrize("side", ["left", "right"])
def test_breaches_of_a_vertebra_are_seen_and_called_by_their_wall(
    side: str, depth_mm: float, medial_mm: float, cranial_mm: float, medial_deg: float, wall: Wall
) -> None:
    channel = pedicle_channels()[("left", "right").index(side)]
    pose = drill_at(channel, depth_mm, medial_mm=medial_mm, cranial_mm=cranial_mm, medial_deg=medial_deg)
    now = _clearance(pose, channel, _field(side)).now
    assert isinstance(now, NearestWall)
    assert now.clearance_mm < -0.5
    assert now.wall is wall


def grade_of(closest: WallProximity) -> GertzbeinRobbins | None:
    return closest.grade if isinstance(closest, NearestWall) else None


def test_all_the_way_down_the_plan_nothing_is_said_to_be_near_that_is_not() -> None:
    """The bone's implicit shape is the truth: at each depth, how far it extends around the drill."""
    turn = 2.0 * np.pi * np.arange(24) / 24
    for depth in np.arange(-10.0, LEFT.length_mm, 1.5):
        clearance = _clearance(drill_at(LEFT, float(depth)), LEFT, _field("left"))
        if isinstance(clearance.now, NotEntered):
            assert depth < 3.0
            continue
        assert clearance.now.grade is GertzbeinRobbins.A
        if depth < 8.0:
            # The posterior surface beside the tip is no wall here.
            continue
        pose = drill_at(LEFT, float(depth))
        around = pose.rotation[:, 0] * np.cos(turn)[:, None] + pose.rotation[:, 1] * np.sin(turn)[:, None]
        reach = 2.0 + np.arange(0.0, clearance.now.clearance_mm - 0.15, 0.1)
        places = pose.translation_mm + reach[:, None, None] * around
        assert (bone_field(places) < 0.05).all()


def test_beyond_the_end_of_a_short_drill_nothing_is_measured() -> None:
    pose = drill_at(ROD_CHANNEL, 50.0, medial_mm=5.0, medial_deg=float(np.degrees(np.arctan(-5.0 / 50.0))))
    rings = drill_rings(pose, ROD_CHANNEL, _field("rod"), radius_mm=2.0, length_mm=10.0)
    now = clearance_of_drill(rings, pose, ROD_CHANNEL).now
    assert isinstance(now, NearestWall)
    assert now.clearance_mm > 0.5


@pytest.mark.parametrize("medial_deg", [89.99, 120.0, 180.0])
def test_a_drill_that_lies_across_or_points_backwards_is_still_measured(medial_deg: float) -> None:
    turn = np.radians(medial_deg)
    direction = np.array([-np.sin(turn), -np.cos(turn), 0.0])
    pose: Rigid[Vertebra, Tool] = Rigid(
        rotation=np.stack([np.cross(direction, [0, 0, 1.0]), [0, 0, 1.0], direction], axis=1)
        * [-1.0, 1.0, 1.0],
        translation_mm=np.array([0.0, 0.0, 0.0]),
    )
    clearance = _clearance(pose, ROD_CHANNEL, _field("rod"))
    assert isinstance(clearance.now, NearestWall)
    assert np.isfinite(clearance.now.clearance_mm)


@pytest.mark.parametrize("medial_mm", [0.0, 2.0, 4.5])
def test_the_planned_screw_has_a_clearance_at_each_depth(medial_mm: float) -> None:
    shift = np.array([-medial_mm, 0.0, 0.0])
    channel = Channel(
        name="left",
        entry_in_vertebra_mm=ROD_CHANNEL.entry_in_vertebra_mm + shift,
        target_in_vertebra_mm=ROD_CHANNEL.target_in_vertebra_mm + shift,
        radius_mm=2.0,
    )
    found = screw_clearance_along(channel, _field("rod"), diameter_mm=4.0, length_mm=59.0)
    assert found is not None
    # From the cortex to the end, where the front wall is 1 mm ahead.
    assert found.depth_mm[[0, -1]] == pytest.approx([2.5, 59.0], abs=0.6)
    assert np.diff(found.depth_mm).max() < 1.01
    side_mm = 5.0 - medial_mm - 2.0
    ahead_mm = 60.0 - found.depth_mm
    off_mm = found.clearance_mm - np.minimum(side_mm, ahead_mm)
    # Interpolation rounds off the ridge between two equally near walls, to the safe side.
    is_ridge = np.abs(side_mm - ahead_mm) < 0.6
    assert np.abs(off_mm[~is_ridge]).max() < 0.05
    assert -0.2 < off_mm.min() <= off_mm.max() < 0.05
    assert screw_clearance_along(channel, _field("rod"), diameter_mm=4.0, length_mm=1.0) is None
