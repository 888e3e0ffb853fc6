"""Results of a search in one image: found, distinguished, rejected."""

from collections.abc import Iterator

import numpy as np
import pytest

from tests.tracker.pipeline.stepped import CAMERA, MODEL, image_of, off_px, pose_of, tracker_of
from tests.tracker.scenes import CODE as OWN
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
from tracker import MarkerModel, Seen, Tracker, Unseen, UnseenReason
from tracker.marker import Candidate, Templates, thorough_rounds
from tracker.rehearsal.marker_images import drill_marker_image


@pytest.mark.parametrize("roll_deg", range(0, 360, 45))
def test_a_marker_is_found_at_every_turn_with_its_own_top(roll_deg: float) -> None:
    pose = pose_of(roll_deg=roll_deg)
    found = seen(tracker_of().search(image_of(pose))["code"])
    assert off_px(found, pose) < 0.3
    assert found.found_by == "search"
    assert found.score_ratio > 0.95
    assert found.target_score_ratio > 0.9


@pytest.mark.parametrize("side_px", [22, 30, 60, 120, 200])
def test_a_marker_is_found_at_every_size(side_px: float) -> None:
    pose = pose_of(side_px=side_px)
    assert off_px(seen(tracker_of().search(image_of(pose))["code"]), pose) < 0.5


@pytest.mark.parametrize("blur_px", [0.0, 1.0, 2.0])
@pytest.mark.parametrize("noise_grey", [0.0, 6.0])
def test_a_marker_is_found_through_blur_and_noise(blur_px: float, noise_grey: float) -> None:
    pose = pose_of(side_px=60)
    image = rendered(CAMERA, [Print(picture=code_image(), pose=pose)], blur_px=blur_px, noise_grey=noise_grey)
    assert off_px(seen(tracker_of().search(image)["code"]), pose) < 0.6


def test_a_marker_in_clutter_is_found_where_it_is() -> None:
    for seed in range(6):
        pose = pose_of((180.0 + 25 * seed, 150.0 + 10 * seed), roll_deg=60.0 * seed)
        image = rendered(
            CAMERA, [Print(picture=code_image(), pose=pose)], background=cluttered(CAMERA, seed), seed=seed
        )
        assert off_px(seen(tracker_of().search(image)["code"]), pose) < 0.5, seed


def test_clutter_without_a_marker_is_unseen_with_a_reason() -> None:
    for seed in range(4):
        image = rendered(CAMERA, [], background=cluttered(CAMERA, seed, count=80), seed=seed)
        sighting = tracker_of().search(image)["code"]
        assert isinstance(sighting, Unseen), seed
        assert sighting.reason in UnseenReason
        assert sighting.best_score_ratio is not None
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
    tracker = tracker_of()
    assert isinstance(tracker.search(image)["code"], Unseen)
    assert isinstance(tracker.step(image, captured_at_s=0.0)["code"], Unseen)


def test_nothing_with_the_outline_is_no_candidate_and_scores_nothing() -> None:
    image = np.full((360, 480), 128, np.uint8)
    assert tracker_of().search(image)["code"] == Unseen(
        reason=UnseenReason.NO_CANDIDATE, best_score_ratio=0.0
    )


@pytest.mark.parametrize("field", range(9))
def test_a_look_alike_that_differs_in_one_field_is_not_taken(field: int) -> None:
    side_px, tilt_deg = [(36, 0), (60, 30), (90, 45)][field % 3]
    pose = pose_of(side_px=side_px, tilt_deg=tilt_deg, roll_deg=50.0 * field)
    sighting = tracker_of().search(image_of(pose, fields=NEIGHBOURS[field]))["code"]
    assert isinstance(sighting, Unseen)
    # It was refined, and evidence against it was found.
    assert (sighting.best_score_ratio or 0.0) > 0.4


