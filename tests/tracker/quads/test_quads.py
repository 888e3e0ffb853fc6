"""Quad hypotheses from a corner or from two opposite sides."""

import cv2
import numpy as np
import pytest

from tests.tracker.scenes import Image8
from tracker.geometry import Array
from tracker.quads import Quads, corner_quads_of, pair_quads_of

SQUARE = np.array([[50.0, 40.0], [110.0, 45.0], [105.0, 100.0], [46.0, 96.0]])


def _picture(*, paper: int = 220, ink: int = 30) -> Image8:
    picture = np.full((150, 160), paper, np.uint8)
    return np.asarray(cv2.fillConvexPoly(picture, np.rint(SQUARE).astype(np.int32), ink), dtype=np.uint8)


def _sides(corners: Array) -> Quads:
    """The four sides as segments (4, 4), clockwise."""
    return np.asarray(np.hstack([corners, np.roll(corners, -1, axis=0)]), dtype=np.float32)


def _nearest_px(quads: Quads) -> float:
    """Return the error of the best quad, whatever its first corner."""
    if len(quads) == 0:
        return float("inf")
    turned = [np.abs(np.roll(quads.astype(np.float64), k, axis=1) - SQUARE) for k in range(4)]
    return float(min(one.max(axis=(1, 2)).min() for one in turned))


@pytest.mark.parametrize("corner", range(4))
@pytest.mark.parametrize(("first_seen", "second_seen"), [(1.0, 1.0), (0.5, 1.0), (1.0, 0.4)])
def test_two_sides_at_a_corner_suffice_when_one_is_complete(
    corner: int, first_seen: float, second_seen: float
) -> None:
    """The other may be occluded by any amount: its length is varied."""
    a, b = _sides(SQUARE)[[corner, (corner + 1) % 4]].astype(np.float64)
    a[:2], b[2:] = a[2:] + first_seen * (a[:2] - a[2:]), b[:2] + second_seen * (b[2:] - b[:2])
    quads = corner_quads_of(_picture(), np.array([a, b], np.float32), min_step_grey=20.0)
    # A tenth of the side between two lengths, and what perspective adds to a parallelogram.
    assert _nearest_px(quads) < 9.0


def test_without_a_step_from_paper_to_ink_there_is_no_corner() -> None:
    even = _picture(paper=100, ink=95)
    assert len(corner_quads_of(even, _sides(SQUARE), min_step_grey=20.0)) == 0
    assert len(corner_quads_of(even, _sides(SQUARE), min_step_grey=2.0)) > 0


def test_a_bright_square_has_no_corner() -> None:
    negative = _picture(paper=30, ink=220)
    assert len(corner_quads_of(negative, _sides(SQUARE[::-1]), min_step_grey=20.0)) == 0
    assert len(corner_quads_of(negative, _sides(SQUARE), min_step_grey=20.0)) == 0


def test_no_quad_is_tilted_more_than_a_marker_can_be() -> None:
    for quad in corner_quads_of(_picture(), _sides(SQUARE), min_step_grey=20.0).astype(np.float64):
        halves = np.linalg.svd(np.array([quad[1] - quad[0], quad[3] - quad[0]]), compute_uv=False)
        assert halves[1] / halves[0] > 0.35


@pytest.mark.parametrize("count", [0, 1])
def test_fewer_than_two_sides_make_none(count: int) -> None:
    assert corner_quads_of(_picture(), _sides(SQUARE)[:count], min_step_grey=5.0).shape == (0, 4, 2)


@pytest.mark.parametrize("side", range(2))
@pytest.mark.parametrize(("from_ratio", "to_ratio"), [(0.0, 1.0), (0.15, 0.85), (-0.15, 1.1), (0.3, 1.0)])
def test_two_opposite_sides_suffice_wherever_they_end(side: int, from_ratio: float, to_ratio: float) -> None:
    """Motion along them makes them longer or shorter."""
    both = _sides(SQUARE)[[side, side + 2]].astype(np.float64)
    begin, way = both[:, :2], both[:, 2:] - both[:, :2]
    seen = np.hstack([begin + from_ratio * way, begin + to_ratio * way]).astype(np.float32)
    for pair in (seen, seen[::-1]):
        assert _nearest_px(pair_quads_of(np.ascontiguousarray(pair))) < 9.0


def test_the_first_side_of_a_pair_quad_is_along_a_visible_one() -> None:
    pair = _sides(SQUARE)[[1, 3]]
    way = (pair[0, 2:] - pair[0, :2]) / np.linalg.norm(pair[0, 2:] - pair[0, :2])
    quads = pair_quads_of(pair)
    first = quads[:, 1] - quads[:, 0]
    turned = np.abs(first @ way) / np.linalg.norm(first, axis=1)
    assert len(quads) > 0
    assert float(turned.min()) > 0.99


def test_outward_facing_or_meeting_sides_make_no_pair() -> None:
    sides = _sides(SQUARE)
    assert len(pair_quads_of(np.ascontiguousarray(_sides(SQUARE[::-1])[[0, 2]]))) == 0
    assert len(pair_quads_of(sides[:2])) == 0
    # Far longer than they are apart: a tool's handle, no square.
    handle = np.array([[0.0, 0.0, 200.0, 0.0], [200.0, 20.0, 0.0, 20.0]], np.float32)
    assert len(pair_quads_of(handle)) == 0
    assert len(pair_quads_of(sides[:0])) == 0
