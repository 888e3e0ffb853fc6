"""The whole tracker on one image after another: what is found, what is not, and what is refused."""

from collections.abc import Callable, Iterator

import cv2
import numpy as np
import numpy.typing as npt
import pytest

from tests.tracker.scenes import (
    CODE,
    Image8,
    Print,
    camera_of,
    cluttered,
    code_image,
    code_model,
    corners_px_of,
    facing_at_px,
    rendered,
    seen,
)
from tracker import InvalidInput, MarkerModel, Seen, Tracker, Unseen, UnseenReason
from tracker.geometry import Camera, Marker, Rigid
from tracker.marker import ScoreSettings
from tracker.rehearsal.emblem import drill_emblem
from tracker.stages import Stages
from tracker.warm_up import warm_up

CAMERA = camera_of((480, 360), focal_px=550.0)
MODEL = code_model()
OTHER = ((0, 1, 1), (1, 0, 0), (1, 0, 1))
Fields = tuple[tuple[int, ...], ...]


def _pose(
    centre_px: tuple[float, float] = (240.0, 180.0),
    side_px: float = 50.0,
    *,
    tilt_deg: float = 25.0,
    roll_deg: float = 10.0,
) -> Rigid[Camera, Marker]:
    return facing_at_px(CAMERA, centre_px, side_px, tilt_deg=tilt_deg, about_deg=50, roll_deg=roll_deg)


def _image(*poses: Rigid[Camera, Marker], fields: Fields = CODE, seed: int = 0) -> Image8:
    return rendered(CAMERA, [Print(picture=code_image(fields), pose=p) for p in poses], seed=seed)


def _tracker(*, clock: Callable[[], float] | None = None) -> Tracker:
    return Tracker(camera=CAMERA, models=[MODEL], clock=clock)


def _off_px(sighting: Seen, pose: Rigid[Camera, Marker]) -> float:
    return float(np.abs(sighting.corners_px - corners_px_of(CAMERA, pose)).max())


def _assert_same(a: Seen, b: Seen) -> None:
    for name in a.__slots__:
        if name == "camera_from_marker":
            np.testing.assert_array_equal(a.camera_from_marker.matrix, b.camera_from_marker.matrix)
        else:
            np.testing.assert_array_equal(getattr(a, name), getattr(b, name))


@pytest.mark.parametrize("roll_deg", range(0, 360, 15))
def test_a_marker_is_found_at_every_turn_with_its_own_top(roll_deg: float) -> None:
    pose = _pose(roll_deg=roll_deg)
    found = seen(_tracker().search(_image(pose))["code"])
    assert _off_px(found, pose) < 0.3
    assert found.found_by == "search"
    assert found.score_ratio > 0.95
    assert found.target_score_ratio > 0.9


@pytest.mark.parametrize("side_px", [22, 30, 60, 120, 200])
def test_a_marker_is_found_at_every_size(side_px: float) -> None:
    pose = _pose(side_px=side_px)
    assert _off_px(seen(_tracker().search(_image(pose))["code"]), pose) < 0.5


@pytest.mark.parametrize("blur_px", [0.0, 1.0, 2.0])
@pytest.mark.parametrize("noise_grey", [0.0, 6.0])
def test_a_marker_is_found_through_blur_and_noise(blur_px: float, noise_grey: float) -> None:
    pose = _pose(side_px=60)
    image = rendered(CAMERA, [Print(picture=code_image(), pose=pose)], blur_px=blur_px, noise_grey=noise_grey)
    assert _off_px(seen(_tracker().search(image)["code"]), pose) < 0.6


def test_a_marker_in_clutter_is_found_where_it_is() -> None:
    for seed in range(6):
        pose = _pose((180.0 + 25 * seed, 150.0 + 10 * seed), roll_deg=60.0 * seed)
        image = rendered(
            CAMERA, [Print(picture=code_image(), pose=pose)], background=cluttered(CAMERA, seed), seed=seed
        )
        assert _off_px(seen(_tracker().search(image)["code"]), pose) < 0.5, seed


