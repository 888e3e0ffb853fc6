"""Needle detection in rendered theatres, with and without needles."""

import cv2
import numpy as np
import pytest

from tests.tracker.registration.needles.needle_scenes import CAMERA
from tracker.errors import InvalidInput, RegistrationError
from tracker.geometry import Array, vector_from_rotation
from tracker.plan import Landmark
from tracker.registration.needles import (
    DetectedNeedle,
    RulerMeasurement,
    detect_needles,
    needle_from_clicks,
    planned_at_landmarks,
    propose_needles,
    refine_marked,
)
from tracker.rehearsal import Theatre, TheatreSettings
from tracker.verification.user_errors import measure_by_ruler, needle_entries

BACKGROUND, METAL, HEAD = (110, 90, 40), (180, 178, 176), (60, 180, 230)


def drawn(lines: list[tuple[Array, Array]], *, width_px: float = 4.6) -> Array:
    """Needles (entry, head) in an otherwise dull image, eight times as fine and then averaged."""
    image = np.full((720 * 4, 1280 * 4, 3), BACKGROUND, np.uint8)
    for entry, head in lines:
        ends = [tuple(int(v) for v in np.rint(p * 4 * 16)) for p in (entry + 0.375, head + 0.375)]
        cv2.line(image, ends[0], ends[1], METAL, round(width_px * 4), cv2.LINE_AA, 4)
        cv2.circle(image, ends[1], round(7.5 * 4 * 16), HEAD, -1, cv2.LINE_AA, 4)
    small = cv2.resize(image, (1280, 720), interpolation=cv2.INTER_AREA).astype(np.float64)
    noise = np.random.default_rng(4).normal(0.0, 2.0, small.shape)
    return np.clip(small + noise, 0, 255).astype(np.uint8)


def test_a_drawn_needle_is_found_to_a_part_of_a_pixel_with_its_width_and_its_ends() -> None:
    entry, head = np.array([500.0, 480.0]), np.array([540.3, 372.6])
    found = detect_needles(drawn([(entry, head)]), CAMERA)
    assert len(found) == 1
    assert found[0].has_head
    seen = found[0].seen
    along = (head - entry) / np.linalg.norm(head - entry)
    beside = np.array([-along[1], along[0]])
    assert abs((seen.entry_px - entry) @ beside) < 0.5
    assert abs((seen.head_px - head) @ beside) < 0.5
    assert abs((seen.entry_px - entry) @ along) < 5.0
    assert -12.0 < (seen.head_px - head) @ along < 0.0
    assert seen.width_px == pytest.approx(4.75, abs=0.8)
    assert not seen.entry_is_seen


def test_nothing_is_found_where_nothing_is() -> None:
    random = np.random.default_rng(2)
    assert detect_needles(np.full((720, 1280, 3), 90, np.uint8), CAMERA) == ()
    assert detect_needles(random.integers(0, 255, (720, 1280, 3), dtype=np.uint8), CAMERA) == ()
    cloth = cv2.GaussianBlur(random.integers(0, 255, (720, 1280, 3), dtype=np.uint8), (0, 0), 6.0)
    assert [one for one in detect_needles(cloth, CAMERA) if one.has_head] == []
    points = [(0, 0, 0), (30, 0, 0), (0, 30, 9)]
    places = planned_at_landmarks([Landmark(name=str(p), point_lps_mm=np.array(p)) for p in points])
    measured = RulerMeasurement(vertical_mm=300, horizontal_mm=400)
    with pytest.raises(RegistrationError) as caught:
        propose_needles(np.full((720, 1280, 3), 90, np.uint8), places, CAMERA, measured)
    assert caught.value.code == "NEEDLES_NOT_FOUND"


@pytest.mark.parametrize("image", [np.zeros((10, 10, 3), np.uint8), np.zeros((720, 1280, 3)), np.zeros(0)])
def test_an_image_that_is_not_the_cameras_is_rejected(image: Array) -> None:
    with pytest.raises(InvalidInput, match="720 rows"):
        detect_needles(image, CAMERA)


@pytest.mark.parametrize("seed", [5])
def test_needles_marked_roughly_in_a_theatre_are_laid_onto_their_wires(seed: int) -> None:
    theatre = Theatre(TheatreSettings(seed=seed))
    image = theatre.renderer().image_at(0.0)
    truth = []
    for needle in theatre.needles:
        ends = np.stack([needle.tip_in_vertebra_mm, needle.head_in_vertebra_mm])
        truth.append(theatre.camera.px_from_camera(theatre.camera_from_vertebra.move_points(ends)))
    rough = [needle_from_clicks(one[0] * 0.6 + one[1] * 0.4 + 4.0, one[1] - 3.0, sd_px=4.0) for one in truth]
    for one, mark, ends in zip(refine_marked(image, theatre.camera, rough), rough, truth, strict=True):
        along = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
        beside = np.array([-along[1], along[0]])
        assert one is not mark
        assert abs((one.entry_px - ends[0]) @ beside) < 1.5
        assert abs((one.head_px - ends[0]) @ beside) < 1.5


def test_a_theatres_needles_are_proposed_under_their_names_among_the_first_two() -> None:
    theatre = Theatre(TheatreSettings(seed=4))
    image = theatre.renderer().image_at(0.0)
    entries = needle_entries(theatre.needles)
    landmarks = [Landmark(name=str(n), point_lps_mm=at) for n, at in enumerate(entries)]
    random = np.random.default_rng(4)
    measured = measure_by_ruler(theatre, entries.mean(axis=0), random)
    proposals = propose_needles(image, planned_at_landmarks(landmarks), theatre.camera, measured)
    probabilities = [one.probability_ratio for one in proposals]
    assert probabilities == sorted(probabilities, reverse=True)
    assert sum(probabilities) <= 1.0 + 1e-9
    assert len(probabilities) >= 2
    assert proposals[0].delta_chi2 == pytest.approx(-proposals[1].delta_chi2)
    right = [all(map(_is_on_line, one.needles, _lines_px(theatre))) for one in proposals]
    assert any(right[:2])
    fit = proposals[right.index(True)].fit
    assert max(one.offset_mm for one in fit.residuals) < 3.0
    pose = fit.registration.anchor_from_vertebra
    truth = theatre.camera_from_vertebra
    off = np.append(
        truth.translation_mm - pose.translation_mm, vector_from_rotation(truth.rotation @ pose.rotation.T)
    )
    assert off @ np.linalg.solve(fit.registration.covariance, off) < 22.5


def _lines_px(theatre: Theatre) -> list[Array]:
    pose, needles = theatre.camera_from_vertebra, theatre.needles
    ends = [np.stack([one.tip_in_vertebra_mm, one.head_in_vertebra_mm]) for one in needles]
    return [theatre.camera.px_from_camera(pose.move_points(one)) for one in ends]


def _is_on_line(needle: DetectedNeedle, line: Array) -> bool:
    along = (line[1] - line[0]) / np.linalg.norm(line[1] - line[0])
    beside = np.array([-along[1], along[0]])
    return all(
        abs(float((end - line[0]) @ beside)) < 3.0 for end in (needle.seen.entry_px, needle.seen.head_px)
    )
