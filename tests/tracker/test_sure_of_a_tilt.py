"""Poses that were sure of the wrong tilt: in motion, leaning, with a side covered, or interlaced."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import cv2
import numpy as np
import numpy.typing as npt
import pytest

from tests.benchmarks.limits.judging import Outcome, claim_of, judged
from tests.benchmarks.scenes.conditions import BASE
from tests.benchmarks.scenes.faces import FACES, Face
from tests.benchmarks.scenes.placing import posed, scene_at
from tests.benchmarks.scenes.rigs import Rig
from tests.benchmarks.scenes.scene import Pose, Scene, image_of
from tests.tracker.levels import WORST_SD2
from tracker import Sighting, Tracker
from tracker.geometry import Rigid, rotation_from_vector

RIG = Rig(name="small image", size_wh_px=(448, 336), focal_px=1028.0, depth_mm=(300.0, 1600.0))
SIDES_PX = (16.0, 20.0, 24.0, 27.0, 32.0, 40.0, 60.0, 80.0)
COVER_GREYS = (15, 50, 110, 175, 205)

Image = npt.NDArray[np.uint8]
Shown = Iterator[tuple[Scene, Sighting]]


@pytest.fixture(scope="module")
def trackers() -> dict[str, Tracker]:
    return {face.name: Tracker(camera=RIG.camera, models=[face.model]) for face in FACES}


def pose_of(random: np.random.Generator, side_px: float, tilt_deg: tuple[float, float]) -> Pose:
    """Somewhere in the image with all its paper, about so wide."""
    edge = 1.1 * side_px + 15.0
    at_px = random.uniform([edge, edge], np.array(RIG.size_wh_px) - edge)
    return posed(
        RIG.sight_through(at_px) * RIG.focal_px * 25.0 / side_px,
        tilt_deg=random.uniform(*tilt_deg),
        about_deg=random.uniform(0.0, 360.0),
        roll_deg=random.uniform(-180.0, 180.0),
    )


def in_motion(seed: int, face: Face, trackers: dict[str, Tracker]) -> Shown:
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


def leaning(seed: int, face: Face, trackers: dict[str, Tracker]) -> Shown:
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


def with_a_side_covered(seed: int, face: Face, trackers: dict[str, Tracker]) -> Shown:
    """Something straight over one side, nearly along it."""
    random = np.random.default_rng([seed, 3])
    scene = scene_at(
        RIG, face, BASE, (pose_of(random, float(random.choice(SIDES_PX)), (0.0, 55.0)),), seed=seed
    )
    corners = np.roll(scene.corners_px, int(random.integers(4)), axis=0)
    along, inwards = corners[1] - corners[0], corners[3] - corners[0]
    ends = [corners[0] - 2.0 * along, corners[0] + 3.0 * along]
    inner = [end + random.uniform(-0.08, 0.2) * inwards for end in ends]
    cover = np.rint([*inner, ends[1] - 2.0 * inwards, ends[0] - 2.0 * inwards]).astype(np.int32)
    image = image_of(scene)
    grey = float(random.choice(COVER_GREYS))
    cv2.fillConvexPoly(image, cover, (grey,), cv2.LINE_AA)
    yield scene, trackers[face.name].search(image)[face.name]


def interlaced(seed: int, face: Face, trackers: dict[str, Tracker]) -> Shown:
    """Every other line is of a moment later."""
    random = np.random.default_rng([seed, 4])
    scene = scene_at(
        RIG, face, BASE, (pose_of(random, float(random.choice(SIDES_PX)), (0.0, 45.0)),), seed=seed
    )
    image = image_of(scene)
    # The truth is in the middle of both.
    shift = int(random.integers(1, 3))
    image[::2] = np.roll(image, -shift, axis=1)[::2]
    image[1::2] = np.roll(image, shift, axis=1)[1::2]
    yield scene, trackers[face.name].search(image)[face.name]


@pytest.mark.parametrize(
    ("shown", "seeds"),
    [
        (in_motion, range(120, 180)),
        (leaning, range(225, 300)),
        (with_a_side_covered, range(75, 105)),
        (interlaced, range(60)),
    ],
)
def test_nobody_is_sure_of_a_wrong_tilt(
    shown: Callable[[int, Face, dict[str, Tracker]], Shown], seeds: range, trackers: dict[str, Tracker]
) -> None:
    worst: dict[int, float] = {}
    for seed in seeds:
        for scene, sighting in shown(seed, FACES[seed % len(FACES)], trackers):
            one = judged(scene, claim_of(sighting))
            assert one.outcome is not Outcome.WRONG
            worst[seed] = max(worst.get(seed, 0.0), *one.stated_sd2, 0.0)
    assert {seed: sd2 for seed, sd2 in worst.items() if sd2 > WORST_SD2} == {}