def test_clutter_without_a_marker_is_unseen_with_a_reason() -> None:
    for seed in range(12):
        image = rendered(CAMERA, [], background=cluttered(CAMERA, seed, count=80), seed=seed)
        sighting = _tracker().search(image)["code"]
        assert isinstance(sighting, Unseen), seed
        assert sighting.reason in UnseenReason
        assert 0.0 <= sighting.best_score_ratio <= 1.0


@pytest.mark.parametrize(
    "image",
    [
        pytest.param(np.full((360, 480), 128, np.uint8), id="even"),
        pytest.param(np.zeros((360, 480), np.uint8), id="black"),
        pytest.param(np.full((360, 480, 3), 255, np.uint8), id="white, in colour"),
        pytest.param(
            np.random.default_rng(1).integers(0, 256, (360, 480)).astype(np.uint8), id="nothing but noise"
        ),
        pytest.param(
            np.kron(np.indices((18, 24)).sum(axis=0) % 2 * 255, np.ones((20, 20))).astype(np.uint8),
            id="a chessboard",
        ),
    ],
)
def test_in_an_image_without_anything_nothing_is_seen(image: Image8) -> None:
    tracker = _tracker()
    assert isinstance(tracker.search(image)["code"], Unseen)
    assert isinstance(tracker.step(image, captured_at_s=0.0)["code"], Unseen)


def test_nothing_with_the_outline_is_no_candidate_and_scores_nothing() -> None:
    image = np.full((360, 480), 128, np.uint8)
    assert _tracker().search(image)["code"] == Unseen(reason=UnseenReason.NO_CANDIDATE, best_score_ratio=0.0)


NEIGHBOURS = [
    tuple(tuple(v ^ (3 * r + c == k) for c, v in enumerate(row)) for r, row in enumerate(CODE))
    for k in range(9)
]


@pytest.mark.parametrize("fields", NEIGHBOURS)
def test_a_look_alike_that_differs_in_one_field_is_not_taken(fields: Fields) -> None:
    for k, (side_px, tilt_deg) in enumerate([(36, 0), (60, 30), (90, 45)]):
        image = _image(_pose(side_px=side_px, tilt_deg=tilt_deg, roll_deg=50.0 * k), fields=fields)
        sighting = _tracker().search(image)["code"]
        assert isinstance(sighting, Unseen), (side_px, tilt_deg)
        # It was looked at closely, and something was found against it.
        assert sighting.best_score_ratio > 0.4


def test_of_a_marker_among_its_look_alikes_only_it_is_taken() -> None:
    where = [(80.0 + 160 * c, 60.0 + 120 * r) for r in range(3) for c in range(3)]
    for k, own in enumerate(where):
        prints = [Print(picture=code_image(), pose=_pose(own, 44, roll_deg=40.0 * k))]
        others = [px for px in where if px != own]
        prints += [
            Print(picture=code_image(fields), pose=_pose(px, 44, roll_deg=70.0 * n))
            for n, (px, fields) in enumerate(zip(others, NEIGHBOURS, strict=False))
        ]
        sighting = seen(_tracker().search(rendered(CAMERA, prints, seed=k))["code"])
        assert _off_px(sighting, prints[0].pose) < 0.4


def test_the_mirror_image_is_not_taken() -> None:
    image = np.ascontiguousarray(_image(_pose())[:, ::-1])
    assert isinstance(_tracker().search(image)["code"], Unseen)


def test_the_negative_is_not_taken() -> None:
    assert isinstance(_tracker().search(np.asarray(255 - _image(_pose()), np.uint8))["code"], Unseen)