def test_of_a_marker_among_its_look_alikes_only_it_is_taken() -> None:
    where = [(80.0 + 160 * c, 60.0 + 120 * r) for r in range(3) for c in range(3)]
    for k, own in enumerate(where[::4]):
        prints = [Print(picture=code_image(), pose=pose_of(own, 44, roll_deg=40.0 * k))]
        others = [px for px in where if px != own]
        prints += [
            Print(picture=code_image(fields), pose=pose_of(px, 44, roll_deg=70.0 * n))
            for n, (px, fields) in enumerate(zip(others, NEIGHBOURS, strict=False))
        ]
        sighting = seen(tracker_of().search(rendered(CAMERA, prints, seed=k))["code"])
        assert off_px(sighting, prints[0].pose) < 0.4


def test_in_poor_light_a_search_looks_once_more_for_what_it_does_not_find_and_a_step_does_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    requested: list[int] = []

    def counted(image: Image8, templates: Templates) -> Iterator[list[list[Candidate]]]:
        requested.append(len(templates))
        return thorough_rounds(image, templates)

    monkeypatch.setattr("tracker.pipeline.search.thorough_rounds", counted)
    models = [MODEL, code_model(OTHER, name="other"), code_model(NEIGHBOURS[4], name="absent")]
    tracker = Tracker(camera=CAMERA, models=models)
    image = image_of(pose_of())
    assert isinstance(tracker.search(image)["code"], Seen)
    assert requested == [], "where one is found for certain the light is good"
    # Seen, but not with certainty.
    monkeypatch.setattr("tracker.pipeline.fitter.CERTAIN_RANK_SCORE", 4.0)
    tracker.step(image, captured_at_s=0.0)
    tracker_of().search(image)
    assert requested == []
    assert isinstance(tracker.search(image)["code"], Seen)
    assert requested == [2], "for those alone that are not seen"
    tracker.search(np.full_like(image, 128))
    assert requested == [2, 3]


def test_where_nothing_is_sure_the_fourth_likeliest_of_a_round_is_fitted_too(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    places = [(80.0, 80.0), (240.0, 80.0), (80.0, 200.0), (240.0, 200.0), (400.0, 200.0)]
    fields = [*NEIGHBOURS[:3], OWN, OTHER]
    prints = [
        Print(picture=code_image(own), pose=pose_of(px, 44)) for own, px in zip(fields, places, strict=True)
    ]
    image = rendered(CAMERA, prints, seed=3)
    given = [
        Candidate(corners_px=corners_px_of(CAMERA, one.pose), correlation=0.9 - 0.01 * k)
        for k, one in enumerate(prints)
    ]
    monkeypatch.setattr("tracker.pipeline.search.candidate_rounds", lambda *_: iter([[[]]]))
    monkeypatch.setattr("tracker.pipeline.search.thorough_rounds", lambda *_: iter([[given]]))
    found = seen(tracker_of().search(image)["code"])
    assert off_px(found, prints[3].pose) < 0.4


def test_the_mirror_image_is_not_taken() -> None:
    image = np.ascontiguousarray(image_of(pose_of())[:, ::-1])
    assert isinstance(tracker_of().search(image)["code"], Unseen)


def test_the_negative_is_not_taken() -> None:
    assert isinstance(tracker_of().search(np.asarray(255 - image_of(pose_of()), np.uint8))["code"], Unseen)


def test_several_markers_are_distinguished_from_one_another_in_one_image() -> None:
    drill = MarkerModel.from_image(drill_marker_image(), side_mm=25.0, name="drill")
    models = [MODEL, code_model(OTHER, name="other"), drill, code_model(NEIGHBOURS[4], name="absent")]
    places = {
        "code": pose_of((100, 100)),
        "other": pose_of((350, 110), roll_deg=100),
        "drill": pose_of((230, 270)),
    }
    pictures = {"code": code_image(), "other": code_image(OTHER), "drill": drill_marker_image()}
    image = rendered(CAMERA, [Print(picture=pictures[name], pose=pose) for name, pose in places.items()])
    tracker = Tracker(camera=CAMERA, models=models)
    for sightings in (
        tracker.search(image),
        tracker.step(image, captured_at_s=0.0),
        tracker.step(image, captured_at_s=0.03),
    ):
        assert list(sightings) == ["code", "other", "drill", "absent"]
        for name, pose in places.items():
            assert off_px(seen(sightings[name]), pose) < 0.4
        assert isinstance(sightings["absent"], Unseen)
