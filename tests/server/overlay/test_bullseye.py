"""The bull's-eye is drawn at the drill's position, to scale."""

import numpy as np
import pytest

from server.overlay.bullseye import Inset, Target, draw_bullseye
from server.overlay.primitives import DRILL_ORANGE, PLAN_BLUE, Image
from tracker.geometry import Array
from tracker.navigation import BullseyeView

INSET = Inset(left_px=20.0, top_px=20.0, side_px=400.0, extent_mm=8.0, scale=1.0)
TURN = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
CIRCLE = np.stack([np.cos(TURN), np.sin(TURN)], axis=1)
NOWHERE = np.full(2, np.inf)


def drawn(tip: Array, at_entry: Array, at_target: Array, covariance: Array | None = None) -> Image:
    image: Image = np.full((440, 440, 3), 110, dtype=np.uint8)
    seen = BullseyeView(
        tip_mm=tip,
        at_entry_mm=at_entry,
        at_target_mm=at_target,
        medial_is_right=True,
        view_from_vertebra=np.eye(3)[:2],
    )
    target = Target(seen=seen, channel_radius_mm=4.0, drill_radius_mm=2.0, tip_covariance_mm2=covariance)
    draw_bullseye(image, INSET, target)
    return image


def is_ink(image: Image, at_px: Array, colour: tuple[int, int, int]) -> np.ndarray:
    near = np.rint(at_px).astype(int)
    found = image[near[:, 1], near[:, 0]].astype(int)
    return np.asarray(np.abs(found - colour).max(axis=1) < 60)


def test_the_channel_and_the_drill_have_their_true_places_and_sizes() -> None:
    tip = np.array([1.5, -0.5])
    image = drawn(tip, tip, tip)
    assert is_ink(image, INSET.px(tip + 2.0 * CIRCLE), DRILL_ORANGE).all()
    channel = is_ink(image, INSET.px(4.0 * CIRCLE), PLAN_BLUE)
    # The drill's ring does not cover it here.
    assert channel.all()


def test_a_turned_drill_is_a_line_from_where_it_came_in_to_where_it_would_end() -> None:
    start, end = np.array([-3.0, 5.5]), np.array([3.0, 5.5])
    image = drawn(np.array([0.0, 5.5]), start, end)
    along = start + np.linspace(0.05, 0.2, 8)[:, None] * (end - start)
    assert is_ink(image, INSET.px(along), DRILL_ORANGE).all()


def test_a_drill_out_of_reach_is_an_arrow_at_the_border_and_no_ring() -> None:
    image = drawn(np.array([0.0, 30.0]), np.array([0.0, 30.0]), np.array([0.0, 30.0]))
    assert is_ink(image, INSET.px(np.array([[0.0, 7.9]])), DRILL_ORANGE).all()
    assert not is_ink(image, INSET.px(2.0 * CIRCLE), DRILL_ORANGE).any()


@pytest.mark.parametrize("place", [NOWHERE, np.array([1e6, -1e6]), np.array([0.0, 0.0])])
def test_nothing_is_drawn_beyond_the_inset(place: Array) -> None:
    image = drawn(np.array([0.0, 7.9]), place, place, np.eye(2) * 1e4)
    border = np.ones(image.shape[:2], dtype=bool)
    border[20:420, 20:420] = False
    assert (image[border] == 110).all()
