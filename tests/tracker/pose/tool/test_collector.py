"""Collection of poses: which are accepted, which are not and why, and what is missing."""

import numpy as np
import pytest

from tests.tracker.pose.tool.pivoted import AXIS, TIP_MM, turns
from tracker.errors import CalibrationError
from tracker.geometry import Camera, Marker, Rigid, rotation_from_vector
from tracker.pose import Unseen, UnseenReason
from tracker.pose.tool import (
    CollectorSettings,
    Need,
    PivotCalibration,
    PoseCollector,
    Purpose,
    SpinCalibration,
    Taking,
    TipCheck,
)

SURE = np.diag([0.05**2] * 3 + [0.001**2] * 3)
HERE = rotation_from_vector([2.9, 0.4, 0.2])
RATE_HZ = 30.0


def placed(rotation_deg: tuple[float, float, float]) -> Rigid[Camera, Marker]:
    """The tool rotated about its tip, in the camera's frame."""
    rotation = rotation_from_vector(np.radians(rotation_deg)) @ HERE
    return Rigid(rotation=rotation, translation_mm=np.array([0.0, 0.0, 500.0]) - rotation @ np.array(TIP_MM))


def swept(
    collector: PoseCollector,
    path: list[tuple[float, float, float]],
    *,
    start_s: float = 0.0,
    rate_hz: float = RATE_HZ,
) -> float:
    """Feed a path; return the time after it."""
    for number, turn in enumerate(path):
        collector.take_pose(placed(turn), SURE, at_s=start_s + number / rate_hz)
    return start_s + len(path) / rate_hz


def circling(radius_deg: float, *, images: int = 300) -> list[tuple[float, float, float]]:
    """A spiral of the tool about its tip; the tool lies along the camera's y."""
    path = []
    for number in range(images):
        part = number / images
        angle = 8.0 * np.pi * part
        path.append((radius_deg * part * np.cos(angle), 0.0, radius_deg * part * np.sin(angle)))
    return path


def test_images_are_taken_or_passed_over_with_the_reason() -> None:
    collector = PoseCollector(Purpose.PIVOT)
    unseen = Unseen(reason=UnseenReason.NO_CANDIDATE)
    steps = [
        (collector.take(unseen, at_s=0.0), Taking.NOT_SEEN),
        (collector.take_pose(placed((0, 0, 0)), SURE, at_s=0.1), Taking.ALONE),
        (collector.take_pose(placed((0.5, 0, 0)), SURE, at_s=0.2), Taking.TAKEN),
        (collector.take_pose(placed((1.5, 0, 0)), SURE, at_s=0.25), Taking.NOTHING_NEW),
        (collector.take_pose(placed((4, 0, 0)), SURE, at_s=0.3), Taking.TAKEN),
        (collector.take_pose(placed((44, 0, 0)), SURE, at_s=0.33), Taking.JUMPED),
        (collector.take_pose(placed((6, 0, 0)), SURE, at_s=0.36), Taking.JUMPED),
        (collector.take_pose(placed((7, 0, 0)), SURE, at_s=0.4), Taking.TAKEN),
        (collector.take_pose(placed((10, 0, 0)), 1000.0 * SURE, at_s=0.43), Taking.TOO_UNCERTAIN),
        (collector.take_pose(placed((10, 0, 0)), SURE, at_s=1.5), Taking.ALONE),
        (collector.take_pose(placed((10, 0, 0)), SURE, at_s=1.5), Taking.ALONE),
        (collector.take_pose(placed((10, 0, 0)), SURE, at_s=1.6), Taking.TAKEN),
    ]
    for said, expected in steps:
        assert said is expected
    progress = collector.progress()
    assert progress.taken == len(collector.poses) == 4
    assert progress.rejected_images[Taking.JUMPED] == 2
    assert progress.rejected_images[Taking.NOT_SEEN] == 1


@pytest.mark.parametrize("rate_hz", [2.0, 3.0, 5.0, 7.0, 60.0])
def test_a_tip_is_calibrated_at_any_usual_image_rate(rate_hz: float) -> None:
    collector = PoseCollector(Purpose.PIVOT)
    swept(collector, circling(25.0), rate_hz=rate_hz)
    done = collector.progress()
    assert done.is_enough, done.missing
    # Until the rate is known.
    assert done.rejected_images.get(Taking.ALONE, 0) <= 3


def test_an_irregular_slow_camera_loses_no_pose_but_after_lost_images() -> None:
    random = np.random.default_rng(2)
    collector = PoseCollector(Purpose.PIVOT)
    intervals_s = 1.0 / random.uniform(5.0, 10.0, size=100)
    intervals_s[[30, 60]] = 0.54
    intervals_s[80] = 1.2
    takings = [
        collector.take_pose(placed(turn), SURE, at_s=float(at_s))
        for turn, at_s in zip(circling(25.0, images=100), np.cumsum(intervals_s), strict=True)
    ]
    assert [number for number, taking in enumerate(takings) if taking is Taking.ALONE] == [0, 80]


