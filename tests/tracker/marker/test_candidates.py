"""Candidate search without any prior knowledge of the marker's position."""

from collections.abc import Iterator

import cv2
import numpy as np
import pytest

from tests.benchmarks.scenes.conditions import conditions_of
from tests.benchmarks.scenes.faces import FACES, Face
from tests.benchmarks.scenes.placement import random_scene
from tests.benchmarks.scenes.rigs import RIGS
from tests.benchmarks.scenes.scene import image_of
from tests.tracker.scenes import (
    OTHER,
    Image8,
    Print,
    camera_of,
    code_image,
    code_model,
    corners_px_of,
    facing_at_px,
    in_clutter,
    rendered,
)
from tracker.geometry import Array
from tracker.marker import (
    Candidate,
    MarkerModel,
    candidate_rounds,
    templates_of,
    thorough_rounds,
)

CAMERA = camera_of((480, 360), focal_px=500.0)
MODEL = code_model()


def _rounds(image: Image8, models: tuple[MarkerModel, ...] = (MODEL,)) -> list[list[list[Candidate]]]:
    return list(candidate_rounds(image, templates_of(models)))


def _scene(
    side_px: float, *, tilt_deg: float = 0.0, roll_deg: float = 0.0, blur_px: float = 0.6, seed: int = 0
) -> tuple[Image8, Array]:
    pose = facing_at_px(CAMERA, (230.0, 175.0), side_px, tilt_deg=tilt_deg, about_deg=20, roll_deg=roll_deg)
    return in_clutter(CAMERA, pose, clutter=seed, blur_px=blur_px, seed=seed)


def _off_px(candidate: Candidate, corners: Array) -> float:
    return float(np.abs(candidate.corners_px - corners).max())


@pytest.mark.parametrize(
    ("side_px", "tilt_deg", "roll_deg"),
    [
        (16, 0, 0),
        (16, 0, 135),
        (27, 55, 45),
        (27, 55, 180),
        (40, 20, 90),
        (90, 60, 225),
        (90, 60, 270),
        (200, 30, 315),
    ],
)
def test_the_first_candidate_of_the_first_round_is_the_marker_upright(
    side_px: float, tilt_deg: float, roll_deg: int
) -> None:
    image, corners = _scene(side_px, tilt_deg=tilt_deg, roll_deg=roll_deg, seed=roll_deg)
    first = next(candidate_rounds(image, templates_of((MODEL,))))[0][0]
    assert _off_px(first, corners) < max(1.5, 0.03 * side_px)
    assert first.correlation > 0.7


def _found_in(image: Image8, corners: Array, side_px: float) -> int | None:
    """Return the round that yields the marker closely enough for a fit to start."""
    for k, one in enumerate(_rounds(image)):
        if any(_off_px(candidate, corners) < max(2.5, 0.1 * side_px) for candidate in one[0]):
            return k
    return None


@pytest.mark.parametrize(("from_deg", "grey"), [(0, 20), (135, 140), (180, 140), (270, 20)])
def test_a_marker_partly_occluded_by_a_finger_is_found(from_deg: int, grey: int) -> None:
    image, corners = _scene(40, tilt_deg=20, roll_deg=25)
    toward = np.array([np.cos(np.radians(from_deg)), np.sin(np.radians(from_deg))])
    tip = corners.mean(axis=0) + 30.0 * toward
    ends = np.rint([tip, tip + 300.0 * toward]).astype(int).tolist()
    covered = cv2.line(image.copy(), ends[0], ends[1], grey, 30, cv2.LINE_AA)
    assert _found_in(np.asarray(covered, np.uint8), corners, 40) is not None


@pytest.mark.parametrize("roll_deg", [0, 60, 240])
def test_a_marker_under_a_shadow_edge_is_found(roll_deg: int) -> None:
    image, corners = _scene(40, roll_deg=roll_deg)
    ramp = 1.0 - 0.8 / (1.0 + np.exp(-(np.arange(480) - corners[:, 0].mean()) / 4.0))
    assert _found_in(np.asarray(image * ramp, np.uint8), corners, 40) is not None


@pytest.mark.parametrize(("side_px", "blur_px"), [(27, 2.0), (60, 4.0)])
def test_a_marker_out_of_focus_is_found(side_px: float, blur_px: float) -> None:
    for roll_deg in (0, 120):
        image, corners = _scene(side_px, roll_deg=roll_deg, blur_px=blur_px, seed=roll_deg)
        assert _found_in(image, corners, side_px) is not None, roll_deg


def test_a_thin_frame_motion_blurred_along_two_sides_is_found() -> None:
    """The other two sides are blurred away, and with them all four corners."""
    thin = Face(
        name="thin",
        white=(np.array([(0.08, 0.08), (0.92, 0.08), (0.92, 0.92), (0.08, 0.92)]),),
        black=(np.array([(0.25, 0.2), (0.75, 0.2), (0.75, 0.5), (0.5, 0.8), (0.25, 0.8)]),),
    )
    templates = templates_of([thin.model])
    for seed in range(3):
        scene = random_scene(RIGS["A"], thin, conditions_of(RIGS["A"])["motion8"], seed=seed)
        given = [one for each in candidate_rounds(image_of(scene), templates) for one in each[0]]
        assert any(_off_px(one, scene.corners_px) < 0.15 * 27 for one in given), seed