def test_several_markers_are_told_from_one_another_in_one_image() -> None:
    drill = MarkerModel.from_image(drill_emblem(), side_mm=25.0, name="drill")
    models = [MODEL, code_model(OTHER, name="other"), drill, code_model(NEIGHBOURS[4], name="absent")]
    places = {"code": _pose((100, 100)), "other": _pose((350, 110), roll_deg=100), "drill": _pose((230, 270))}
    pictures = {"code": code_image(), "other": code_image(OTHER), "drill": drill_emblem()}
    image = rendered(CAMERA, [Print(picture=pictures[name], pose=pose) for name, pose in places.items()])
    tracker = Tracker(camera=CAMERA, models=models)
    for sightings in (
        tracker.search(image),
        tracker.step(image, captured_at_s=0.0),
        tracker.step(image, captured_at_s=0.03),
    ):
        assert list(sightings) == ["code", "other", "drill", "absent"]
        for name, pose in places.items():
            assert _off_px(seen(sightings[name]), pose) < 0.4
        assert isinstance(sightings["absent"], Unseen)


def test_a_search_knows_nothing_of_the_images_before() -> None:
    here, there = _pose((150, 150)), _pose((330, 200), roll_deg=80)
    tracker = _tracker()
    first = seen(tracker.search(_image(here))["code"])
    tracker.step(_image(there), captured_at_s=0.0)
    tracker.search(_image(there))
    _assert_same(seen(tracker.search(_image(here))["code"]), first)
    _assert_same(seen(_tracker().search(_image(here))["code"]), first)


def test_a_search_leaves_what_step_knows_alone() -> None:
    pose = _pose()
    tracker = _tracker()
    tracker.step(_image(pose), captured_at_s=0.0)
    tracker.search(np.zeros((360, 480), np.uint8))
    assert seen(tracker.step(_image(pose), captured_at_s=0.03)["code"]).found_by == "track"


def test_the_same_images_give_the_same_answers() -> None:
    images = [_image(_pose((200.0 + 3 * k, 180.0)), seed=k) for k in range(4)]
    runs = []
    for _ in range(2):
        tracker = _tracker()
        runs.append([seen(tracker.step(i, captured_at_s=0.03 * k)["code"]) for k, i in enumerate(images)])
    for a, b in zip(*runs, strict=True):
        _assert_same(a, b)


def test_a_marker_that_moves_is_searched_for_once_and_tracked_from_then() -> None:
    tracker = _tracker()
    found_by = []
    for k in range(8):
        pose = _pose((120.0 + 9 * k, 150.0 + 4 * k), roll_deg=2.0 * k)
        found = seen(tracker.step(_image(pose, seed=k), captured_at_s=k / 30)["code"])
        assert _off_px(found, pose) < 0.3
        found_by.append(found.found_by)
    # Nine pixels are over the reach: the second image is searched, then its speed is known.
    assert found_by[0] == "search"
    assert found_by[2:] == ["track"] * 6


def test_a_tracked_marker_is_where_a_search_finds_it() -> None:
    pose = _pose(side_px=70)
    tracker = _tracker()
    tracker.step(_image(pose, seed=1), captured_at_s=0.0)
    image = _image(pose, seed=2)
    tracked, searched = seen(tracker.step(image, captured_at_s=0.03)["code"]), tracker.search(image)["code"]
    assert tracked.found_by == "track"
    np.testing.assert_allclose(tracked.corners_px, seen(searched).corners_px, atol=0.05)
    np.testing.assert_allclose(tracked.score_ratio, seen(searched).score_ratio, atol=0.02)


def test_a_marker_that_jumps_is_found_again_in_the_same_image() -> None:
    tracker = _tracker()
    tracker.step(_image(_pose((120, 120))), captured_at_s=0.0)
    there = _pose((350, 240), roll_deg=130)
    found = seen(tracker.step(_image(there), captured_at_s=0.03)["code"])
    assert found.found_by == "search"
    assert _off_px(found, there) < 0.3


