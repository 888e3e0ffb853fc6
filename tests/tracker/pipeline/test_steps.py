"""Results of a tracker for successive images."""

import numpy as np
import pytest

from tests.tracker.pipeline.stepped import assert_same, image_of, off_px, pose_of, tracker_of
from tests.tracker.scenes import (
    NEIGHBOURS,
    seen,
)
from tracker import Unseen


def test_a_search_knows_nothing_of_the_images_before() -> None:
    here, there = pose_of((150, 150)), pose_of((330, 200), roll_deg=80)
    tracker = tracker_of()
    first = seen(tracker.search(image_of(here))["code"])
    tracker.step(image_of(there), captured_at_s=0.0)
    tracker.search(image_of(there))
    assert_same(seen(tracker.search(image_of(here))["code"]), first)
    assert_same(seen(tracker_of().search(image_of(here))["code"]), first)


def test_a_search_leaves_what_step_knows_alone() -> None:
    pose = pose_of()
    tracker = tracker_of()
    tracker.step(image_of(pose), captured_at_s=0.0)
    tracker.search(np.zeros((360, 480), np.uint8))
    assert seen(tracker.step(image_of(pose), captured_at_s=0.03)["code"]).found_by == "track"


def test_the_same_images_give_the_same_answers() -> None:
    images = [image_of(pose_of((200.0 + 3 * k, 180.0)), seed=k) for k in range(4)]
    runs = []
    for _ in range(2):
        tracker = tracker_of()
        runs.append([seen(tracker.step(i, captured_at_s=0.03 * k)["code"]) for k, i in enumerate(images)])
    for a, b in zip(*runs, strict=True):
        assert_same(a, b)


def test_a_marker_that_moves_is_searched_for_once_and_tracked_from_then() -> None:
    tracker = tracker_of()
    found_by = []
    for k in range(8):
        pose = pose_of((120.0 + 9 * k, 150.0 + 4 * k), roll_deg=2.0 * k)
        found = seen(tracker.step(image_of(pose, seed=k), captured_at_s=k / 30)["code"])
        assert off_px(found, pose) < 0.3
        found_by.append(found.found_by)
    # Nine pixels exceed the reach: the second image is searched, then the speed is known.
    assert found_by[0] == "search"
    assert found_by[2:] == ["track"] * 6


def test_a_tracked_marker_is_where_a_search_finds_it() -> None:
    pose = pose_of(side_px=70)
    tracker = tracker_of()
    tracker.step(image_of(pose, seed=1), captured_at_s=0.0)
    image = image_of(pose, seed=2)
    tracked, searched = seen(tracker.step(image, captured_at_s=0.03)["code"]), tracker.search(image)["code"]
    assert tracked.found_by == "track"
    np.testing.assert_allclose(tracked.corners_px, seen(searched).corners_px, atol=0.05)
    np.testing.assert_allclose(tracked.score_ratio, seen(searched).score_ratio, atol=0.02)


def test_a_marker_that_jumps_is_found_again_in_the_same_image() -> None:
    tracker = tracker_of()
    tracker.step(image_of(pose_of((120, 120))), captured_at_s=0.0)
    there = pose_of((350, 240), roll_deg=130)
    found = seen(tracker.step(image_of(there), captured_at_s=0.03)["code"])
    assert found.found_by == "search"
    assert off_px(found, there) < 0.3


def test_a_marker_that_is_hidden_for_one_image_is_tracked_on() -> None:
    tracker = tracker_of()
    for k in range(3):
        tracker.step(image_of(pose_of((120.0 + 9 * k, 150.0)), seed=k), captured_at_s=k / 30)
    assert isinstance(tracker.step(image_of(), captured_at_s=3 / 30)["code"], Unseen)
    there = pose_of((120.0 + 9 * 4, 150.0))
    found = seen(tracker.step(image_of(there, seed=4), captured_at_s=4 / 30)["code"])
    assert found.found_by == "track"
    assert off_px(found, there) < 0.3


def test_a_marker_that_is_gone_is_unseen_at_once() -> None:
    tracker = tracker_of()
    for k in range(3):
        seen(tracker.step(image_of(pose_of()), captured_at_s=k / 30)["code"])
    for k in range(3, 6):
        assert isinstance(tracker.step(image_of(), captured_at_s=k / 30)["code"], Unseen)
    assert seen(tracker.step(image_of(pose_of()), captured_at_s=0.2)["code"]).found_by == "search"


def test_a_look_alike_put_in_its_place_is_not_tracked() -> None:
    for fields in NEIGHBOURS:
        tracker = tracker_of()
        tracker.step(image_of(pose_of()), captured_at_s=0.0)
        assert isinstance(
            tracker.step(image_of(pose_of(), fields=fields), captured_at_s=0.03)["code"], Unseen
        )


@pytest.mark.parametrize(
    "at_s",
    [
        pytest.param(4.9, id="a little back"),
        pytest.param(0.0, id="far back"),
        pytest.param(5.0, id="the same"),
        pytest.param(6.0, id="a second on"),
    ],
)
def test_an_image_that_does_not_follow_the_last_is_searched_as_a_whole(at_s: float) -> None:
    tracker = tracker_of()
    tracker.step(image_of(pose_of()), captured_at_s=5.0)
    there = pose_of((300, 200))
    assert seen(tracker.step(image_of(pose_of()), captured_at_s=at_s)["code"]).found_by == "search"
    assert seen(tracker.step(image_of(there), captured_at_s=at_s - 1.0)["code"]).found_by == "search"


@pytest.mark.parametrize("centre_px", [(0.0, 180.0), (240.0, 2.0), (478.0, 358.0)])
def test_a_marker_half_outside_the_image_is_never_claimed_elsewhere(centre_px: tuple[float, float]) -> None:
    tracker = tracker_of()
    pose = pose_of(centre_px)
    for k in range(2):
        sighting = tracker.step(image_of(pose), captured_at_s=0.03 * k)["code"]
        assert isinstance(sighting, Unseen) or off_px(sighting, pose) < 3.0


def test_a_marker_that_leaves_the_image_is_followed_until_it_is_gone() -> None:
    tracker = tracker_of()
    for k in range(20):
        pose = pose_of((400.0 + 8.0 * k, 180.0))
        sighting = tracker.step(image_of(pose, seed=k), captured_at_s=k / 30)["code"]
        assert isinstance(sighting, Unseen) or off_px(sighting, pose) < 3.0
    assert isinstance(sighting, Unseen)
