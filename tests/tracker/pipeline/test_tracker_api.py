"""The public interface of the tracker: settings, validation, occluded markers, results."""

from collections.abc import Iterator

import cv2
import numpy as np
import numpy.typing as npt
import pytest

from tests.tracker.pipeline.stepped import CAMERA, MODEL, assert_same, image_of, off_px, pose_of, tracker_of
from tests.tracker.scenes import (
    NEIGHBOURS,
    OTHER,
    Image8,
    code_model,
    corners_px_of,
    seen,
)
from tracker import InvalidInput, Seen, Tracker, Unseen, UnseenReason
from tracker.geometry import Camera, Marker, Rigid
from tracker.marker import MarkerModel, ScoreSettings, templates_of
from tracker.photometric import textures_of
from tracker.stage_timer import StageTimer
from tracker.warm_up import warm_up


def _fingered(pose: Rigid[Camera, Marker], *, side: int, area_ratio: float, grey: int) -> Image8:
    """The marker with a finger, a third of a side wide, over this part of it."""
    image = image_of(pose)
    corners = corners_px_of(CAMERA, pose)
    a, b = corners[side], corners[(side + 1) % 4]
    inwards = 2.0 * (corners.mean(axis=0) - (a + b) / 2)
    half, deep = (b - a) / 6.0, inwards * 3.0 * area_ratio
    middle = (a + b) / 2
    finger = [middle - half - inwards, middle + half - inwards, middle + half + deep, middle - half + deep]
    cv2.fillConvexPoly(image, np.rint(finger).astype(np.int32), float(grey), cv2.LINE_AA)
    return image


@pytest.mark.parametrize("side", range(4))
@pytest.mark.parametrize("grey", [40, 185])
def test_a_finger_over_a_tenth_of_the_marker_does_not_hide_it(side: int, grey: int) -> None:
    pose = pose_of(side_px=64)
    found = seen(tracker_of().search(_fingered(pose, side=side, area_ratio=0.1, grey=grey))["code"])
    assert off_px(found, pose) < 1.0


@pytest.mark.parametrize("side", range(4))
@pytest.mark.parametrize(("grey", "area_ratio"), [(40, 0.2), (185, 0.3)])
def test_a_covered_marker_is_where_it_is_or_unseen(side: int, grey: int, area_ratio: float) -> None:
    pose = pose_of(side_px=64)
    image = _fingered(pose, side=side, area_ratio=area_ratio, grey=grey)
    sighting = tracker_of().search(image)["code"]
    assert isinstance(sighting, Unseen) or off_px(sighting, pose) < 2.0


def test_strict_settings_turn_the_same_occurrence_down() -> None:
    image = image_of(pose_of())
    for settings, reason in (
        (ScoreSettings(accept_score_ratio=1.0, verified_threshold_ratio=1.0), UnseenReason.SCORE_TOO_LOW),
        (ScoreSettings(accept_target_score_ratio=1.0), UnseenReason.TARGET_SCORE_TOO_LOW),
    ):
        tracker = Tracker(camera=CAMERA, models=[MODEL], settings=settings)
        sighting = tracker.search(image)["code"]
        assert isinstance(sighting, Unseen)
        assert sighting.reason is reason
        assert (sighting.best_score_ratio or 0.0) > 0.9


def test_an_additional_bright_field_gives_shape_differs() -> None:
    """Without verification of the inside, one flipped field of nine keeps nine tenths of the edges."""
    lenient = ScoreSettings(
        accept_score_ratio=0.3, accept_target_score_ratio=0.3, accept_inner_coverage_ratio=0.0
    )
    tracker = Tracker(camera=CAMERA, models=[MODEL], settings=lenient)
    sighting = tracker.search(image_of(pose_of(side_px=80), fields=NEIGHBOURS[2]))["code"]
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
        pytest.param(None, "IMAGE_INVALID", id="what is read of a file that is not there"),
    ],
)
def test_an_image_of_another_size_or_kind_is_rejected(image: npt.NDArray[np.uint8], code: str) -> None:
    tracker = tracker_of()
    with pytest.raises(InvalidInput) as caught:
        tracker.search(image)
    assert caught.value.code == code
    with pytest.raises(InvalidInput) as caught:
        tracker.step(image, captured_at_s=0.0)
    assert caught.value.code == code
    assert caught.value.remedy.endswith(".")


def test_names_that_occur_twice_are_rejected() -> None:
    with pytest.raises(InvalidInput, match="2 markers have 1 names: code") as caught:
        Tracker(camera=CAMERA, models=[MODEL, code_model(OTHER, name="code")])
    assert caught.value.code == "MARKER_NAMES_NOT_UNIQUE"


def test_templates_and_textures_of_a_picture_are_computed_once() -> None:
    again = MarkerModel.from_image(MODEL.image, side_mm=30.0, name="again")
    assert textures_of(again.square) is textures_of(MODEL.square)
    assert templates_of([again]).each[0] is templates_of([MODEL]).each[0]
    assert textures_of(code_model(OTHER).square) is not textures_of(MODEL.square)


def test_without_models_there_are_no_sightings() -> None:
    tracker = Tracker(camera=CAMERA, models=[])
    assert tracker.search(image_of()) == {}
    assert tracker.step(image_of(), captured_at_s=0.0) == {}