def test_a_marker_that_is_gone_is_unseen_at_once() -> None:
    tracker = _tracker()
    for k in range(3):
        seen(tracker.step(_image(_pose()), captured_at_s=k / 30)["code"])
    for k in range(3, 6):
        assert isinstance(tracker.step(_image(), captured_at_s=k / 30)["code"], Unseen)
    assert seen(tracker.step(_image(_pose()), captured_at_s=0.2)["code"]).found_by == "search"


def test_a_look_alike_put_in_its_place_is_not_tracked() -> None:
    for fields in NEIGHBOURS:
        tracker = _tracker()
        tracker.step(_image(_pose()), captured_at_s=0.0)
        assert isinstance(tracker.step(_image(_pose(), fields=fields), captured_at_s=0.03)["code"], Unseen)


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
    tracker = _tracker()
    tracker.step(_image(_pose()), captured_at_s=5.0)
    there = _pose((300, 200))
    assert seen(tracker.step(_image(_pose()), captured_at_s=at_s)["code"]).found_by == "search"
    assert seen(tracker.step(_image(there), captured_at_s=at_s - 1.0)["code"]).found_by == "search"


@pytest.mark.parametrize("centre_px", [(0.0, 180.0), (240.0, 2.0), (478.0, 358.0)])
def test_a_marker_half_outside_the_image_is_never_claimed_elsewhere(centre_px: tuple[float, float]) -> None:
    tracker = _tracker()
    pose = _pose(centre_px)
    for k in range(2):
        sighting = tracker.step(_image(pose), captured_at_s=0.03 * k)["code"]
        assert isinstance(sighting, Unseen) or _off_px(sighting, pose) < 3.0


def test_a_marker_that_leaves_the_image_is_followed_until_it_is_gone() -> None:
    tracker = _tracker()
    for k in range(20):
        pose = _pose((400.0 + 8.0 * k, 180.0))
        sighting = tracker.step(_image(pose, seed=k), captured_at_s=k / 30)["code"]
        assert isinstance(sighting, Unseen) or _off_px(sighting, pose) < 3.0
    assert isinstance(sighting, Unseen)


def _fingered(pose: Rigid[Camera, Marker], *, side: int, area_ratio: float, grey: int) -> Image8:
    """The marker with a finger a third of a side wide over this part of it, from one side."""
    image = _image(pose)
    corners = corners_px_of(CAMERA, pose)
    a, b = corners[side], corners[(side + 1) % 4]
    inwards = 2.0 * (corners.mean(axis=0) - (a + b) / 2)
    half, deep = (b - a) / 6.0, inwards * 3.0 * area_ratio
    middle = (a + b) / 2
    finger = [middle - half - inwards, middle + half - inwards, middle + half + deep, middle - half + deep]
    cv2.fillConvexPoly(image, np.rint(finger).astype(np.int32), float(grey), cv2.LINE_AA)
    return image


@pytest.mark.parametrize("side", range(4))
@pytest.mark.parametrize("grey", [40, 120, 185])
def test_a_finger_over_a_tenth_of_the_marker_does_not_hide_it(side: int, grey: int) -> None:
    pose = _pose(side_px=64)
    found = seen(_tracker().search(_fingered(pose, side=side, area_ratio=0.1, grey=grey))["code"])
    assert _off_px(found, pose) < 1.0


@pytest.mark.parametrize("side", range(4))
@pytest.mark.parametrize("grey", [40, 120, 185])
@pytest.mark.parametrize("area_ratio", [0.15, 0.2, 0.3])
def test_a_covered_marker_is_where_it_is_or_unseen(side: int, grey: int, area_ratio: float) -> None:
    pose = _pose(side_px=64)
    image = _fingered(pose, side=side, area_ratio=area_ratio, grey=grey)
    sighting = _tracker().search(image)["code"]
    assert isinstance(sighting, Unseen) or _off_px(sighting, pose) < 2.0


