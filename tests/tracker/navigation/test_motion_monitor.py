"""All motion monitors on a rehearsed theatre whose camera, patient or drill moves."""

from dataclasses import replace

import cv2
import numpy as np
import numpy.typing as npt
import pytest

from tests.tracker.scenes import perfectly_seen
from tracker import Seen, Sighting, Unseen, UnseenReason
from tracker.geometry import Camera, Marker, Rigid
from tracker.navigation import Absent, AbsentReason, MotionMonitor, MotionState, Setup
from tracker.navigation.monitoring import SceneState
from tracker.rehearsal import Theatre, TheatreSettings

UNSEEN = Unseen(reason=UnseenReason.NO_CANDIDATE)
RATE_HZ = 30.0
REFERENCE: Rigid[Camera, Marker] = Rigid.from_vector([2.6, 0.3, 0.2], [60.0, 20.0, 450.0])


def seen(pose: Rigid[Camera, Marker]) -> Seen:
    return perfectly_seen(
        pose, corners_px=np.array([[600.0, 300.0], [640.0, 300.0], [640.0, 340.0], [600.0, 340.0]])
    )


def moved(pose: Rigid[Camera, Marker], by_mm: float) -> Rigid[Camera, Marker]:
    return replace(pose, translation_mm=pose.translation_mm + np.array([by_mm, 0.0, 0.0]))


@pytest.fixture(scope="module")
def picture() -> npt.NDArray[np.uint8]:
    """The theatre as its camera sees it."""
    return Theatre(TheatreSettings(seed=3)).renderer().image_at(1.0)


@pytest.fixture(scope="module")
def setup() -> Setup:
    return Setup(
        camera=Theatre(TheatreSettings(seed=3)).camera,
        camera_calibrated=True,
        tools={},
        channel=Absent(reason=AbsentReason.NO_PLAN),
        registration=Absent(reason=AbsentReason.NOT_REGISTERED),
        reference="reference",
    )


def shifted(picture: npt.NDArray[np.uint8], px: float) -> npt.NDArray[np.uint8]:
    """View of a camera that was rotated slightly."""
    moved = cv2.warpAffine(picture, np.array([[1.0, 0, px], [0, 1.0, 0]]), picture.shape[1::-1])
    return np.asarray(moved, dtype=np.uint8)


class Play:
    """Images passed to all monitors one after another."""

    def __init__(self, setup: Setup) -> None:
        self.watching = MotionMonitor()
        self.setup = setup
        self.number = 0

    @property
    def now_s(self) -> float:
        return self.number / RATE_HZ

    def show(
        self, image: npt.NDArray[np.uint8], reference: Sighting = UNSEEN, *, images: int = 1
    ) -> MotionState:
        for _ in range(images):
            self.number += 1
            motion = self.watching.take(self.setup, image, {"reference": reference}, at_s=self.now_s)
        return motion


def test_a_moved_camera_is_reported_within_a_third_of_a_second_until_the_next_registration(
    setup: Setup, picture: npt.NDArray[np.uint8]
) -> None:
    play = Play(setup)
    play.watching.begin(from_s=None, now_s=play.now_s)
    before = play.show(picture, images=30)
    assert (before.camera_moved, before.scene) == (False, SceneState.STILL)
    after = shifted(picture, 6.0)
    assert play.show(after, images=10).camera_moved
    # The state persists although the scene is still again.
    later = play.show(after, images=60)
    assert (later.camera_moved, later.scene) == (True, SceneState.STILL)
    play.watching.begin(from_s=play.now_s, now_s=play.now_s)
    assert not play.show(after).camera_moved


def test_a_camera_that_moved_between_the_first_landmark_and_the_registration_is_reported(
    setup: Setup, picture: npt.NDArray[np.uint8]
) -> None:
    play = Play(setup)
    play.show(picture, images=30)
    touched_at_s = play.now_s
    play.show(shifted(picture, 6.0), images=30)
    play.watching.begin(from_s=touched_at_s, now_s=play.now_s)
    assert play.show(shifted(picture, 6.0)).camera_moved


def test_a_reference_that_moves_in_a_still_scene_was_bumped_and_one_that_moves_with_it_was_not(
    setup: Setup, picture: npt.NDArray[np.uint8]
) -> None:
    bumped = Play(setup)
    bumped.watching.begin(from_s=None, now_s=0.0)
    assert not bumped.show(picture, seen(REFERENCE), images=30).reference_moved
    assert bumped.show(picture, seen(moved(REFERENCE, 8.0)), images=30).reference_moved
    carried = Play(setup)
    carried.watching.begin(from_s=None, now_s=0.0)
    carried.show(picture, seen(REFERENCE), images=30)
    reported = carried.show(shifted(picture, 24.0), seen(moved(REFERENCE, 8.0)), images=30)
    assert (reported.camera_moved, reported.reference_moved) == (True, False)


def test_a_reference_that_another_camera_model_places_elsewhere_was_not_bumped(
    setup: Setup, picture: npt.NDArray[np.uint8]
) -> None:
    """As at a server start, with the first images before the camera of the open case is known."""
    play = Play(setup)
    play.show(picture, seen(REFERENCE), images=30)
    matrix = setup.camera.matrix * np.array([[1.02, 1.0, 1.0], [1.0, 1.02, 1.0], [1.0, 1.0, 1.0]])
    play.setup = replace(setup, camera=replace(setup.camera, matrix=matrix))
    play.watching.begin(from_s=None, now_s=play.now_s)
    farther = seen(replace(REFERENCE, translation_mm=REFERENCE.translation_mm * np.array([1.0, 1.0, 1.02])))
    reported = play.show(picture, farther, images=30)
    assert (reported.reference_moved, reported.jumped) == (False, frozenset())
    # A later bump counts.
    bumped = seen(moved(farther.camera_from_marker, 8.0))
    assert play.show(picture, bumped, images=30).reference_moved


def test_a_pose_that_jumps_is_reported_and_one_that_stays_away_is_believed_after_a_while(
    setup: Setup, picture: npt.NDArray[np.uint8]
) -> None:
    play = Play(setup)
    play.show(picture, seen(REFERENCE), images=10)
    there = seen(moved(REFERENCE, 60.0))
    assert play.show(picture, there).jumped == {"reference"}
    assert play.show(picture, there, images=6).jumped == frozenset()


def test_how_long_a_marker_was_not_seen_is_counted(setup: Setup, picture: npt.NDArray[np.uint8]) -> None:
    play = Play(setup)
    assert play.show(picture, seen(REFERENCE)).unseen_s["reference"] == 0.0
    assert play.show(picture, images=15).unseen_s["reference"] == pytest.approx(0.5)
