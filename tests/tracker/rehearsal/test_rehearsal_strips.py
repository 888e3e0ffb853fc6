"""Strips cover an elongated object."""

import numpy as np
import pytest

from tracker.rehearsal import Theatre, TheatreSettings
from tracker.rehearsal.lens import RayGrid
from tracker.rehearsal.strips import STRIP_PX, strips_around

WIDTH, HEIGHT = 322, 182
RAYS = RayGrid(Theatre(TheatreSettings(size_wh_px=(WIDTH, HEIGHT))).camera)


@pytest.mark.parametrize("bottom_x", [60.0, 200.0, 290.0])
@pytest.mark.parametrize("order", [1, -1], ids=["downwards", "upwards"])
def test_strips_hold_all_of_what_is_long_and_do_not_overlap(bottom_x: float, order: int) -> None:
    top, half = np.array([80.0, -40.0]), np.array([9.0, 0.0])
    line = top + np.linspace(0.0, 1.0, 30)[:, None] * (np.array([bottom_x, 150.0]) - top)
    strips = strips_around(np.stack([line - half, line + half])[:, ::order], 4, RAYS)
    assert strips is not None
    tops = [y for _, y in strips.places]
    assert np.diff(tops).tolist() == [STRIP_PX] * (len(tops) - 1)
    for x, y in line[line[:, 1] >= 0.0]:
        left = next(left for left, first in strips.places if first <= y < first + STRIP_PX)
        assert left <= x - 9.0 - 4.0
        assert x + 9.0 + 4.0 <= left + strips.width


def test_something_level_gets_strips_as_wide_as_it_is() -> None:
    px = np.array(
        [[[20.0, 90.0], [150.0, 92.0], [280.0, 90.0]], [[20.0, 110.0], [150.0, 112.0], [280.0, 110.0]]]
    )
    strips = strips_around(px, 4, RAYS)
    assert strips is not None
    assert all(x <= 16 and x + strips.width >= 284 for x, _ in strips.places)
    assert strips_around(px + np.array([0.0, 500.0]), 4, RAYS) is None