def test_candidates_of_a_large_image_are_in_full_resolution_pixels() -> None:
    """The centre of a half-size pixel lies between four: an error of half a pixel would fail here."""
    camera = camera_of((1400, 1000), focal_px=1400.0)
    pose = facing_at_px(camera, (900.0, 400.0), 80, tilt_deg=30, roll_deg=70)
    image = rendered(camera, [Print(picture=code_image(), pose=pose)])
    corners = corners_px_of(camera, pose)
    first = next(candidate_rounds(image, templates_of((MODEL,))))[0][0]
    assert np.abs(first.corners_px.mean(axis=0) - corners.mean(axis=0)).max() < 0.4
    assert _off_px(first, corners) < 1.5


def test_each_round_yields_few_new_candidates_the_best_first() -> None:
    image, _ = _scene(40, roll_deg=30)
    given = _rounds(image)
    assert len(given) >= 2
    for candidates in (one[0] for one in given):
        assert len(candidates) <= 4
        # After the most similar candidates come those that are most similar part by part.
        assert all(one.correlation <= candidates[0].correlation for one in candidates)
    every = [candidate.corners_px for one in given for candidate in one[0]]
    for i, a in enumerate(every):
        assert all(np.abs(a - b).max() > 1.0 for b in every[:i])


def test_each_of_several_models_has_its_own_best_candidate() -> None:
    places = ((120.0, 120.0), (330.0, 220.0))
    fields = (code_image(), code_image(OTHER))
    poses = [facing_at_px(CAMERA, place, 40, roll_deg=100) for place in places]
    image = rendered(CAMERA, [Print(picture=one, pose=pose) for one, pose in zip(fields, poses, strict=True)])
    first = next(candidate_rounds(image, templates_of((MODEL, code_model(OTHER, name="other")))))
    for candidates, pose in zip(first, poses, strict=True):
        assert _off_px(candidates[0], corners_px_of(CAMERA, pose)) < 1.5


def test_thorough_rounds_find_markers_that_standard_rounds_miss_in_poor_light() -> None:
    """Shadow, highlight, motion blur, noise and occlusion together: the benchmark's hardest scenes."""
    missed, given = 0, 0
    for seed in range(700, 712):
        face = FACES[seed % len(FACES)]
        scene = random_scene(RIGS["A"], face, conditions_of(RIGS["A"])["hard2"], seed=seed)
        image, templates = image_of(scene), templates_of((face.model,))
        if not _is_among(candidate_rounds(image, templates), scene.corners_px):
            missed += 1
            given += _is_among(thorough_rounds(image, templates), scene.corners_px)
    assert missed >= 5, "else these scenes say nothing"
    assert given >= 3


@pytest.mark.parametrize("seed", [707, 721])
def test_edges_of_the_smoothed_image_find_markers_under_noise(seed: int) -> None:
    face = FACES[seed % len(FACES)]
    scene = random_scene(RIGS["A"], face, conditions_of(RIGS["A"])["hard2"], seed=seed)
    assert _is_among(thorough_rounds(image_of(scene), templates_of((face.model,))), scene.corners_px)


def test_thorough_rounds_yield_nothing_cut_by_the_image_border() -> None:
    image, corners = _scene(60, roll_deg=20)
    cut = np.ascontiguousarray(image[: int(corners[:, 1].mean())])
    templates = templates_of((MODEL,))
    for one in thorough_rounds(cut, templates):
        assert all(candidate.corners_px[:, 1].max() < len(cut) + 0.4 * 60 for candidate in one[0])
    assert _is_among(thorough_rounds(image, templates), corners)


def _is_among(rounds: Iterator[list[list[Candidate]]], corners: Array) -> bool:
    return any(_off_px(candidate, corners) < 3.5 for one in rounds for candidate in one[0])


def test_candidates_are_deterministic() -> None:
    image, _ = _scene(30, roll_deg=20)
    once, again = _rounds(image), _rounds(image)
    for a, b in zip(once, again, strict=True):
        assert [c.correlation for c in a[0]] == [c.correlation for c in b[0]]


@pytest.mark.parametrize("size_wh", [(1, 1), (2, 3), (7, 5), (30, 12), (33, 257)])
def test_a_tiny_image_has_no_candidates(size_wh: tuple[int, int]) -> None:
    noise = np.random.default_rng(3).integers(0, 256, size_wh[::-1]).astype(np.uint8)
    for image in (noise, np.zeros_like(noise), np.full_like(noise, 255)):
        assert all(len(one[0]) <= 4 for one in _rounds(image))


@pytest.mark.parametrize("grey", [0, 128, 255])
def test_a_uniform_image_has_no_candidates(grey: int) -> None:
    assert all(one == [[]] for one in _rounds(np.full((360, 480), grey, np.uint8)))


def test_no_models_yield_no_candidates() -> None:
    assert all(one == [] for one in _rounds(_scene(40)[0], ()))


@pytest.mark.parametrize(
    "image",
    [
        pytest.param(np.random.default_rng(1).integers(0, 256, (360, 480)).astype(np.uint8), id="noise"),
        pytest.param(
            (np.indices((360, 480)).sum(axis=0) % 2 * 255).astype(np.uint8), id="chessboard of pixels"
        ),
        pytest.param(
            np.kron(np.indices((36, 48)).sum(axis=0) % 2 * 255, np.ones((10, 10))).astype(np.uint8),
            id="chessboard",
        ),
        pytest.param(
            np.kron(np.tile([[255, 255], [255, 0]], (18, 24)), np.ones((10, 10))).astype(np.uint8),
            id="squares without end",
        ),
    ],
)
def test_images_full_of_edges_yield_finite_candidates(image: Image8) -> None:
    for one in _rounds(image):
        assert len(one[0]) <= 4
        for candidate in one[0]:
            assert np.isfinite(candidate.corners_px).all()
