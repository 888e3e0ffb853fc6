"""Outlines: where a dark square could be."""

import numpy as np
import pytest

from tests.tracker.scenes import (
    Print,
    camera_of,
    code_image,
    code_model,
    corners_px_of,
    facing_at_px,
    rendered,
)
from tracker.edges import gradient_of
from tracker.geometry import Array
from tracker.marker import candidates_of, outlines_in, templates_of
from tracker.marker.outline import Quads, quads_of

CAMERA = camera_of((320, 240), focal_px=400.0)


def _sides(corners: Array) -> Quads:
    """The four sides as segments (4, 4), clockwise."""
    return np.asarray(np.hstack([corners, np.roll(corners, -1, axis=0)]), dtype=np.float32)


SQUARE = np.array([[50.0, 40.0], [110.0, 45.0], [105.0, 100.0], [48.0, 96.0]])


def _nearest_turn(quad: Array, corners: Array) -> float:
    return min(float(np.abs(np.roll(quad, k, axis=0) - corners).max()) for k in range(4))


def test_four_sides_make_one_outline_with_their_corners() -> None:
    quads = quads_of(_sides(SQUARE)).astype(np.float64)
    assert len(quads) == 1
    assert _nearest_turn(quads[0], SQUARE) < 0.01


@pytest.mark.parametrize("hidden", range(4))
def test_three_sides_make_one_whose_fourth_is_hidden(hidden: int) -> None:
    quads = quads_of(np.asarray(np.delete(_sides(SQUARE), hidden, axis=0), np.float32)).astype(np.float64)
    assert len(quads) == 1
    assert _nearest_turn(quads[0], SQUARE) < 0.01


def test_sides_walked_the_other_way_round_are_a_bright_square_and_none() -> None:
    assert len(quads_of(_sides(SQUARE[::-1]))) == 0


def test_two_sides_make_none() -> None:
    assert quads_of(_sides(SQUARE)[:2]).shape == (0, 4, 2)


@pytest.mark.parametrize("roll_deg", range(0, 90, 15))
@pytest.mark.parametrize("blur_px", [0.6, 2.0])
def test_a_square_has_outlines_that_are_nowhere_shifted(roll_deg: float, blur_px: float) -> None:
    """Outlines of the halved image lie half a pixel off if its first pixel is not the mean of four."""
    pose = facing_at_px(CAMERA, (160.0, 120.0), 70, tilt_deg=20, roll_deg=roll_deg)
    image = rendered(CAMERA, [Print(picture=code_image(), pose=pose)], blur_px=blur_px, noise_grey=0.5)
    look = outlines_in(image, gradient_of(image))
    corners = corners_px_of(CAMERA, pose)
    near = [q.astype(np.float64) for q in look.quads if _nearest_turn(q.astype(np.float64), corners) < 3.0]
    assert near
    for quad in near:
        assert np.abs(quad.mean(axis=0) - corners.mean(axis=0)).max() < 0.4


def test_the_likeliest_candidate_is_the_marker_with_its_own_top() -> None:
    for roll_deg in range(0, 360, 45):
        pose = facing_at_px(CAMERA, (160.0, 120.0), 60, tilt_deg=25, roll_deg=roll_deg)
        image = rendered(CAMERA, [Print(picture=code_image(), pose=pose)])
        look = outlines_in(image, gradient_of(image))
        candidates = candidates_of(look, templates_of((code_model(),)))[0]
        assert 1 <= len(candidates) <= 10
        assert candidates[0].likeness == max(c.likeness for c in candidates) > 0.8
        assert np.abs(candidates[0].corners_px - corners_px_of(CAMERA, pose)).max() < 2.0
