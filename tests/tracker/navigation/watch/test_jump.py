"""Jumps: what a hand does is believed at once, what it cannot do only when image after image says so."""

import numpy as np
import pytest

from tracker.geometry import Camera, Marker, Rigid, rotation_from_vector
from tracker.navigation.watch import Jump, JumpSettings, JumpWatch, Moved, turned_over

IMAGE_S = 1.0 / 30.0
FACING = rotation_from_vector([np.pi, 0.0, 0.0])


def _pose(x_mm: float = 0.0, turn_deg: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Rigid[Camera, Marker]:
    return Rigid(
        rotation=rotation_from_vector(np.radians(turn_deg)) @ FACING,
        translation_mm=np.array([x_mm, 10.0, 400.0]),
    )


def _fed(watch: JumpWatch, poses: list[Rigid[Camera, Marker]], start: int = 0) -> list[Jump]:
    return [watch.take(pose, at_s=(start + n) * IMAGE_S) for n, pose in enumerate(poses)]


def test_the_first_pose_and_a_fast_hand_are_believed() -> None:
    # 450 mm/s and 150 deg/s.
    poses = [_pose(15.0 * n, (0.0, 5.0 * n, 0.0)) for n in range(20)]
    assert all(jump.believed and jump.moved is Moved.AS_A_HAND for jump in _fed(JumpWatch(), poses))


@pytest.mark.parametrize(
    "elsewhere",
    [pytest.param(_pose(40.0), id="a-shift"), pytest.param(_pose(0.0, (0.0, 0.0, 30.0)), id="a-turn")],
)
def test_one_jump_is_not_believed_and_forgotten_when_it_is_over(elsewhere: Rigid[Camera, Marker]) -> None:
    jumps = _fed(JumpWatch(), [_pose(), _pose(), elsewhere, _pose(), _pose()])
    assert [jump.believed for jump in jumps] == [True, True, False, True, True]
    assert jumps[2].moved is Moved.JUMPED


def test_a_jump_is_believed_when_five_images_agree() -> None:
    jumps = _fed(JumpWatch(), [_pose()] + [_pose(60.0 + n) for n in range(7)])
    assert [jump.believed for jump in jumps] == [True, False, False, False, False, True, True, True]
    assert jumps[5].images == 5


def test_poses_that_jump_about_are_never_believed() -> None:
    jumps = _fed(JumpWatch(), [_pose()] + [_pose(80.0 * (n % 3 + 1)) for n in range(60)])
    assert not any(jump.believed for jump in jumps[1:])


def test_a_doubt_outlasts_the_pose_that_it_began_with() -> None:
    """Half a second on, the old pose is forgotten; what still jumps about is not believed for that."""
    watch = JumpWatch(JumpSettings(forgotten_after_s=0.2))
    jumps = _fed(watch, [_pose()] + [_pose(80.0 * (n % 2 + 1)) for n in range(30)])
    assert not any(jump.believed for jump in jumps[1:])


def test_after_a_time_out_of_sight_there_is_nothing_to_have_jumped_from() -> None:
    watch = JumpWatch()
    watch.take(_pose(), at_s=0.0)
    assert watch.take(_pose(200.0), at_s=0.7).believed


def test_in_doubt_and_then_out_of_sight_begins_anew() -> None:
    watch = JumpWatch()
    _fed(watch, [_pose(), _pose(100.0)])
    assert watch.take(_pose(300.0), at_s=5.0).believed


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
    assert turned_over(tilted, over)
    assert not turned_over(tilted, _pose(0.0, (0.0, 30.0, 0.0)))
    jumps = _fed(JumpWatch(), [tilted, tilted, over])
    assert (jumps[2].believed, jumps[2].moved) == (False, Moved.TURNED_OVER)


def test_time_that_goes_backwards_is_a_new_beginning() -> None:
    watch = JumpWatch()
    watch.take(_pose(), at_s=10.0)
    assert watch.take(_pose(100.0), at_s=3.0).believed
