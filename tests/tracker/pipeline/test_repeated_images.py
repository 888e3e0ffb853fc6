"""Repeated images, from a frozen camera or a capture card faster than its camera."""

from collections.abc import Iterable

import numpy as np

from tests.benchmarks.scenes.conditions import BASE
from tests.benchmarks.scenes.faces import FACES
from tests.benchmarks.scenes.placement import scene_at
from tests.benchmarks.scenes.scene import image_of as scene_image_of
from tests.tracker.pipeline.stepped import image_of, off_px, pose_of, tracker_of
from tests.tracker.scenes import seen
from tests.tracker.small_scenes import RIG, SIDES_PX, Image, trackers_by_face
from tests.tracker.small_scenes import pose_of as somewhere
from tracker import Tracker
from tracker.pipeline.image import RepeatedPatch
from tracker.pose.pose_ambiguity import DECIDED_COST

FACE = FACES[0]
# Seeds of markers of which one image does not decide the tilt, and ten images do.
DOUBTFUL = (3, 4, 7, 10, 14)


def leads_of(tracker: Tracker, images: Iterable[Image], *, from_s: float = 0.0) -> list[float]:
    said = (tracker.step(image, captured_at_s=from_s + k / 60.0) for k, image in enumerate(images))
    return [seen(sightings[FACE.name]).delta_chi2 for sightings in said]


def images_of(seed: int, *, count: int) -> list[Image]:
    """Images of a small marker that nearly faces the camera and is at rest."""
    random = np.random.default_rng([seed, 5])
    pose = somewhere(random, float(random.choice(SIDES_PX[:4])), (1.0, 10.0))
    return [
        scene_image_of(scene_at(RIG, FACE, BASE, (pose,), seed=seed, image_number=k)) for k in range(count)
    ]


def test_a_frozen_camera_makes_no_doubtful_pose_surer_and_a_live_one_does() -> None:
    tracker = trackers_by_face()[FACE.name]
    for seed in DOUBTFUL:
        live = images_of(seed, count=10)
        frozen = [live[0].copy() for _ in range(10)]
        for k, image in enumerate(frozen):
            # A clock in a corner keeps running.
            image[:4, :4] = k
        frozen_leads = leads_of(tracker, frozen, from_s=20.0 * seed)
        # The first image is searched; tracked copies add no evidence.
        assert frozen_leads[1] < DECIDED_COST
        assert max(frozen_leads[2:]) <= frozen_leads[1] + 1e-6
        assert leads_of(tracker, live, from_s=20.0 * seed + 10.0)[-1] > frozen_leads[1] + 5.0


def test_the_speed_of_a_marker_is_reported_by_its_images_and_not_by_their_repetitions() -> None:
    tracker, found_by = tracker_of(), []
    for k in range(14):
        # Nine pixels in each new image: over the reach, unless its speed is known.
        pose = pose_of((120.0 + 9 * (k // 2), 150.0))
        found = seen(tracker.step(image_of(pose, seed=k // 2), captured_at_s=k / 60.0)["code"])
        assert off_px(found, pose) < 0.3
        found_by.append(found.found_by)
    assert found_by[4:] == ["track"] * 10


def test_a_marker_in_a_frozen_image_is_tracked_on_and_where_it_is_when_it_moves_again() -> None:
    tracker = tracker_of()
    moving = [pose_of((120.0 + 4 * k, 150.0)) for k in range(4)]
    for k, pose in enumerate(moving):
        tracker.step(image_of(pose, seed=k), captured_at_s=k / 30.0)
    # It is moving; for two seconds the image is frozen.
    for k in range(60):
        found = seen(tracker.step(image_of(moving[-1], seed=3), captured_at_s=(4 + k) / 30.0)["code"])
        assert found.found_by == "track"
        assert off_px(found, moving[-1]) < 0.3
    after = pose_of((134.0, 150.0))
    assert off_px(seen(tracker.step(image_of(after, seed=9), captured_at_s=2.2)["code"]), after) < 0.3


def test_a_pixel_of_the_marker_makes_another_image_and_a_clock_beside_it_does_not() -> None:
    patch, image = RepeatedPatch(), np.full((48, 64), 90, np.uint8)
    assert not patch.is_repeated(image)
    patch.store(image, np.array([[20.0, 20.0], [40.0, 20.0], [40.0, 40.0], [20.0, 40.0]]))
    assert patch.is_repeated(image)
    image[2, 60] += 1
    assert patch.is_repeated(image)
    # The caller overwrites this image with the next.
    image[30, 37] += 1
    assert not patch.is_repeated(image)
