"""Two prints of one marker in view: there is no pose until only one is visible."""

import cv2
import numpy as np
import pytest

from tests.tracker.pipeline.stepped import CAMERA, MODEL, off_px, pose_of, tracker_of
from tests.tracker.scenes import (
    NEIGHBOURS,
    OTHER,
    Image8,
    Print,
    cluttered,
    code_image,
    code_model,
    corners_px_of,
    rendered,
    seen,
)
from tracker import Seen, Tracker, Unseen, UnseenReason
from tracker.geometry import Camera, Marker, Rigid
from tracker.pipeline.second_prints import (
    MIN_ALONE_IMAGES,
    MIN_ALONE_S,
    PERIOD_IMAGES,
    THOROUGH_PERIOD_IMAGES,
)

HERE, THERE = pose_of((120.0, 180.0)), pose_of((340.0, 150.0), 44.0, roll_deg=80.0)
TWICE = UnseenReason.MARKER_TWICE


def _image(*prints: tuple[Rigid[Camera, Marker], Image8], seed: int = 0) -> Image8:
    return rendered(CAMERA, [Print(picture=picture, pose=pose) for pose, picture in prints], seed=seed)


def _twice(there: Rigid[Camera, Marker] = THERE, *, seed: int = 0) -> Image8:
    return _image((HERE, code_image()), (there, code_image()), seed=seed)


def _alone(pose: Rigid[Camera, Marker] = HERE, *, seed: int = 0) -> Image8:
    return _image((pose, code_image()), seed=seed)


def _under_a_finger(image: Image8, pose: Rigid[Camera, Marker]) -> Image8:
    """The image with a grey occluder on a corner of the marker, so that its dark region has more sides."""
    corners = corners_px_of(CAMERA, pose)
    a, b, d = corners[0], corners[1], corners[3]
    finger = [a + 0.5 * (a - b), a + 0.6 * (b - a), a + 0.6 * (d - a), a + 0.5 * (a - d)]
    cv2.fillConvexPoly(image, np.rint(finger).astype(np.int32), (150.0,), cv2.LINE_AA)
    return image


def _reason(sighting: Seen | Unseen) -> UnseenReason | None:
    return sighting.reason if isinstance(sighting, Unseen) else None


@pytest.mark.parametrize(
    "there",
    [
        pytest.param(THERE, id="as large"),
        pytest.param(pose_of((340.0, 150.0), 24.0), id="half as large"),
        pytest.param(pose_of((330.0, 180.0), 110.0, roll_deg=200.0), id="twice as large"),
        pytest.param(pose_of((195.0, 180.0)), id="beside it"),
    ],
)
def test_of_two_prints_none_is_claimed(there: Rigid[Camera, Marker]) -> None:
    image = _twice(there)
    assert _reason(tracker_of().search(image)["code"]) is TWICE
    assert _reason(tracker_of().step(image, captured_at_s=0.0)["code"]) is TWICE


def test_of_two_prints_of_which_one_is_partly_occluded_none_is_claimed() -> None:
    image = _under_a_finger(_twice(), THERE)
    assert _reason(tracker_of().search(image)["code"]) is TWICE
    assert _reason(tracker_of().step(image, captured_at_s=0.0)["code"]) is TWICE


def _images_until_noticed(first: list[Image8], then: list[Image8], *, maximum: int) -> int:
    tracker = tracker_of()
    for k in range(5):
        assert isinstance(tracker.step(first[k % 2], captured_at_s=k / 30)["code"], Seen)
    for k in range(maximum):
        sighting = tracker.step(then[k % 2], captured_at_s=(5 + k) / 30)["code"]
        if _reason(sighting) is TWICE:
            return k + 1
    return maximum + 1


def test_a_free_standing_print_that_comes_into_view_is_noticed_within_a_period() -> None:
    first, then = ([f(seed=k) for k in range(2)] for f in (_alone, _twice))
    assert _images_until_noticed(first, then, maximum=40) <= PERIOD_IMAGES == 32


def test_a_small_or_occluded_print_that_comes_into_view_is_noticed_later() -> None:
    small = pose_of((340.0, 150.0), 13.0)
    first = [_alone(seed=k) for k in range(2)]
    for then in (
        [_twice(small, seed=k) for k in range(2)],
        [_under_a_finger(_twice(seed=k), THERE) for k in range(2)],
    ):
        assert _images_until_noticed(first, then, maximum=300) <= THOROUGH_PERIOD_IMAGES == 256


