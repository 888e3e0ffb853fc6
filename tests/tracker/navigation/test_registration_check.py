"""Whether a registration suffices for one screw."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.camera import CameraModel
from tracker.geometry import Anchor, Array, Camera, Marker, Rigid, Tool, Vertebra, rotation_from_vector
from tracker.navigation import (
    Assessment,
    DrillReference,
    FigureName,
    Setup,
    Verdict,
    check_registration,
    check_setup,
    min_errors_95_mm,
    navigate,
)
from tracker.navigation.clearance.outline_field import channel_distance_field
from tracker.navigation.directions import channel_directions
from tracker.navigation.uncertainty import PedicleTolerance, UncertainPose, radius_95
from tracker.plan import Channel
from tracker.pose import Seen, ToolModel
from tracker.registration import AnchoredTo, Method, Registration

CHANNEL = Channel(
    name="L3 left",
    entry_in_vertebra_mm=np.array([20.0, 0.0, 0.0]),
    target_in_vertebra_mm=np.array([20.0, -40.0, 0.0]),
    radius_mm=3.0,
)
POSE: Rigid[Vertebra, Anchor] = Rigid(
    rotation=rotation_from_vector(np.array([0.4, -0.2, 0.9])), translation_mm=np.array([5.0, -60.0, 300.0])
)


def registered(sd_mm: float) -> UncertainPose[Vertebra, Anchor]:
    return UncertainPose(pose=POSE, covariance=np.diag([sd_mm**2] * 3 + [0.0] * 3))


def tolerance(mm: float) -> PedicleTolerance:
    return PedicleTolerance(tolerance_mm=mm, lever_mm=18.0)


def test_a_shift_moves_entry_and_isthmus_alike() -> None:
    # 95 % of a round normal distribution lie within 2.44775 standard deviations.
    check = check_registration(registered(0.2), CHANNEL, tolerance(0.5))
    assert (check.entry_95_mm, check.isthmus_95_mm) == (0.49, 0.49)
    assert check.suffices
    assert check.diameter_excess_mm == 0.0


def test_a_rotation_moves_the_isthmus_more_than_the_entry_by_its_lever() -> None:
    # The anchor's origin is that of the plan: rotations are about it.
    pose: Rigid[Vertebra, Anchor] = Rigid(rotation=POSE.rotation, translation_mm=np.zeros(3))
    registration = UncertainPose(pose=pose, covariance=np.diag([0.0, 0.0, 0.0, 1e-4, 1e-4, 1e-4]))
    check = check_registration(registration, CHANNEL, tolerance(5.0))
    # At (20, 0, 0) mm only the rotation about y, 0.01 rad, moves the drill across: 0.2 mm along z.
    assert check.entry_95_mm == pytest.approx(1.96 * 0.2, abs=0.01)
    # At (20, -18, 0) mm: 0.01 * 26.9 mm along z and 0.01 * 18 mm along x; 2.13 by the ratio of both.
    assert check.isthmus_95_mm == pytest.approx(2.13 * 0.269, abs=0.02)


def test_a_screw_that_fills_the_pedicle_is_too_thick_by_twice_what_is_missing() -> None:
    check = check_registration(registered(0.4), CHANNEL, tolerance(0.5))
    assert check.error_95_mm == 0.98
    assert not check.suffices
    assert check.diameter_excess_mm == 1.0
    thinner = check_registration(registered(0.4), CHANNEL, tolerance(0.5 + 0.5 * check.diameter_excess_mm))
    assert thinner.suffices


def test_a_screw_that_leaves_nothing_gets_no_figure() -> None:
    assert check_registration(registered(0.4), CHANNEL, tolerance(0.0)).diameter_excess_mm is None


def drill(*, tip_sd_mm: float = 0.0, axis_sd_deg: float = 0.0, name: str = "drill") -> ToolModel:
    tool = ToolModel.from_tip_and_axis(
        name=name,
        marker="drill",
        tip_in_marker_mm=[0.0, -100.0, -10.0],
        axis_in_marker=[0.0, -1.0, 0.0],
        radius_mm=1.5,
        length_mm=100.0,
    )
    return replace(tool, tip_covariance_mm2=tip_sd_mm**2 * np.eye(3), axis_sd_deg=axis_sd_deg)


def registration(
    covariance: Array | None = None,
    *,
    tip_jacobian: Array | None = None,
    tracking_sd_mm: float = 0.0,
) -> Registration:
    return Registration(
        method=Method.POINTS,
        anchored_to=AnchoredTo.CAMERA,
        anchor_from_vertebra=POSE.inverse,
        covariance=np.zeros((6, 6)) if covariance is None else covariance,
        tip_jacobian=np.zeros((6, 3)) if tip_jacobian is None else tip_jacobian,
        tool="drill",
        tracking_covariance_mm2=tracking_sd_mm**2 * np.eye(3),
    )


def shift(sd_mm: float) -> Array:
    return np.diag([sd_mm**2] * 3 + [0.0] * 3)


@pytest.mark.parametrize(
    ("registered", "tool", "error_95_mm"),
    [
        pytest.param(registration(), drill(), 0.0, id="all-exact"),
        # 95 % of a round normal distribution lie within 2.44775 standard deviations.
        pytest.param(registration(shift(0.2)), drill(), 0.49, id="the-registration"),
        pytest.param(registration(), drill(tip_sd_mm=0.2), 0.49, id="the-tip"),
        pytest.param(registration(tracking_sd_mm=0.2), drill(), 0.49, id="tracking"),
        pytest.param(
            # The root of 0.3^2 + 0.2^2 + 0.6^2 is 0.7.
            registration(shift(0.3), tracking_sd_mm=0.6),
            drill(tip_sd_mm=0.2),
            1.72,
            id="all-three-in-quadrature",
        ),
        # The tip half way to the isthmus: 9 mm to either, times 0.0087 rad times 2.44775.
        pytest.param(registration(), drill(axis_sd_deg=0.5), 0.2, id="the-axis-with-the-shortest-lever"),
    ],
)
def test_the_least_error_of_a_set_up_has_registration_tool_and_tracking(
    registered: Registration, tool: ToolModel, error_95_mm: float
) -> None:
    check = check_setup(registered, tool, CHANNEL, tolerance(1.0))
    assert check.error_95_mm == error_95_mm
    assert check.suffices == (error_95_mm <= 1.0)


def test_a_tip_that_registered_cancels_where_the_drill_can_be_held_as_at_the_captures() -> None:
    # Captured with the marker as on the planned channel, rotated by 60 degrees about it.
    across = channel_directions(CHANNEL)
    side = np.cross(across.cranial, across.axis)
    planned = np.column_stack([side, across.cranial, across.axis]) @ rotation_from_vector(
        [0.0, 0.0, np.pi / 3]
    )
    tool = drill(tip_sd_mm=0.2)
    anchor_from_marker = POSE.inverse.rotation @ planned @ tool.marker_from_tool.inverse.rotation
    jacobian = np.vstack([anchor_from_marker, np.zeros((3, 3))])
    registered = registration(jacobian @ tool.tip_covariance_mm2 @ jacobian.T, tip_jacobian=jacobian)
    assert check_setup(registered, tool, CHANNEL, tolerance(1.0)).error_95_mm == pytest.approx(0.0, abs=0.01)
    # Errors of different tools are independent: the root of two errors of 0.2 mm.
    other = drill(tip_sd_mm=0.2, name="awl")
    assert check_setup(registered, other, CHANNEL, tolerance(1.0)).error_95_mm == 0.7


COLUMN = st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6)


@settings(deadline=None, max_examples=25)
@given(
    first=COLUMN, second=COLUMN, more=COLUMN, tip_sd_mm=st.floats(0.0, 0.5), allowed_mm=st.floats(0.0, 3.0)
)
def test_a_larger_error_of_the_registration_never_makes_a_set_up_sufficient(
    first: list[float], second: list[float], more: list[float], tip_sd_mm: float, allowed_mm: float
) -> None:
    scale = np.array([1.0] * 3 + [0.01] * 3)
    columns = [scale * np.array(one) for one in (first, second, more)]
    less = sum((np.outer(one, one) for one in columns[:2]), np.zeros((6, 6)))
    greater = less + np.outer(columns[2], columns[2])
    jacobian = np.vstack([POSE.inverse.rotation, np.zeros((3, 3))])
    smaller, larger = (
        check_setup(
            registration(covariance, tip_jacobian=jacobian),
            drill(tip_sd_mm=tip_sd_mm),
            CHANNEL,
            tolerance(allowed_mm),
        )
        for covariance in (less, greater)
    )
    assert larger.error_95_mm >= smaller.error_95_mm
    assert smaller.suffices or not larger.suffices


def test_what_navigation_states_of_a_drill_on_its_channel_is_never_less() -> None:
    registered = registration(shift(0.3), tracking_sd_mm=0.1)
    tool = drill(tip_sd_mm=0.2, axis_sd_deg=0.3)
    reference = DrillReference(wall=channel_distance_field(CHANNEL), tolerance=tolerance(0.5))
    setup = Setup(
        camera=CameraModel(
            matrix=np.array([[1400.0, 0.0, 640.0], [0.0, 1400.0, 360.0], [0.0, 0.0, 1.0]]),
            distortion=np.zeros(5),
            size_wh_px=(1280, 720),
        ),
        camera_calibrated=True,
        tools={"drill": tool},
        channel=CHANNEL,
        registration=registered,
    )
    (min_mm,) = min_errors_95_mm(setup, reference).values()
    assert min_mm == check_setup(registered, tool, CHANNEL, tolerance(0.5)).error_95_mm
    setup = replace(setup, min_errors_95_mm={"drill": min_mm})
    across = channel_directions(CHANNEL)
    for depth_mm in (-5.0, 0.0, 9.0, 18.0, 30.0):
        for turn in ([0.0, 0.0, 0.0], [0.0, 0.0, 2.0]):
            planned: Rigid[Vertebra, Tool] = Rigid(
                rotation=np.column_stack([np.cross(across.cranial, across.axis), across.cranial, across.axis])
                @ rotation_from_vector(turn),
                translation_mm=CHANNEL.entry_in_vertebra_mm + depth_mm * across.axis,
            )
            pose = POSE.inverse @ planned @ tool.marker_from_tool.inverse
            camera_from_marker: Rigid[Camera, Marker] = Rigid(
                rotation=pose.rotation, translation_mm=pose.translation_mm
            )
            seen = Seen(
                camera_from_marker=camera_from_marker,
                pose_covariance=shift(0.1),
                corners_px=np.zeros((4, 2)),
                score_ratio=0.9,
                target_score_ratio=0.9,
                model_coverage_ratio=0.9,
                target_coverage_ratio=0.9,
                fit_error_px2=0.1,
                found_by="track",
            )
            snapshot = navigate(
                setup=setup,
                sightings={"drill": seen},
                image_number=0,
                captured_at_s=0.0,
                size_wh_px=(1280, 720),
                stage_ms={},
                skipped_images=0,
                drill_reference=reference,
            )
            assessment = snapshot.assessments["drill"]
            assert isinstance(assessment, Assessment)
            assert assessment.figures[FigureName.ERROR].value >= min_mm
            assert assessment.verdict in (Verdict.SETUP_INSUFFICIENT, Verdict.BREACH_LIKELY)


@pytest.mark.parametrize("value", [np.nan, 1e100, 1e300])
@pytest.mark.parametrize("axis", range(3))
def test_an_error_that_is_not_a_usual_number_never_suffices(value: float, axis: int) -> None:
    covariance = shift(0.1)
    covariance[axis, axis] = value
    found = check_registration(UncertainPose(pose=POSE, covariance=covariance), CHANNEL, tolerance(2.0))
    assert not found.suffices


@pytest.mark.parametrize("sds_mm", [(np.nan, 0.1), (0.1, np.nan), (np.nan, np.nan), (np.inf, 0.1)])
def test_the_radius_of_an_unknown_error_is_infinite(sds_mm: tuple[float, float]) -> None:
    assert radius_95(*sds_mm) == np.inf