def test_a_wrong_pose_stands_out_however_slow_the_camera() -> None:
    collector = PoseCollector(Purpose.PIVOT)
    after_s = swept(collector, circling(25.0, images=40), rate_hz=2.0)
    # A hand could be anywhere after half a second, and is not while it pivots.
    assert collector.take_pose(placed((120.0, 0, 0)), SURE, at_s=after_s) is Taking.JUMPED


def test_progress_tells_which_tilt_is_missing_and_when_it_is_enough() -> None:
    collector = PoseCollector(Purpose.PIVOT)
    assert [missing.need for missing in collector.progress().missing] == [Need.MORE_POSES]
    line = [(float(angle), 0.0, 0.0) for angle in np.linspace(-25.0, 25.0, 120)]
    after_s = swept(collector, line)
    one_way = collector.progress()
    assert isinstance(one_way.outcome, CalibrationError)
    assert one_way.outcome.code == "PIVOT_TILT_TOO_SMALL"
    assert Need.TILT_ACROSS in [missing.need for missing in one_way.missing]
    assert Need.TILT_MORE not in [missing.need for missing in one_way.missing]
    assert not one_way.is_enough
    swept(collector, circling(25.0), start_s=after_s + 1.0)
    both = collector.progress()
    assert both.is_enough, both.missing
    assert isinstance(both.outcome, PivotCalibration)
    np.testing.assert_allclose(both.outcome.tip_in_marker_mm, TIP_MM, atol=1e-6)


def test_enough_motion_with_a_slipping_tip_is_not_enough() -> None:
    collector = PoseCollector(Purpose.PIVOT)
    random = np.random.default_rng(0)
    for number, turn in enumerate(circling(25.0, images=400)):
        pose = placed(turn)
        slipped: Rigid[Camera, Marker] = Rigid(
            rotation=pose.rotation, translation_mm=pose.translation_mm + random.normal(size=3) * 1.5
        )
        collector.take_pose(slipped, SURE, at_s=number / RATE_HZ)
    assert [missing.need for missing in collector.progress().missing] == [Need.BETTER_RESULT]


def test_a_still_tool_adds_nothing_and_the_store_has_an_end() -> None:
    collector = PoseCollector(Purpose.PIVOT, settings=CollectorSettings(max_poses=5))
    swept(collector, [(0.0, 0.0, 0.0)] * 50)
    assert collector.progress().taken == 1
    swept(collector, circling(25.0), start_s=2.0)
    assert collector.progress().taken == 5
    assert collector.progress().rejected_images[Taking.FULL] > 0


def test_a_spin_asks_for_spin_and_ends_with_the_axis() -> None:
    collector = PoseCollector(Purpose.SPIN, tip_in_marker_mm=120.0 * AXIS)
    angles = np.linspace(-15.0, 15.0, 60)
    rotations = HERE @ turns(np.radians(angles)[:, None] * AXIS)
    for number, rotation in enumerate(rotations):
        pose: Rigid[Camera, Marker] = Rigid(rotation=rotation, translation_mm=np.array([0.0, 0.0, 500.0]))
        collector.take_pose(pose, SURE, at_s=number / RATE_HZ)
    few = collector.progress()
    assert Need.SPIN_MORE in [missing.need for missing in few.missing]
    wide = HERE @ turns(np.radians(np.linspace(15.0, 120.0, 200))[:, None] * AXIS)
    for number, rotation in enumerate(wide):
        pose = Rigid(rotation=rotation, translation_mm=np.array([0.0, 0.0, 500.0]))
        collector.take_pose(pose, SURE, at_s=2.1 + number / RATE_HZ)
    done = collector.progress()
    assert done.is_enough, done.missing
    assert isinstance(done.outcome, SpinCalibration)
    np.testing.assert_allclose(done.outcome.axis_in_marker, AXIS, atol=1e-6)


def test_a_tip_check_needs_its_tip_and_ends_with_the_spread() -> None:
    with pytest.raises(CalibrationError, match="no tip"):
        PoseCollector(Purpose.TIP_CHECK)
    collector = PoseCollector(Purpose.TIP_CHECK, tip_in_marker_mm=np.array(TIP_MM))
    swept(collector, circling(25.0, images=400))
    done = collector.progress()
    assert done.is_enough, done.missing
    assert isinstance(done.outcome, TipCheck)
    assert done.outcome.rms_3d_mm < 1e-6