@pytest.mark.parametrize(
    ("remaining", "rate_hz"), [(HERE, 30.0), (THERE, 8.0)], ids=["the first", "the second, of a slow camera"]
)
def test_a_marker_has_a_pose_again_after_one_print_was_alone(
    remaining: Rigid[Camera, Marker], rate_hz: float
) -> None:
    tracker = tracker_of()
    images = 6
    for k in range(images):
        assert _reason(tracker.step(_twice(seed=k), captured_at_s=k / rate_hz)["code"]) is TWICE
    alone = [_alone(remaining, seed=k) for k in range(3)]
    claims = [tracker.step(alone[k % 3], captured_at_s=k / rate_hz)["code"] for k in range(images, 60)]
    until = next(k for k, one in enumerate(claims) if isinstance(one, Seen))
    assert until in (int(MIN_ALONE_S * rate_hz) - 1, MIN_ALONE_IMAGES)
    assert (until + 1) / rate_hz >= MIN_ALONE_S
    assert until >= MIN_ALONE_IMAGES
    assert all(off_px(seen(one), remaining) < 0.3 for one in claims[until:])


def test_a_second_print_that_moves_and_is_occluded_is_still_one() -> None:
    tracker = tracker_of()
    for k in range(20):
        there = pose_of((330.0 + 30.0 * np.sin(0.15 * k), 150.0 + 20.0 * np.cos(0.15 * k)), roll_deg=2.0 * k)
        image = _twice(there, seed=k)
        image = _under_a_finger(image, there) if k >= 4 else image
        assert _reason(tracker.step(image, captured_at_s=k / 30)["code"]) is TWICE


@pytest.mark.parametrize(
    "picture",
    [
        *(pytest.param(code_image(NEIGHBOURS[k]), id=f"one field differs: {k}") for k in (0, 4)),
        pytest.param(code_image(OTHER), id="another code"),
        pytest.param(np.ascontiguousarray(code_image()[:, ::-1]), id="its reflection"),
        pytest.param(np.zeros((120, 120), np.uint8), id="a black square"),
    ],
)
def test_what_is_not_the_same_shape_is_no_second_print(picture: Image8) -> None:
    images = [_image((HERE, code_image()), (THERE, picture), seed=k) for k in range(4)]
    tracker = tracker_of()
    assert isinstance(tracker.search(images[0])["code"], Seen)
    for k in range(PERIOD_IMAGES + 2):
        sighting = tracker.step(images[k % 4], captured_at_s=k / 30, full_search=k % 5 == 0)["code"]
        assert off_px(seen(sighting), HERE) < 0.3


def test_the_square_of_a_marker_is_no_second_print_of_it() -> None:
    """A marker moving over clutter, with another marker: no second print is reported."""
    other = code_model(OTHER, name="other")
    tracker = Tracker(camera=CAMERA, models=[MODEL, other])
    background = cluttered(CAMERA, 3)
    for k in range(PERIOD_IMAGES + 2):
        pose = pose_of((120.0 + k, 180.0), roll_deg=3.0 * k)
        prints = [Print(picture=code_image(), pose=pose), Print(picture=code_image(OTHER), pose=THERE)]
        image = rendered(CAMERA, prints[: 1 + (k < 10)], background=background, seed=k)
        sightings = tracker.step(image, captured_at_s=k / 30, full_search=k % 5 == 0)
        assert TWICE not in {_reason(one) for one in sightings.values()}
        assert isinstance(sightings["code"], Seen)


def test_only_the_marker_that_is_twice_in_view_is_withheld() -> None:
    tracker = Tracker(camera=CAMERA, models=[MODEL, code_model(OTHER, name="other")])
    aside = pose_of((240.0, 290.0))
    image = _image((HERE, code_image()), (THERE, code_image()), (aside, code_image(OTHER)))
    for sightings in (tracker.search(image), tracker.step(image, captured_at_s=0.0)):
        assert _reason(sightings["code"]) is TWICE
        assert off_px(seen(sightings["other"]), aside) < 0.3


def test_an_older_image_clears_what_is_known_of_second_prints() -> None:
    tracker = tracker_of()
    assert _reason(tracker.step(_twice(), captured_at_s=5.0)["code"]) is TWICE
    assert isinstance(tracker.step(_alone(), captured_at_s=1.0)["code"], Seen)
