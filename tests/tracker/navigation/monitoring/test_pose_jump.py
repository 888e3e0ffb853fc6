"""Pose jumps: plausible motion is accepted at once, a jump only after consistent images."""

import numpy as np
import pytest

from tracker.geometry import Camera, Marker, Rigid, rotation_from_vector
from tracker.navigation.monitoring import (
    MotionKind,
    PoseJumpCheck,
    PoseJumpDetector,
    PoseJumpSettings,
    is_flipped,
)

IMAGE_S = 1.0 / 30.0
FACING = rotation_from_vector([np.pi, 0.0, 0.0])


def _pose(
    x_mm: float = 0.0, rotation_deg: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> Rigid[Camera, Marker]:
    return Rigid(
        rotation=rotation_from_vector(np.radians(rotation_deg)) @ FACING,
        translation_mm=np.array([x_mm, 10.0, 400.0]),
    )


def _fed(watch: PoseJumpDetector, poses: list[Rigid[Camera, Marker]], start: int = 0) -> list[PoseJumpCheck]:
    return [watch.take(pose, at_s=(start + n) * IMAGE_S) for n, pose in enumerate(poses)]


def test_the_first_pose_and_a_fast_hand_are_believed() -> None:
    # 450 mm/s and 150 deg/s.
    poses = [_pose(15.0 * n, (0.0, 5.0 * n, 0.0)) for n in range(20)]
    assert all(
        jump.accepted and jump.moved is MotionKind.PLAUSIBLE for jump in _fed(PoseJumpDetector(), poses)
    )


@pytest.mark.parametrize(
    "elsewhere",
    [pytest.param(_pose(40.0), id="a-shift"), pytest.param(_pose(0.0, (0.0, 0.0, 30.0)), id="a-turn")],
)
def test_one_jump_is_not_believed_and_forgotten_when_it_is_over(elsewhere: Rigid[Camera, Marker]) -> None:
    jumps = _fed(PoseJumpDetector(), [_pose(), _pose(), elsewhere, _pose(), _pose()])
    assert [jump.accepted for jump in jumps] == [True, True, False, True, True]
    assert jumps[2].moved is MotionKind.JUMPED


def test_a_jump_is_believed_when_five_images_agree() -> None:
    jumps = _fed(PoseJumpDetector(), [_pose()] + [_pose(60.0 + n) for n in range(7)])
    assert [jump.accepted for jump in jumps] == [True, False, False, False, False, True, True, True]
    assert jumps[5].images == 5


def test_poses_that_jump_about_are_never_believed() -> None:
    jumps = _fed(PoseJumpDetector(), [_pose()] + [_pose(80.0 * (n % 3 + 1)) for n in range(60)])
    assert not any(jump.accepted for jump in jumps[1:])


def test_a_doubt_outlasts_the_pose_that_it_began_with() -> None:
    """After half a second the old pose is forgotten; a pose that still jumps is not accepted."""
    watch = PoseJumpDetector(PoseJumpSettings(expires_after_s=0.2))
    jumps = _fed(watch, [_pose()] + [_pose(80.0 * (n % 2 + 1)) for n in range(30)])
    assert not any(jump.accepted for jump in jumps[1:])


def test_after_a_time_out_of_sight_there_is_nothing_to_have_jumped_from() -> None:
    watch = PoseJumpDetector()
    watch.take(_pose(), at_s=0.0)
    assert watch.take(_pose(200.0), at_s=0.7).accepted


def test_a_doubtful_pose_that_is_lost_starts_again() -> None:
    watch = PoseJumpDetector()
    _fed(watch, [_pose(), _pose(100.0)])
    assert watch.take(_pose(300.0), at_s=5.0).accepted


def test_a_planar_marker_that_turns_over_is_called_so() -> None:
    tilted = _pose(0.0, (0.0, 15.0, 0.0))
    sight = tilted.translation_mm / np.linalg.norm(tilted.translation_mm)
    normal = tilted.rotation[:, 2]
    mirrored = 2.0 * (normal @ sight) * sight - normal
    turn = np.cross(normal, mirrored)
    turn *= np.arcsin(np.linalg.norm(turn)) / np.linalg.norm(turn)
    over: Rigid[Camera, Marker] = Rigid(
        rotation=rotation_from_vector(turn) @ tilted.rotation, translation_mm=tilted.translation_mm
    )
    assert is_flipped(tilted, over)
    assert not is_flipped(tilted, _pose(0.0, (0.0, 30.0, 0.0)))
    jumps = _fed(PoseJumpDetector(), [tilted, tilted, over])
    assert (jumps[2].accepted, jumps[2].moved) == (False, MotionKind.FLIPPED)


def test_time_that_goes_backwards_is_a_new_beginning() -> None:
    watch = PoseJumpDetector()
    watch.take(_pose(), at_s=10.0)
    assert watch.take(_pose(100.0), at_s=3.0).accepted
