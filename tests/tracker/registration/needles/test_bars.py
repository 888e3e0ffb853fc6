"""Segments of bars, from both edges, or from one edge beside a known needle."""

import cv2
import numpy as np

from tracker.registration.needles.detection.bars import Bar, bars, single_edge_bars

KNOWN = Bar(middle_px=np.array([100.0, 100.0]), along=np.array([0.0, 1.0]), width_px=4.0, length_px=80.0)


def step_at(x_px: int) -> np.ndarray[tuple[int, int], np.dtype[np.uint8]]:
    """An image that is dark left of a column and bright right of it, from row 60 to 140."""
    image = np.full((200, 300), 60, np.uint8)
    image[60:140, x_px:] = 180
    return np.asarray(cv2.GaussianBlur(image, (0, 0), 0.8), dtype=np.uint8)


def test_one_edge_beside_a_known_needle_may_be_either_side_of_another() -> None:
    grey = step_at(115)
    assert bars(grey, 2.0, 8.0) == []
    halves = single_edge_bars(grey, 4.0, [KNOWN])
    upright = sorted(float(one.middle_px[0]) for one in halves if abs(one.along[1]) > 0.99)
    assert np.allclose(upright, [112.5, 116.5], atol=0.8)


def test_an_edge_far_from_all_known_needles_is_left_alone() -> None:
    assert single_edge_bars(step_at(240), 4.0, [KNOWN]) == []
    assert single_edge_bars(step_at(115), 4.0, []) == []


def test_the_edges_of_the_known_needle_itself_make_no_second_one() -> None:
    halves = single_edge_bars(step_at(102), 4.0, [KNOWN])
    assert all(abs(float(one.middle_px[0]) - 100.0) > 1.0 for one in halves if abs(one.along[1]) > 0.99)
