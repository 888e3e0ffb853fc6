"""Random scenes: pose, illumination and occlusion; deterministic by seed."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from tests.benchmarks.scenes.conditions import BASE, Condition
from tests.benchmarks.scenes.faces import Face
from tests.benchmarks.scenes.finger import finger_over
from tests.benchmarks.scenes.illumination import random_illumination
from tests.benchmarks.scenes.rigs import Rig
from tests.benchmarks.scenes.scene import Board, Pose, Scene
from tracker.geometry import Array, Rigid, rotation_between, rotation_from_vector

# Backgrounds are drawn from this many; images without a marker have others.
BACKGROUNDS = 24
EDGE_PX = 12.0
FACING = np.diag([1.0, -1.0, -1.0])
MAX_TRIES = 2000


def posed(position_mm: Array, *, tilt_deg: float, about_deg: float, roll_deg: float) -> Pose:
    """Return a marker pose with roll in its plane and tilt from the line of sight."""
    about, tilt, roll = np.radians([about_deg, tilt_deg, roll_deg])
    leaning = rotation_from_vector(np.array([np.cos(about), np.sin(about), 0.0]) * tilt)
    rolled = rotation_from_vector([0.0, 0.0, roll])
    sight = rotation_between([0.0, 0.0, 1.0], position_mm)
    return Rigid(rotation=sight @ leaning @ FACING @ rolled, translation_mm=position_mm)


def random_pose(
    rig: Rig, face: Face, random: np.random.Generator, tilt_deg: tuple[float, float] = BASE.tilt_deg
) -> Pose:
    """Return a pose with all of the marker's paper in the image."""
    for _ in range(MAX_TRIES):
        far, at_px = random.uniform(*rig.depth_mm), random.uniform([0.0, 0.0], rig.size_wh_px)
        pose = posed(
            rig.sight_through(at_px) * far,
            tilt_deg=random.uniform(*tilt_deg),
            about_deg=random.uniform(0.0, 360.0),
            roll_deg=random.uniform(-180.0, 180.0),
        )
        if _is_inside(rig, face, pose):
            return pose
    raise RuntimeError("no place for the marker in the image")


def _is_inside(rig: Rig, face: Face, pose: Pose) -> bool:
    paper = rig.px_of(pose, face.outlines_mm[0])
    far_corner = np.array(rig.size_wh_px) - 1.0 - EDGE_PX
    return bool((paper > EDGE_PX).all() and (paper < far_corner).all())


def random_scene(
    rig: Rig, face: Face, condition: Condition = BASE, *, seed: int = 0, background: bool = True
) -> Scene:
    """Return a scene; pose, illumination and background depend on the seed only."""
    rig = rig.bent() if condition.has_bent_lens else rig
    pose = random_pose(rig, face, np.random.default_rng([seed, 31]), condition.tilt_deg)
    return scene_at(rig, face, condition, (pose,), seed=seed, background=background)


def scene_at(
    rig: Rig,
    face: Face,
    condition: Condition,
    poses: tuple[Pose, ...],
    *,
    seed: int,
    image_number: int = 0,
    background: bool = True,
) -> Scene:
    """Return the scene of a seed with its marker here; a moving condition adds motion to a single pose."""
    random = np.random.default_rng([seed, 37])
    heading, chosen = random.uniform(0.0, 2.0 * np.pi), int(random.integers(BACKGROUNDS))
    if condition.motion_px > 0.0:
        poses = _passing(rig, poses[len(poses) // 2], condition.motion_px, heading)
    board = Board(face=face, poses=poses)
    corners = rig.px_of(board.pose, face.corners_mm)
    side_px = rig.focal_px * face.side_mm / float(np.linalg.norm(board.pose.translation_mm))
    light = random_illumination(rig, condition, random, rig.px_of(board.pose, np.zeros((1, 3)))[0], side_px)
    covered = condition.occlusion_ratio > 0.0
    return Scene(
        rig=rig,
        condition=condition,
        boards=(board,),
        illumination=light,
        finger=finger_over(corners, condition.occlusion_ratio, random) if covered else None,
        background_seed=chosen if background else None,
        noise_seed=(seed, 41, image_number),
    )


def empty_scene(rig: Rig, condition: Condition = BASE, *, seed: int = 0) -> Scene:
    """Return a scene without a marker, on a background that no other scene has."""
    random = np.random.default_rng([seed, 47])
    middle = random.uniform([0.0, 0.0], rig.size_wh_px)
    return Scene(
        rig=rig,
        condition=condition,
        boards=(),
        illumination=random_illumination(rig, condition, random, middle, 40.0),
        finger=None,
        background_seed=1000 + seed,
        noise_seed=(seed, 53),
    )


def crowded_scene(rig: Rig, faces: Sequence[Face], *, seed: int = 0) -> Scene:
    """Return a scene with several markers that do not touch each other."""
    random = np.random.default_rng([seed, 59])
    scene = random_scene(rig, faces[0], seed=seed)
    boards = list(scene.boards)
    for face in faces[1:]:
        for _ in range(MAX_TRIES):
            pose = random_pose(rig, face, random)
            centre = rig.px_of(pose, np.zeros((1, 3)))[0]
            others = [rig.px_of(board.pose, np.zeros((1, 3)))[0] for board in boards]
            if min(float(np.linalg.norm(centre - other)) for other in others) > 2.2 * scene.side_px:
                boards.append(Board(face=face, poses=(pose,)))
                break
        else:
            raise RuntimeError("no place for one more marker in the image")
    return replace(scene, boards=tuple(boards))


def shutter_poses(
    pose_at: Callable[[float], Pose], motion_px: float, *, at_s: float = 0.0, opening_s: float = 1.0
) -> tuple[Pose, ...]:
    """Return poses at the centres of equal parts of the exposure, enough for this motion."""
    # Less than a pixel apart, a blur of 0.6 px leaves a ripple of some hundred-thousandths.
    count = 2 * max(1, int(np.ceil(0.6 * motion_px))) + 1
    return tuple(pose_at(at_s + opening_s * ((number + 0.5) / count - 0.5)) for number in range(count))


def _passing(rig: Rig, pose: Pose, motion_px: float, heading: float) -> tuple[Pose, ...]:
    """Return poses along a straight line across the sight of this image length, centred at the given one."""
    sight = rotation_between([0.0, 0.0, 1.0], pose.translation_mm)
    far = float(np.linalg.norm(pose.translation_mm))
    way = sight @ np.array([np.cos(heading), np.sin(heading), 0.0]) * (motion_px * far / rig.focal_px)
    return shutter_poses(lambda tau: replace(pose, translation_mm=pose.translation_mm + tau * way), motion_px)
