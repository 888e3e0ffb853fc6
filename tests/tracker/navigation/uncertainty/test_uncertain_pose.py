"""Covariances along the chain from patient to drill, against Monte Carlo."""

from typing import TypeVar

import numpy as np
import pytest

from tracker.geometry import (
    Array,
    Camera,
    Marker,
    Rigid,
    Tool,
    Vertebra,
    point_covariance_mm2,
    vector_from_rotation,
)
from tracker.navigation.drill_reference import tool_in_vertebra
from tracker.navigation.uncertainty import (
    UncertainPose,
    check_tolerance,
    crossing_sds_mm,
    marker_from_tool,
    propagate_uncertainty,
    radius_95,
)
from tracker.navigation.uncertainty.tolerance import PedicleTolerance
from tracker.plan import Channel
from tracker.plan.screw import Tolerance
from tracker.pose import ToolModel

To = TypeVar("To")
From = TypeVar("From")
TOOL = ToolModel.from_tip_and_axis(
    name="drill",
    marker="drill",
    tip_in_marker_mm=(3.0, -120.0, -10.0),
    axis_in_marker=(0.02, -1.0, 0.0),
    radius_mm=2.0,
    length_mm=100.0,
    tip_covariance_mm2=np.diag([0.04, 0.09, 0.02]),
    axis_sd_deg=0.3,
)
CAMERA_FROM_MARKER: Rigid[Camera, Marker] = Rigid.from_vector([0.3, 2.6, -0.4], [20.0, -30.0, 450.0])
CAMERA_FROM_REFERENCE: Rigid[Camera, Marker] = Rigid.from_vector([2.8, 0.2, 0.3], [-60.0, 40.0, 520.0])
REFERENCE_FROM_VERTEBRA: Rigid[Marker, Vertebra] = Rigid.from_vector([0.2, 1.4, -0.3], [30.0, 12.0, -70.0])
RNG = np.random.default_rng(11)


def _covariance(mm: tuple[float, float, float], deg: tuple[float, float, float]) -> Array:
    mix = np.eye(6) + 0.3 * np.random.default_rng(5).standard_normal((6, 6))
    root = np.diag([*mm, *np.radians(deg)]) @ mix
    return np.asarray(root @ root.T)


def placed(pose: Rigid[To, From], covariance: Array) -> UncertainPose[To, From]:
    return UncertainPose(pose=pose, covariance=covariance)


MARKER_COVARIANCE = _covariance((0.05, 0.05, 0.4), (0.25, 0.25, 0.05))
REFERENCE_COVARIANCE = _covariance((0.04, 0.04, 0.3), (0.15, 0.2, 0.05))
REGISTRATION_COVARIANCE = _covariance((0.3, 0.3, 0.5), (0.4, 0.3, 0.3))


def _moved(pose: Rigid, covariance: Array, draws: int) -> list[Rigid]:  # pyrefly: ignore[implicit-any-type-argument]  # any frames
    root = np.linalg.cholesky(covariance + 1e-16 * np.eye(6))
    return [pose.displaced(step) for step in RNG.standard_normal((draws, 6)) @ root.T]


@pytest.mark.parametrize("with_reference", [True, False])
def test_the_chain_s_covariance_is_that_of_the_chain_drawn_at_random(*, with_reference: bool) -> None:
    draws = 3000
    tool = marker_from_tool(TOOL)
    reference_covariance = REFERENCE_COVARIANCE if with_reference else np.zeros((6, 6))
    anchor = placed(CAMERA_FROM_REFERENCE, reference_covariance)
    reported = tool_in_vertebra(
        anchor @ placed(REFERENCE_FROM_VERTEBRA, REGISTRATION_COVARIANCE),
        placed(CAMERA_FROM_MARKER, MARKER_COVARIANCE),
        TOOL,
    )
    steps = np.array(
        [
            np.concatenate(
                [
                    (pose := (a @ v).inverse @ (m @ t)).translation_mm - reported.pose.translation_mm,
                    vector_from_rotation(pose.rotation @ reported.pose.rotation.T),
                ]
            )
            for a, v, m, t in zip(
                _moved(anchor.pose, anchor.covariance, draws),
                _moved(REFERENCE_FROM_VERTEBRA, REGISTRATION_COVARIANCE, draws),
                _moved(CAMERA_FROM_MARKER, MARKER_COVARIANCE, draws),
                _moved(tool.pose, tool.covariance, draws),
                strict=True,
            )
        ]
    )
    drawn = np.cov(steps.T)
    scale = np.sqrt(np.outer(np.diag(reported.covariance), np.diag(reported.covariance)))
    # 3,000 draws determine a variance to 2.6 %, a correlation to 1.8 %.
    np.testing.assert_allclose(drawn / scale, reported.covariance / scale, atol=0.11)
    # The ellipsoid contains the tip, and the cone the axis, in 95 %.
    spread = propagate_uncertainty(reported, CHANNEL)
    inverse = np.linalg.inv(spread.tip_covariance_mm2)
    tips = steps[:, :3]
    assert np.mean(np.einsum("ni,ij,nj->n", tips, inverse, tips) < 7.815) == pytest.approx(0.95, abs=0.015)
    ways = np.cross(steps[:, 3:], reported.pose.rotation[:, 2])
    within = np.degrees(np.linalg.norm(ways, axis=1)) < spread.cone_95_deg
    assert np.mean(within) == pytest.approx(0.95, abs=0.015)


CHANNEL = Channel(
    name="L3 left",
    entry_in_vertebra_mm=np.zeros(3),
    target_in_vertebra_mm=np.array([0.0, -40.0, 0.0]),
    radius_mm=4.0,
)
POINT = np.array([7.0, -4.0, 11.0])


