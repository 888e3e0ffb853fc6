"""Breach probabilities: analytically for one error direction, and against Monte Carlo."""

from functools import lru_cache

import numpy as np
import pytest
from scipy.special import ndtr

from tests.tracker.navigation.bones import ROD_CHANNEL, drill_at, rod
from tracker.geometry import Array, Rigid, Tool, Vertebra, skew
from tracker.navigation.clearance import WallDistanceField, bone_distance_field
from tracker.navigation.clearance.rings import rings_to_wall
from tracker.navigation.uncertainty import (
    Drill,
    DrillAnalysis,
    UncertainPose,
    analyse_drill,
    past_planned_ratio,
)
from tracker.navigation.uncertainty.tolerance import PedicleTolerance
from tracker.plan import Channel
from tracker.plan.screw import GertzbeinRobbins, grade_of_breach
from tracker.rehearsal.anatomy import pedicle_channels, vertebra_surface

LEFT = pedicle_channels()[0]
DRAWS = 3000


@lru_cache(maxsize=2)
def _field(name: str) -> WallDistanceField:
    if name == "rod":
        return bone_distance_field(rod(), ROD_CHANNEL, margin_mm=20.0)
    return bone_distance_field(vertebra_surface(), LEFT)


def _judged(
    pose: Rigid[Vertebra, Tool],
    covariance: Array,
    name: str = "rod",
    *,
    wall_sd_mm: float = 0.0,
    channel: Channel = ROD_CHANNEL,
) -> DrillAnalysis:
    return analyse_drill(
        UncertainPose(pose=pose, covariance=covariance),
        channel,
        _field(name),
        PedicleTolerance(tolerance_mm=1.5, lever_mm=18.0),
        Drill(radius_mm=2.0, length_mm=100.0),
        side="left",
        wall_sd_mm=wall_sd_mm,
    )


def _shift(sd_mm: tuple[float, float, float]) -> Array:
    return np.diag([*np.square(sd_mm), 0.0, 0.0, 0.0])


@pytest.mark.parametrize("medial_mm", [1.5, 2.5, 3.0, 3.4, 5.5])
@pytest.mark.parametrize("sd_mm", [0.2, 0.5])
def test_an_error_in_one_direction_gives_the_normal_distribution(medial_mm: float, sd_mm: float) -> None:
    judged = _judged(drill_at(ROD_CHANNEL, 30.0, medial_mm=medial_mm), _shift((sd_mm, 0.0, 0.0)))
    # On the other side the rod ends at the same distance: 3 mm to both.
    expected = ndtr((medial_mm - 3.0) / sd_mm) + ndtr((-medial_mm - 3.0) / sd_mm)
    assert judged.now.through_ratio == pytest.approx(expected, abs=0.02)
    assert judged.now.sd_mm == pytest.approx(sd_mm, rel=0.05)


def test_both_walls_of_a_tight_place_count() -> None:
    judged = _judged(drill_at(ROD_CHANNEL, 30.0), _shift((1.5, 0.0, 0.0)))
    assert judged.now.through_ratio == pytest.approx(2.0 * ndtr(-3.0 / 1.5), abs=0.01)


def test_a_wall_that_is_unsure_makes_as_probable_as_a_drill_that_is() -> None:
    pose = drill_at(ROD_CHANNEL, 30.0, medial_mm=2.4)
    unsure_wall = _judged(pose, np.zeros((6, 6)), wall_sd_mm=0.5)
    assert unsure_wall.now.through_ratio == pytest.approx(float(ndtr(-0.6 / 0.5)), abs=0.02)


@pytest.mark.parametrize(("medial_mm", "through"), [(2.5, 0.0), (3.5, 1.0)])
def test_without_any_uncertainty_it_is_or_it_is_not(medial_mm: float, through: float) -> None:
    judged = _judged(drill_at(ROD_CHANNEL, 30.0, medial_mm=medial_mm), np.zeros((6, 6)))
    assert judged.now.through_ratio == through
    assert judged.now.grade_ratio[GertzbeinRobbins.B] == through


def test_a_drill_that_hovers_has_no_chance_of_a_breach_but_its_direction_may_have() -> None:
    judged = _judged(drill_at(ROD_CHANNEL, -5.0, medial_deg=8.0), _shift((0.2, 0.2, 0.2)))
    assert judged.now.through_ratio == 0.0
    assert judged.at_end.through_ratio > 0.99


