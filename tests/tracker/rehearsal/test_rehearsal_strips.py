"""Strips: what is stacked of them is where it belongs."""

import numpy as np
import pytest

from tracker.rehearsal import Theatre, TheatreSettings
from tracker.rehearsal.lens import RayGrid
from tracker.rehearsal.strips import STRIP_PX, Strips, strips_around

WIDTH, HEIGHT = 322, 182
RAYS = RayGrid(Theatre(TheatreSettings(size_wh_px=(WIDTH, HEIGHT))).camera)
U, V = (axis.astype(np.float32) for axis in np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT)))
OBLIQUE = Strips(places=((40, 60), (52, 72), (64, 84)), width=24, height=12)


def test_pixels_from_nodes_with_a_margin_are_those_of_the_image() -> None:
    grown = OBLIQUE.grown(4)
    row, column = grown.nodes(RAYS)
    # Each node's own place: in the middle of a block, the first one four blocks outside of the image.
    places = np.stack(np.broadcast_arrays(column, row), axis=-1).astype(np.float32) * 4.0 - 16.0 + 1.5
    inner = OBLIQUE.inner(grown.from_nodes(places), 4)
    np.testing.assert_allclose(inner[..., 0], OBLIQUE.taken_from(U), atol=1e-3)
    np.testing.assert_allclose(inner[..., 1], OBLIQUE.taken_from(V), atol=1e-3)


def test_what_is_put_back_is_what_was_taken_also_over_the_borders() -> None:
    over = Strips(places=((-8, -4), (0, 176), (312, 90)), width=24, height=12)
    for strips in (OBLIQUE, over, Strips.of_box((300, 170, 24, 12)), Strips.of_box((20, 20, 40, 30))):
        stacked = strips.taken_from(V, -1.0)
        assert stacked.shape == (len(strips.places) * strips.height, strips.width)
        x, y = strips.places[-1]
        assert stacked[-strips.height, 0] == V[y, x]
        if min(min(place) for place in strips.places) >= 0:
            image = np.zeros_like(V)
            strips.put_into(image, stacked)
            changed = image > 0
            np.testing.assert_array_equal(image[changed], V[changed])
            assert changed[y : y + strips.height, x : x + strips.width].all()


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