def test_the_uncertainty_of_a_point_agrees_with_the_geometry() -> None:
    point: Rigid[Marker, Tool] = Rigid(rotation=np.eye(3), translation_mm=POINT)
    there = placed(CAMERA_FROM_MARKER, MARKER_COVARIANCE) @ placed(point, np.zeros((6, 6)))
    expected = point_covariance_mm2(CAMERA_FROM_MARKER, MARKER_COVARIANCE, POINT)
    np.testing.assert_allclose(there.covariance[:3, :3], expected, atol=1e-12)


def test_back_and_forth_is_where_it_began() -> None:
    there = placed(CAMERA_FROM_MARKER, MARKER_COVARIANCE)
    np.testing.assert_allclose(there.inverse.inverse.covariance, MARKER_COVARIANCE, atol=1e-12)


def _drill(sd_mm: float, sd_deg: float, depth_mm: float) -> UncertainPose[Vertebra, Tool]:
    pose: Rigid[Vertebra, Tool] = Rigid(
        rotation=np.array([[1.0, 0, 0], [0, 0, -1.0], [0, 1.0, 0]]),
        translation_mm=np.array([0, -depth_mm, 0]),
    )
    return placed(pose, np.diag([sd_mm**2] * 3 + [np.radians(sd_deg) ** 2] * 3))


@pytest.mark.parametrize(
    ("sd_mm", "sd_deg", "tip_mm", "at_mm", "expected_mm"),
    [
        pytest.param(0.5, 0.0, 20.0, 0.0, 0.5, id="a-shift-is-the-same-everywhere"),
        pytest.param(0.0, 1.0, 20.0, 20.0, 0.0, id="a-turn-does-not-move-the-tip"),
        pytest.param(0.0, 1.0, 20.0, 0.0, 20.0 * np.pi / 180.0, id="a-turn-about-the-tip-moves-the-entry"),
        pytest.param(0.3, 1.0, 0.0, 22.918, 0.5, id="both-add-as-squares"),
    ],
)
def test_the_spread_along_the_line_is_what_a_hand_computes(
    sd_mm: float, sd_deg: float, tip_mm: float, at_mm: float, expected_mm: float
) -> None:
    larger, smaller = crossing_sds_mm(_drill(sd_mm, sd_deg, tip_mm), CHANNEL, depth_mm=at_mm)
    assert larger == pytest.approx(expected_mm, abs=1e-4)
    assert smaller == pytest.approx(expected_mm, abs=1e-4)


def test_a_drill_across_the_channel_meets_no_entry() -> None:
    lying: Rigid[Vertebra, Tool] = Rigid(rotation=np.eye(3), translation_mm=np.zeros(3))
    across = placed(lying, 0.01 * np.eye(6))
    assert propagate_uncertainty(across, CHANNEL).sd_at_entry_mm == np.inf
    assert not check_tolerance(across, CHANNEL, PedicleTolerance(tolerance_mm=2.0, lever_mm=18.0)).enough


def test_95_percent_of_a_plane_lie_within_the_radius() -> None:
    assert radius_95(1.0, 0.0) == pytest.approx(1.95996)
    assert radius_95(2.0, 2.0) == pytest.approx(2.0 * np.sqrt(-2.0 * np.log(0.05)), abs=1e-3)
    assert radius_95(0.0, 0.0) == 0.0
    for ratio in (0.25, 0.65, 0.95):
        draws = RNG.standard_normal((40_000, 2)) * [1.0, ratio]
        within = np.mean(np.hypot(*draws.T) < radius_95(1.0, ratio))
        assert within == pytest.approx(0.95, abs=0.004)


@pytest.mark.parametrize(("sd_mm", "enough"), [(0.5, True), (0.81, True), (0.82, False), (3.0, False)])
def test_navigation_is_enough_while_95_percent_fit_into_the_room(sd_mm: float, *, enough: bool) -> None:
    # 2.4477 sd of 2 mm: 0.817.
    certain = check_tolerance(
        _drill(sd_mm, 0.0, 0.0), CHANNEL, PedicleTolerance(tolerance_mm=2.0, lever_mm=18.0)
    )
    assert certain.enough is enough
    assert certain.isthmus_95_mm == pytest.approx(2.4477 * sd_mm, abs=1e-3)


def test_the_room_is_an_angle_where_the_pedicle_is_narrow() -> None:
    # 2 mm at 18 mm behind the entry: atan(1/9).
    tolerance = PedicleTolerance(tolerance_mm=2.0, lever_mm=18.0)
    assert tolerance.tolerance_deg == pytest.approx(6.3402, abs=1e-4)
    assert check_tolerance(_drill(0.5, 0.0, 0.0), CHANNEL, tolerance).tolerance_deg == tolerance.tolerance_deg


def test_the_room_is_that_of_the_plan_s_tolerance() -> None:
    plan_tolerance = Tolerance(
        offset_mm=np.array([0.0, 1.8]),
        deg_at_offset=np.array([5.1428, 0.0]),
        max_offset_mm=1.8,
        max_angle_deg=5.1428,
        both_mm=0.9,
        both_deg=2.57,
    )
    tolerance = PedicleTolerance.of_tolerance(plan_tolerance)
    assert [tolerance.tolerance_mm, tolerance.lever_mm] == pytest.approx([1.8, 20.0], abs=1e-3)


def test_a_plan_without_room_is_never_certain_enough() -> None:
    none = PedicleTolerance.of_channel(CHANNEL, radius_mm=4.5)
    assert none.tolerance_mm == 0.0
    assert not check_tolerance(_drill(0.0, 0.0, 0.0), CHANNEL, none).enough