def test_strict_settings_turn_the_same_occurrence_down() -> None:
    image = _image(_pose())
    for settings, reason in (
        (ScoreSettings(accept_score_ratio=1.0), UnseenReason.SCORE_TOO_LOW),
        (ScoreSettings(accept_target_score_ratio=1.0), UnseenReason.TARGET_SCORE_TOO_LOW),
    ):
        tracker = Tracker(camera=CAMERA, models=[MODEL], settings=settings)
        sighting = tracker.search(image)["code"]
        assert isinstance(sighting, Unseen)
        assert sighting.reason is reason
        assert sighting.best_score_ratio > 0.9


def test_a_bright_field_too_many_says_that_the_shape_differs() -> None:
    """Without asking the inside, one flipped field of nine has nine tenths of the marker's edges."""
    lenient = ScoreSettings(
        accept_score_ratio=0.3, accept_target_score_ratio=0.3, accept_inner_coverage_ratio=0.0
    )
    tracker = Tracker(camera=CAMERA, models=[MODEL], settings=lenient)
    sighting = tracker.search(_image(_pose(side_px=80), fields=NEIGHBOURS[2]))["code"]
    assert isinstance(sighting, Unseen)
    assert sighting.reason is UnseenReason.SHAPE_DIFFERS


@pytest.mark.parametrize(
    ("image", "code"),
    [
        pytest.param(np.zeros((480, 360), np.uint8), "IMAGE_SIZE_DIFFERS", id="width and height exchanged"),
        pytest.param(np.zeros((720, 960), np.uint8), "IMAGE_SIZE_DIFFERS", id="twice the size"),
        pytest.param(np.zeros((0, 0), np.uint8), "IMAGE_SIZE_DIFFERS", id="empty"),
        pytest.param(np.zeros((360, 480), np.float32), "IMAGE_INVALID", id="floating point"),
        pytest.param(np.zeros((360, 480), np.uint16), "IMAGE_INVALID", id="16 bits"),
        pytest.param(np.zeros((360, 480, 4), np.uint8), "IMAGE_INVALID", id="four channels"),
        pytest.param(np.zeros(480, np.uint8), "IMAGE_INVALID", id="one row without the other dimension"),
    ],
)
def test_an_image_of_another_size_or_kind_is_refused(image: npt.NDArray[np.uint8], code: str) -> None:
    tracker = _tracker()
    with pytest.raises(InvalidInput) as caught:
        tracker.search(image)
    assert caught.value.code == code
    with pytest.raises(InvalidInput) as caught:
        tracker.step(image, captured_at_s=0.0)
    assert caught.value.code == code
    assert caught.value.remedy.endswith(".")


def test_names_that_occur_twice_are_refused() -> None:
    with pytest.raises(InvalidInput, match="2 markers have 1 names: code") as caught:
        Tracker(camera=CAMERA, models=[MODEL, code_model(OTHER, name="code")])
    assert caught.value.code == "MARKER_NAMES_NOT_UNIQUE"


def test_without_models_there_are_no_sightings() -> None:
    tracker = Tracker(camera=CAMERA, models=[])
    assert tracker.search(_image()) == {}
    assert tracker.step(_image(), captured_at_s=0.0) == {}


def test_colour_grey_and_a_view_of_a_larger_image_are_the_same_to_it() -> None:
    grey = _image(_pose())
    large = np.zeros((400, 520), np.uint8)
    large[20:380, 10:490] = grey
    first = seen(_tracker().search(grey)["code"])
    _assert_same(seen(_tracker().search(np.dstack([grey] * 3))["code"]), first)
    _assert_same(seen(_tracker().search(large[20:380, 10:490])["code"]), first)


def test_the_image_is_left_as_it_was() -> None:
    for image in (_image(_pose()), np.dstack([_image(_pose())] * 3)):
        before = image.copy()
        image.setflags(write=False)
        tracker = _tracker()
        tracker.search(image)
        for k in range(3):
            seen(tracker.step(image, captured_at_s=k / 30)["code"])
        np.testing.assert_array_equal(image, before)


