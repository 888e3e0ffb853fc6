"""Views of a small marker of which a fit is easily sure of a wrong pose: a spoilt outline, motion, a cover.

Each generator yields scenes with what the tracker found in them; the seed gives pose, cover and motion.
"""

from dataclasses import replace

import cv2
import numpy as np

from tests.benchmarks.scenes.conditions import BASE
from tests.benchmarks.scenes.faces import Face
from tests.benchmarks.scenes.placement import scene_at
from tests.benchmarks.scenes.scene import Pose, Scene, image_of
from tests.tracker.small_scenes import COVER_GREYS, RIG, SIDES_PX, Image, Shown, Trackers, pose_of
from tracker.geometry import Array, Rigid, rotation_from_vector

SUBPIXEL_BITS = 4


def some_scene(
    random: np.random.Generator, face: Face, seed: int, *, tilts_deg: tuple[float, float] = (0.0, 55.0)
) -> Scene:
    pose = pose_of(random, float(random.choice(SIDES_PX)), tilts_deg)
    return scene_at(RIG, face, BASE, (pose,), seed=seed)


def filled(image: Image, corners_px: list[Array], grey: float) -> None:
    """Something even over this part of the image, with soft edges."""
    points = np.rint(np.array(corners_px) * 2**SUBPIXEL_BITS).astype(np.int32)
    cv2.fillConvexPoly(image, points, (grey,), cv2.LINE_AA, SUBPIXEL_BITS)


def framed(seed: int, face: Face, trackers: Trackers) -> Shown:
    """All four sides lie under a frame, or were cut off and it lies on something, by up to 6 % of a side."""
    random = np.random.default_rng([seed, 22])
    scene = some_scene(random, face, seed)
    grey, image = float(random.choice(COVER_GREYS)), image_of(scene)
    middle = scene.corners_px.mean(axis=0)
    inner, outer = (
        middle + ratio * (scene.corners_px - middle)
        for ratio in (1.0 - random.uniform(0.01, 0.12), 1.0 + random.uniform(0.05, 0.4))
    )
    for k in range(4):
        after = (k + 1) % 4
        filled(image, [inner[k], inner[after], outer[after], outer[k]], grey)
    yield scene, trackers[face.name].search(image)[face.name]


def with_cut_sides(seed: int, face: Face, trackers: Trackers) -> Shown:
    """One to three sides were cut off, not straight, by up to a tenth."""
    random = np.random.default_rng([seed, 23])
    scene = some_scene(random, face, seed)
    grey, image = float(random.choice(COVER_GREYS)), image_of(scene)
    for side in random.permutation(4)[: int(random.integers(1, 4))]:
        here, there, beyond, before = np.roll(scene.corners_px, -side, axis=0)
        ends = (
            here + random.uniform(0.0, 0.1) * (before - here) - 0.3 * (there - here),
            there + random.uniform(0.0, 0.1) * (beyond - there) + 0.3 * (there - here),
        )
        filled(image, [*ends, ends[1] - 0.5 * (beyond - there), ends[0] - 0.5 * (before - here)], grey)
    yield scene, trackers[face.name].search(image)[face.name]


def beside_a_strip(seed: int, face: Face, trackers: Trackers) -> Shown:
    """A thin strip lies along a side, on the paper or over the side."""
    random = np.random.default_rng([seed, 21])
    scene = some_scene(random, face, seed)
    grey, image = float(random.choice(COVER_GREYS)), image_of(scene)
    here, there, _, before = np.roll(scene.corners_px, int(random.integers(4)), axis=0)
    along, inwards = there - here, before - here
    off, lean = random.uniform(-0.1, 0.04), random.uniform(-0.03, 0.03)
    ends = (here - 0.5 * along + (off - lean) * inwards, here + 1.5 * along + (off + lean) * inwards)
    across = random.uniform(0.02, 0.12) * inwards
    filled(image, [*ends, ends[1] - across, ends[0] - across], grey)
    yield scene, trackers[face.name].search(image)[face.name]