def test_two_millimetres_before_the_front_wall_the_breach_is_announced() -> None:
    judged = _judged(drill_at(ROD_CHANNEL, 58.5), _shift((0.1, 0.3, 0.1)))
    assert judged.now.through_ratio < 0.01
    assert judged.lookahead.through_ratio == pytest.approx(float(ndtr(0.5 / 0.3)), abs=0.02)


def test_the_end_of_the_plan_is_passed_by_chance_too() -> None:
    assert past_planned_ratio(0.0, 0.5) == 0.5
    assert past_planned_ratio(0.98, 0.5) == pytest.approx(0.975, abs=1e-3)
    assert (past_planned_ratio(-0.1, 0.0), past_planned_ratio(0.1, 0.0)) == (0.0, 1.0)
    judged = _judged(drill_at(ROD_CHANNEL, 54.0), _shift((0.0, 1.0, 0.0)))
    assert judged.past_planned_ratio == pytest.approx(float(ndtr(-1.0)))


def _behind(pose: Rigid[Vertebra, Tool], sd_mm: float, sd_deg: float) -> Array:
    """A marker some centimetres behind the tip, less certain along one axis: both errors correlate."""
    own = np.diag([sd_mm**2, sd_mm**2, (2.5 * sd_mm) ** 2, *[np.radians(sd_deg) ** 2] * 3])
    carry = np.eye(6)
    carry[:3, 3:] = -skew(80.0 * pose.rotation[:, 2])
    return np.asarray(carry @ own @ carry.T)


@pytest.mark.parametrize(
    ("depth_mm", "medial_mm", "cranial_mm", "medial_deg", "cranial_deg", "sd_mm", "sd_deg"),
    [
        pytest.param(20.0, 0.5, 0.0, 0.0, 0.0, 0.3, 0.5, id="on-plan"),
        pytest.param(24.0, 1.0, 0.0, 3.0, 0.0, 0.3, 0.4, id="towards-the-canal"),
        pytest.param(42.0, 0.0, -4.5, 0.0, 0.0, 0.1, 1.5, id="by-the-shaft-where-the-angle-errs"),
        pytest.param(26.0, 2.0, 2.0, 5.0, 4.0, 0.4, 0.8, id="oblique-and-through"),
    ],
)
def test_probabilities_are_those_of_drills_drawn_at_random(
    depth_mm: float,
    medial_mm: float,
    cranial_mm: float,
    medial_deg: float,
    cranial_deg: float,
    sd_mm: float,
    sd_deg: float,
) -> None:
    pose = drill_at(
        LEFT,
        depth_mm,
        medial_mm=medial_mm,
        cranial_mm=cranial_mm,
        medial_deg=medial_deg,
        cranial_deg=cranial_deg,
    )
    covariance = _behind(pose, sd_mm, sd_deg)
    judged = _judged(pose, covariance, "vertebra", channel=LEFT)
    now, lookahead = _drawn(pose, covariance)
    assert judged.now.through_ratio == pytest.approx(np.mean(now < 0.0), abs=0.03)
    assert judged.lookahead.through_ratio == pytest.approx(np.mean(lookahead < 0.0), abs=0.03)
    grades = [grade_of_breach(float(-clearance)) for clearance in now]
    for grade, ratio in judged.now.grade_ratio.items():
        assert ratio == pytest.approx(grades.count(grade) / DRAWS, abs=0.06)
    assert sum(judged.now.grade_ratio.values()) == pytest.approx(1.0)


def _drawn(pose: Rigid[Vertebra, Tool], covariance: Array) -> tuple[Array, Array]:
    steps = np.random.default_rng(7).standard_normal((DRAWS, 6)) @ np.linalg.cholesky(covariance).T
    minimum = np.empty((2, DRAWS))
    for n, step in enumerate(steps):
        moved = pose.displaced(step)
        for m, ahead_mm in enumerate((0.0, 2.0)):
            rings = rings_to_wall(
                moved, LEFT, _field("vertebra"), radius_mm=2.0, length_mm=100.0, ahead_mm=ahead_mm
            )
            minimum[m, n] = rings.clearance_mm.min(initial=np.inf)
    return minimum[0], minimum[1]