def test_colour_grey_and_a_view_of_a_larger_image_are_the_same_to_it() -> None:
    grey = image_of(pose_of())
    large = np.zeros((400, 520), np.uint8)
    large[20:380, 10:490] = grey
    first = seen(tracker_of().search(grey)["code"])
    assert_same(seen(tracker_of().search(np.dstack([grey] * 3))["code"]), first)
    assert_same(seen(tracker_of().search(large[20:380, 10:490])["code"]), first)


def test_the_image_is_left_as_it_was() -> None:
    for image in (image_of(pose_of()), np.dstack([image_of(pose_of())] * 3)):
        before = image.copy()
        tracker = tracker_of()
        tracker.search(image)
        for k in range(3):
            seen(tracker.step(image, captured_at_s=k / 30)["code"])
        np.testing.assert_array_equal(image, before)


def test_what_is_found_has_the_shapes_that_are_promised() -> None:
    found = seen(tracker_of().search(image_of(pose_of()))["code"])
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
    tracker = tracker_of()
    first = seen(tracker.step(image_of(pose_of((150, 150))), captured_at_s=0.0)["code"])
    corners, matrix = first.corners_px.copy(), first.camera_from_marker.matrix
    for k in range(1, 4):
        tracker.step(image_of(pose_of((150.0 + 4 * k, 150.0)), seed=k), captured_at_s=k / 30)
    np.testing.assert_array_equal(first.corners_px, corners)
    np.testing.assert_array_equal(first.camera_from_marker.matrix, matrix)


def _ticks(step_s: float) -> Iterator[float]:
    now = 100.0
    while True:
        yield now
        now += step_s


def test_each_stage_has_its_name_and_its_time() -> None:
    ticks = _ticks(0.004)
    tracker = tracker_of(clock=lambda: next(ticks))
    image = image_of(pose_of())
    tracker.search(image)
    # The second candidate search is for a second print.
    assert tracker.stage_ms == pytest.approx(
        {"grey": 4.0, "gradient": 4.0, "candidates": 8.0, "fit": 4.0, "score": 4.0, "judgement": 4.0}
    )
    tracker.step(image, captured_at_s=0.0)
    tracker.step(image, captured_at_s=0.03)
    # The second judgement is that of the focal length.
    assert tracker.stage_ms == pytest.approx(
        {"grey": 4.0, "gradient": 4.0, "fit": 4.0, "score": 4.0, "judgement": 8.0}
    )


def test_without_a_clock_no_time_is_claimed() -> None:
    tracker = tracker_of()
    tracker.search(image_of(pose_of()))
    assert tracker.stage_ms == {}


def test_a_stage_that_comes_twice_is_added_up() -> None:
    times = iter([0.0, 1.0, 1.5, 3.5, 10.0])
    stages = StageTimer(lambda: next(times))
    stages.start()
    stages.end("fit")
    stages.end("score")
    stages.end("fit")
    assert stages.elapsed_ms == {"fit": 3000.0, "score": 500.0}
    stages.start()
    assert stages.elapsed_ms == {}


def test_the_edges_of_every_model_are_extracted_before_the_first_image() -> None:
    # Two: the first one's may be needed by the warm-up anyway.
    models = [
        MarkerModel.from_image(model.image, side_mm=model.side_mm, name=model.name)
        for model in (MODEL, code_model(OTHER, name="other"))
    ]
    assert not any("levels" in vars(model) for model in models)
    Tracker(camera=CAMERA, models=models)
    assert all("levels" in vars(model) for model in models)


def test_warming_up_runs_the_loops_of_a_search_and_of_a_track(monkeypatch: pytest.MonkeyPatch) -> None:
    found: list[str] = []

    class MonitoredTracker(Tracker):
        def step(
            self,
            image: Image8,
            *,
            captured_at_s: float,
            full_search: bool = False,
            is_predicted: bool = False,
        ) -> dict[str, Seen | Unseen]:
            sightings = super().step(
                image, captured_at_s=captured_at_s, full_search=full_search, is_predicted=is_predicted
            )
            found.append(seen(sightings["warm-up"]).found_by)
            return sightings

    monkeypatch.setattr("tracker.warm_up.Tracker", MonitoredTracker)
    warm_up()
    assert found == ["search", "track", "track"]


@pytest.mark.parametrize("side", range(4))
def test_the_inside_must_match_whatever_the_outline(side: int) -> None:
    pose = pose_of(side_px=64)
    image = _fingered(pose, side=side, area_ratio=0.1, grey=185)
    strict = ScoreSettings(accept_inner_coverage_ratio=1.0, verified_threshold_ratio=1.0)
    sighting = Tracker(camera=CAMERA, models=[MODEL], settings=strict).search(image)["code"]
    assert isinstance(sighting, Unseen)
    assert sighting.reason is UnseenReason.SCORE_TOO_LOW
    assert (sighting.best_score_ratio or 0.0) > strict.accept_score_ratio


def test_the_first_tracker_of_a_process_loads_what_an_image_needs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Tracker, "_has_loaded", False)
    came_so_far: list[str] = []

    def watched(_: StageTimer, stage: str) -> None:
        came_so_far.append(stage)

    monkeypatch.setattr(StageTimer, "end", watched)
    tracker_of()
    assert {"gradient", "candidates", "fit", "score", "judgement"} <= set(came_so_far)
    came_so_far.clear()
    tracker_of()
    assert not came_so_far, "the second one has nothing to load"
