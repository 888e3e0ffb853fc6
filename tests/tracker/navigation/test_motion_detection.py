"""Whether the camera or the patient marker moved, at 30 images/s."""

import cv2
import numpy as np
import numpy.typing as npt
import pytest

from tracker.camera import CameraModel
from tracker.geometry import Camera, Marker, Rigid
from tracker.navigation import Absent, AbsentReason, MotionMonitor, MotionState, Setup
from tracker.pose import Seen

Picture = npt.NDArray[np.uint8]
SIZE, HZ, MOVES_S, LASTS_S = (640, 360), 30.0, 1.05, 3.0
CORNERS_PX = np.array([[20.0, 20.0], [60.0, 20.0], [60.0, 60.0], [20.0, 60.0]])
SETUP = Setup(
    camera=CameraModel(
        matrix=np.array([[700.0, 0, 320], [0, 700, 180], [0, 0, 1]]),
        distortion=np.zeros(5),
        size_wh_px=SIZE,
    ),
    camera_calibrated=True,
    tools={},
    channel=Absent(reason=AbsentReason.NO_PLAN),
    registration=Absent(reason=AbsentReason.NOT_REGISTERED),
    reference="reference",
)


def _scene() -> Picture:
    random = np.random.default_rng(3)
    rough = random.normal(128.0, 60.0, (SIZE[1] // 8, SIZE[0] // 8)).clip(0, 255).astype(np.uint8)
    return np.asarray(cv2.resize(rough, SIZE, interpolation=cv2.INTER_CUBIC), dtype=np.uint8)


def _shifted(scene: Picture, shift_px: float, relief_ratio: float) -> Picture:
    """Moved sideways; nearer things move more."""
    rows, columns = np.mgrid[: SIZE[1], : SIZE[0]].astype(np.float32)
    more = 1.0 + relief_ratio * np.sin(rows / 60.0)
    moved = cv2.remap(scene, (columns - shift_px * more).astype(np.float32), rows, cv2.INTER_LINEAR)
    return np.asarray(moved, dtype=np.uint8)


def _reference(shift_mm: float) -> Seen:
    pose: Rigid[Camera, Marker] = Rigid(rotation=np.eye(3), translation_mm=np.array([shift_mm, 0.0, 450.0]))
    return Seen(
        camera_from_marker=pose,
        pose_covariance=np.eye(6) * 1e-6,
        corners_px=CORNERS_PX,
        score_ratio=0.9,
        target_score_ratio=0.9,
        model_coverage_ratio=1.0,
        target_coverage_ratio=1.0,
        fit_error_px2=0.1,
        found_by="track",
    )


def _watched(*, camera_px: float, reference_mm: float, relief_ratio: float = 0.0) -> list[MotionState]:
    """Results for each image after the move."""
    scene, watching = _scene(), MotionMonitor()
    before, after = scene, _shifted(scene, camera_px, relief_ratio)
    said = []
    for number in range(round(LASTS_S * HZ)):
        at_s = number / HZ
        has_moved = at_s >= MOVES_S
        seen = {"reference": _reference(reference_mm if has_moved else 0.0)}
        motion = watching.take(SETUP, after if has_moved else before, seen, at_s=at_s)
        if has_moved:
            said.append(motion)
    return said


@pytest.mark.parametrize("relief_ratio", [0.0, 0.15])
def test_a_camera_that_moved_is_never_taken_for_a_reference_that_moved(relief_ratio: float) -> None:
    said = _watched(camera_px=20.0, reference_mm=13.0, relief_ratio=relief_ratio)
    assert said[-1].camera_moved
    assert [each.camera_moved for each in said].index(True) < 0.9 * HZ
    assert not any(each.reference_moved for each in said)


def test_a_reference_that_moved_is_reported_soon_and_not_taken_for_a_camera() -> None:
    said = _watched(camera_px=0.0, reference_mm=13.0)
    assert [each.reference_moved for each in said].index(True) < 0.5 * HZ
    assert not any(each.camera_moved for each in said)


def test_where_nothing_moves_nothing_is_said() -> None:
    said = _watched(camera_px=0.0, reference_mm=0.0)
    assert not any(each.camera_moved or each.reference_moved for each in said)


def test_a_breathing_patient_before_a_still_scene_keeps_the_registration() -> None:
    scene, watching = _scene(), MotionMonitor()
    said = []
    for number in range(round(24.0 * HZ)):
        at_s = number / HZ
        breath_mm = 4.0 * (1.0 - np.cos(2.0 * np.pi * at_s / 4.0))
        motion = watching.take(SETUP, scene, {"reference": _reference(breath_mm)}, at_s=at_s)
        said.append(motion.reference_moved)
    assert any(said[: round(8.0 * HZ)]), "the first two breaths are doubted"
    assert not any(said[round(8.0 * HZ) :])