def moving_beside_a_strip(seed: int, face: Face, trackers: Trackers) -> Shown:
    """The same strip in each image of a drill that moves and turns, tracked."""
    random = np.random.default_rng([seed, 24])
    first = pose_of(random, float(random.choice(SIDES_PX)), (0.0, 50.0))
    speed_mm, turn = random.normal(size=3) * random.uniform(0.0, 2.5), 0.012 * random.normal(size=3)
    grey, side = float(random.choice(COVER_GREYS)), int(random.integers(4))
    off, across = random.uniform(-0.1, 0.04), random.uniform(0.02, 0.12)
    for number in range(6):
        pose: Pose = Rigid(
            rotation=rotation_from_vector(turn * number) @ first.rotation,
            translation_mm=first.translation_mm + speed_mm * number,
        )
        scene = scene_at(RIG, face, BASE, (pose,), seed=seed, image_number=number)
        here, there, _, before = np.roll(scene.corners_px, -side, axis=0)
        along, inwards, image = there - here, before - here, image_of(scene)
        ends = (here - 0.5 * along + off * inwards, here + 1.5 * along + off * inwards)
        filled(image, [*ends, ends[1] - across * inwards, ends[0] - across * inwards], grey)
        at_s = 10.0 * seed + number / 60.0
        yield scene, trackers[face.name].step(image, captured_at_s=at_s)[face.name]


def in_motion(seed: int, face: Face, trackers: Trackers) -> Shown:
    """Nearly frontal, out of focus, and passing by."""
    random = np.random.default_rng([seed, 1])
    side_px = float(random.choice(SIDES_PX))
    condition = replace(
        BASE,
        motion_px=side_px * random.uniform(0.05, 0.2),
        blur_px=max(0.6, side_px * random.uniform(0.02, 0.06)),
    )
    scene = scene_at(RIG, face, condition, (pose_of(random, side_px, (1.0, 8.0)),), seed=seed)
    yield scene, trackers[face.name].search(image_of(scene))[face.name]


def leaning(seed: int, face: Face, trackers: Trackers) -> Shown:
    """Small and nearly frontal, tracked, and from one image to the next it leans another way."""
    random = np.random.default_rng([seed, 2])
    first = pose_of(random, float(random.choice(SIDES_PX[:4])), (1.0, 8.0))
    turn = rotation_from_vector(0.08 * random.normal(size=3))
    then: Pose = Rigid(
        rotation=turn @ first.rotation, translation_mm=first.translation_mm + random.normal(size=3)
    )
    for number, pose in enumerate([first] * 2 + [then] * 3):
        scene = scene_at(RIG, face, BASE, (pose,), seed=seed, image_number=number)
        at_s = 10.0 * seed + number / 60.0
        yield scene, trackers[face.name].step(image_of(scene), captured_at_s=at_s)[face.name]


def with_a_side_covered(seed: int, face: Face, trackers: Trackers) -> Shown:
    """Something straight over one side, nearly along it."""
    random = np.random.default_rng([seed, 3])
    scene = some_scene(random, face, seed)
    corners = np.roll(scene.corners_px, int(random.integers(4)), axis=0)
    along, inwards = corners[1] - corners[0], corners[3] - corners[0]
    ends = [corners[0] - 2.0 * along, corners[0] + 3.0 * along]
    inner = [end + random.uniform(-0.08, 0.2) * inwards for end in ends]
    cover = np.rint([*inner, ends[1] - 2.0 * inwards, ends[0] - 2.0 * inwards]).astype(np.int32)
    image = image_of(scene)
    grey = float(random.choice(COVER_GREYS))
    cv2.fillConvexPoly(image, cover, (grey,), cv2.LINE_AA)
    yield scene, trackers[face.name].search(image)[face.name]


def interlaced(seed: int, face: Face, trackers: Trackers) -> Shown:
    """Every other line is of a moment later."""
    random = np.random.default_rng([seed, 4])
    scene = some_scene(random, face, seed, tilts_deg=(0.0, 45.0))
    image = image_of(scene)
    # The truth is in the middle of both.
    shift = int(random.integers(1, 3))
    image[::2] = np.roll(image, -shift, axis=1)[::2]
    image[1::2] = np.roll(image, shift, axis=1)[1::2]
    yield scene, trackers[face.name].search(image)[face.name]
