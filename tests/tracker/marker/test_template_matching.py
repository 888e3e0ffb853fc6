"""Template matching and refinement of quads, also under occlusion and shadow."""

import cv2
import numpy as np
import pytest

from tests.tracker.scenes import (
    OTHER,
    Image8,
    camera_of,
    code_model,
    facing_at_px,
    in_clutter,
    motion_blurred,
)
from tracker.geometry import Array
from tracker.marker import templates_of
from tracker.marker.template_matching import Templates, refine_quads, template_match
from tracker.marker.template_matching.template_kernels import distinct

CAMERA = camera_of((320, 240), focal_px=500.0)
SIDE_PX = 28.0


@pytest.fixture(scope="module")
def templates() -> Templates:
    return templates_of((code_model(), code_model(OTHER, name="other")))


def _scene() -> tuple[Image8, Array]:
    pose = facing_at_px(CAMERA, (160.3, 119.6), SIDE_PX, tilt_deg=30, roll_deg=20.0)
    return in_clutter(CAMERA, pose, clutter=1, noise_grey=1.0)


def _covered(image: Image8, corners: Array) -> Image8:
    """Occlude a quarter of it by a finger."""
    tip = np.rint(corners[0]).astype(int)
    out = cv2.circle(image.copy(), (int(tip[0]), int(tip[1])), 14, 150, -1, cv2.LINE_AA)
    return np.asarray(out, dtype=np.uint8)


def _half_in_shadow(image: Image8, corners: Array) -> Image8:
    """Add a shadow edge through its middle."""
    ramp = 1.0 - 0.7 / (1.0 + np.exp(-(np.arange(image.shape[1]) - corners[:, 0].mean()) / 3.0))
    return np.asarray(image * ramp, np.uint8)


CASES = [
    pytest.param(lambda image, _: image, 1.0, id="sharp"),
    pytest.param(lambda image, _: cv2.GaussianBlur(image, (0, 0), 2.0), 1.8, id="out of focus"),
    pytest.param(lambda image, _: motion_blurred(image, 8, 30), 1.8, id="in motion"),
    pytest.param(_covered, 2.5, id="partly covered"),
    pytest.param(_half_in_shadow, 1.2, id="half in the shadow"),
]


@pytest.mark.parametrize(("seen_as", "off_px"), CASES)
def test_a_quad_off_by_a_tenth_of_its_side_is_refined(
    templates: Templates, seen_as: object, off_px: float
) -> None:
    assert callable(seen_as)
    image, corners = _scene()
    picture = np.asarray(seen_as(image, corners), dtype=np.uint8)
    off = np.random.default_rng(5).normal(0.0, 0.07 * SIDE_PX, (12, 4, 2))
    found, correlation = refine_quads(picture, (corners + off).astype(np.float32), templates.each[0])
    left = np.abs(found - corners).max(axis=(1, 2))
    assert np.median(np.abs(off).max(axis=(1, 2))) > 2.5
    assert np.median(left) < off_px
    assert np.median(correlation) > 0.9


def test_a_skewed_quad_becomes_a_possible_view_of_a_square(templates: Templates) -> None:
    """Motion blur leaves corners free; a square of this size appears as a parallelogram, within a pixel."""
    image, corners = _scene()
    picture = motion_blurred(image, 8, 30)
    off = np.random.default_rng(7).normal(0.0, 0.07 * SIDE_PX, (12, 4, 2))
    found, _ = refine_quads(picture, (corners + off).astype(np.float32), templates.each[0])
    apart = np.abs(found[:, 0] - found[:, 1] + found[:, 2] - found[:, 3]).max(axis=1)
    assert np.median(np.abs(off[:, 0] - off[:, 1] + off[:, 2] - off[:, 3]).max(axis=1)) > 3.0
    assert np.median(apart) < 1.2


def test_a_fitting_quad_is_not_moved(templates: Templates) -> None:
    image, corners = _scene()
    known = corners[None].astype(np.float32)
    found, correlation = refine_quads(image, known, templates.each[0])
    assert np.array_equal(found, known)
    assert correlation[0] > 0.98


def test_another_marker_does_not_match_after_refinement(templates: Templates) -> None:
    image, corners = _scene()
    known = corners[None].astype(np.float32)
    own, other = (refine_quads(image, known, template)[1][0] for template in templates.each)
    assert other < 0.9 < own


@pytest.mark.parametrize("turn", range(4))
def test_the_template_match_identifies_rotation_and_model(templates: Templates, turn: int) -> None:
    """Rotation k: the quad's first corner is the model's corner k."""
    image, corners = _scene()
    quads = np.roll(corners, -turn, axis=0)[None].astype(np.float32)
    assert int(template_match(image, quads, templates)[0].argmax()) == turn


def test_occlusion_lowers_the_template_match_but_little_the_refined_correlation(templates: Templates) -> None:
    image, corners = _scene()
    picture, quads = _covered(image, corners), corners[None].astype(np.float32)
    whole = template_match(picture, quads, templates)[0, 0, 0]
    _, (past,) = refine_quads(picture, quads, templates.each[0])
    assert whole < past - 0.05
    assert past > 0.85


def test_of_duplicate_quads_the_best_is_kept() -> None:
    square = np.array([[0, 0], [20, 0], [20, 20], [0, 20]], np.float32)
    quads = np.array([square, square + 0.5, square + 60, np.roll(square, 1, axis=0), square + 90], np.float32)
    ncc = np.array([0.90, 0.95, 0.8, 0.85, 0.5], np.float32)
    order = np.argsort(-ncc)
    nothing = np.empty((0, 4, 2), np.float32)
    # The same corners in another turn are another outline; what is not like it is none.
    assert distinct(quads, ncc, order, nothing, 4, 0.7, 0.06).tolist() == [1, 3, 2]
    assert distinct(quads, ncc, order, nothing, 2, 0.7, 0.06).tolist() == [1, 3]
    assert distinct(quads, ncc, order, quads[2:3], 4, 0.7, 0.06).tolist() == [1, 3]
