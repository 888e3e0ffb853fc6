"""The axis by spinning, and a tip checked in a divot: against known truth, and rejected where blind."""

import numpy as np
import pytest

from tests.tracker.pose.tool.pivoted import AXIS, TIP_MM, Hand, pivoted, spun
from tracker.errors import CalibrationError, InvalidInput
from tracker.geometry import angle_between_deg
from tracker.pose.tool import Poses, ToolGate, ToolModel, check_tip, spin_calibration

CHI_SQUARE_95_OF_2 = 5.991
TIP = 120.0 * AXIS


def test_the_axis_is_found_with_its_sign_from_the_tip() -> None:
    exact = spun(wobble_deg=0.0, turn_sd_deg=0.0)
    for tip, sign in ((TIP, 1.0), (-TIP, -1.0)):
        found = spin_calibration(exact, tip_in_marker_mm=tip)
        np.testing.assert_allclose(found.axis_in_marker, sign * AXIS, atol=1e-9)
        assert found.points_to_tip
    assert found.wobble_deg < 1e-6
    assert found.spin_range_deg == pytest.approx(160.0, abs=12.0)
    assert not spin_calibration(exact).points_to_tip


def test_the_axis_lies_inside_its_ellipse_as_often_as_is_said() -> None:
    inside, runs = 0, 150
    for seed in range(runs):
        found = spin_calibration(spun(seed=seed, outliers=6), tip_in_marker_mm=TIP)
        across = np.linalg.svd(found.axis_in_marker[None, :])[2][1:]
        off = across @ AXIS
        covariance = across @ found.axis_covariance_rad2 @ across.T
        inside += float(off @ np.linalg.solve(covariance, off)) < CHI_SQUARE_95_OF_2
        assert angle_between_deg(found.axis_in_marker, AXIS) < 1.5
    assert 0.91 <= inside / runs <= 0.99


@pytest.mark.parametrize(
    ("poses", "code"),
    [
        pytest.param(spun(arc_deg=40.0), "SPIN_TOO_SMALL", id="a-ninth-of-a-turn"),
        pytest.param(spun(wobble_deg=9.0), "SPIN_WOBBLES", id="wobbling"),
        pytest.param(spun(count=9), "TOOL_TOO_FEW_POSES", id="nine-poses"),
        pytest.param(
            pivoted(Hand(tilts_deg=(40.0, 0.0), spin_deg=0.0)).poses, "SPIN_NOT_ABOUT_TOOL", id="tilted"
        ),
        pytest.param(spun().of(np.zeros(60, dtype=np.int_)), "TOOL_TOO_FEW_POSES", id="one-pose"),
    ],
)
def test_a_motion_that_is_no_spin_is_rejected(poses: Poses, code: str) -> None:
    with pytest.raises(CalibrationError) as caught:
        spin_calibration(poses, tip_in_marker_mm=TIP)
    assert caught.value.code == code
    assert caught.value.context


def test_an_unsure_axis_fails_the_gate_with_its_numbers() -> None:
    found = spin_calibration(spun(count=15, arc_deg=90.0, wobble_deg=3.0), tip_in_marker_mm=TIP)
    assert [failure.code for failure in found.failures(ToolGate())] == ["SPIN_AXIS_UNCERTAIN"]
    assert spin_calibration(spun(), tip_in_marker_mm=TIP).failures(ToolGate()) == ()


def test_a_tip_at_the_marker_gives_no_sign() -> None:
    with pytest.raises(InvalidInput, match="no direction"):
        spin_calibration(spun(), tip_in_marker_mm=[0.0, 0.0, 0.0])


def test_tip_and_axis_make_the_tool() -> None:
    found = spin_calibration(spun(), tip_in_marker_mm=TIP)
    tool = ToolModel.from_tip_and_axis(
        name="awl",
        marker="awl",
        tip_in_marker_mm=TIP,
        axis_in_marker=found.axis_in_marker,
        radius_mm=2.0,
        length_mm=100.0,
    )
    ahead = tool.marker_from_tool.move_points([0.0, 0.0, 10.0])
    assert np.linalg.norm(ahead) == pytest.approx(130.0, abs=0.05)


def test_a_right_tip_stays_and_a_wrong_one_wanders_by_what_the_tilt_makes_of_it() -> None:
    poses = pivoted(Hand(shift_sd_mm=0.0, turn_sd_deg=(0.0, 0.0, 0.0))).poses
    right = check_tip(poses, TIP_MM)
    assert right.rms_3d_mm < 1e-9
    assert right.failures(ToolGate()) == ()
    error = np.array([3.0, 0.0, 0.0])
    wrong = check_tip(poses, TIP_MM + error)
    moved = poses.rotations @ error
    expected = np.sqrt(((moved - moved.mean(axis=0)) ** 2).sum(axis=1).mean())
    assert wrong.rms_3d_mm == pytest.approx(expected)
    assert wrong.max_mm > wrong.rms_3d_mm > wrong.rms_by_axis_mm.max()
    assert wrong.rms_3d_mm == pytest.approx(float(np.linalg.norm(wrong.rms_by_axis_mm)))
    assert [failure.code for failure in check_tip(poses, TIP_MM + 3.0 * error).failures(ToolGate())] == [
        "TIP_CHECK_FAILED"
    ]


def test_no_pose_is_left_out_of_a_check() -> None:
    made = pivoted(Hand(outlier_ratio=0.1), seed=2)
    assert made.is_outlier.any()
    assert check_tip(made.poses, TIP_MM).poses == 60
    assert check_tip(made.poses, TIP_MM).failures(ToolGate())


@pytest.mark.parametrize(
    ("hand", "code"),
    [
        pytest.param(
            Hand(tilts_deg=(3.0, 3.0), spin_deg=3.0), "TIP_CHECK_TILT_TOO_SMALL", id="hardly-tilted"
        ),
        pytest.param(Hand(tilts_deg=(40.0, 0.0), spin_deg=0.0), "TIP_CHECK_TILT_TOO_SMALL", id="one-plane"),
        pytest.param(Hand(count=5), "TOOL_TOO_FEW_POSES", id="five-poses"),
    ],
)
def test_a_check_that_would_not_show_a_wrong_tip_is_rejected(hand: Hand, code: str) -> None:
    with pytest.raises(CalibrationError) as caught:
        check_tip(pivoted(hand).poses, TIP_MM)
    assert caught.value.code == code
