"""Outlines: where a dark square could be."""

import numpy as np
import pytest

from tracker.geometry import Array
from tracker.marker.outline import Quads, quads_of


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