def test_what_is_found_has_the_shapes_that_are_promised() -> None:
    found = seen(_tracker().search(_image(_pose()))["code"])
    assert found.corners_px.shape == (4, 2)
    assert found.pose_covariance.shape == (6, 6)
    assert found.corners_px.dtype == found.pose_covariance.dtype == np.float64
    assert np.isfinite(found.corners_px).all()
    assert np.isfinite(found.pose_covariance).all()
    for name in ("score_ratio", "target_score_ratio", "model_coverage_ratio", "target_coverage_ratio"):
        assert 0.0 <= getattr(found, name) <= 1.0
    assert found.score_ratio <= found.model_coverage_ratio
    assert found.target_score_ratio <= found.target_coverage_ratio


def test_an_answer_is_not_changed_by_the_next_image() -> None:
    tracker = _tracker()
    first = seen(tracker.step(_image(_pose((150, 150))), captured_at_s=0.0)["code"])
    corners, matrix = first.corners_px.copy(), first.camera_from_marker.matrix
    for k in range(1, 4):
        tracker.step(_image(_pose((150.0 + 4 * k, 150.0)), seed=k), captured_at_s=k / 30)
    np.testing.assert_array_equal(first.corners_px, corners)
    np.testing.assert_array_equal(first.camera_from_marker.matrix, matrix)


def _ticks(step_s: float) -> Iterator[float]:
    now = 100.0
    while True:
        yield now
        now += step_s


def test_each_stage_has_its_name_and_its_time() -> None:
    ticks = _ticks(0.004)
    tracker = _tracker(clock=lambda: next(ticks))
    image = _image(_pose())
    tracker.search(image)
    assert tracker.stage_ms == pytest.approx(
        {"grey": 4.0, "gradient": 4.0, "edges": 4.0, "candidates": 4.0, "fit": 4.0, "score": 4.0}
    )
    tracker.step(image, captured_at_s=0.0)
    tracker.step(image, captured_at_s=0.03)
    assert tracker.stage_ms == pytest.approx({"grey": 4.0, "gradient": 4.0, "fit": 4.0, "score": 4.0})


def test_without_a_clock_no_time_is_claimed() -> None:
    tracker = _tracker()
    tracker.search(_image(_pose()))
    assert tracker.stage_ms == {}


def test_a_stage_that_comes_twice_is_added_up() -> None:
    times = iter([0.0, 1.0, 1.5, 3.5, 10.0])
    stages = Stages(lambda: next(times))
    stages.start()
    stages.end("fit")
    stages.end("score")
    stages.end("fit")
    assert stages.taken_ms == {"fit": 3000.0, "score": 500.0}
    stages.start()
    assert stages.taken_ms == {}


def test_warming_up_runs_the_loops_of_a_search_and_of_a_track(monkeypatch: pytest.MonkeyPatch) -> None:
    found: list[str] = []

    class Watched(Tracker):
        def step(self, image: Image8, *, captured_at_s: float) -> dict[str, Seen | Unseen]:
            sightings = super().step(image, captured_at_s=captured_at_s)
            found.append(seen(sightings["warm-up"]).found_by)
            return sightings

    monkeypatch.setattr("tracker.warm_up.Tracker", Watched)
    warm_up()
    assert found == ["search", "track", "track"]


@pytest.mark.parametrize("side", range(4))
def test_what_is_inside_must_be_there_whatever_the_outline_says(side: int) -> None:
    pose = _pose(side_px=64)
    image = _fingered(pose, side=side, area_ratio=0.1, grey=185)
    strict = ScoreSettings(accept_inner_coverage_ratio=1.0)
    sighting = Tracker(camera=CAMERA, models=[MODEL], settings=strict).search(image)["code"]
    assert isinstance(sighting, Unseen)
    assert sighting.reason is UnseenReason.SCORE_TOO_LOW
    assert sighting.best_score_ratio > strict.accept_score_ratio
