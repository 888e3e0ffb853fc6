"""A highlight on a square: found where it is, as wide as it is; no part of a shape is taken for one."""

import numpy as np
import pytest

from tracker.geometry import Array
from tracker.marker.explanation.fields.kernels import WIDE
from tracker.marker.explanation.light import grid, highlight_in, smooth_light


def _bell(middle: tuple[float, float], sds: tuple[float, float], turn_deg: float) -> Array:
    u, v = grid()
    along, across = np.cos(np.radians(turn_deg)), np.sin(np.radians(turn_deg))
    x, y = u - middle[0], v - middle[1]
    far = ((x * along + y * across) / sds[0]) ** 2 + ((y * along - x * across) / sds[1]) ** 2
    return np.asarray(np.exp(-0.5 * far))


def _left(of: Array, light: Array) -> float:
    """The share of the squares that light leaves."""
    solution, *_ = np.linalg.lstsq(light, of.ravel(), rcond=None)
    return float(np.sum((of.ravel() - light @ solution) ** 2) / np.sum((of - of.mean()) ** 2))


@pytest.mark.parametrize(
    ("middle", "sds", "turn_deg"), [((0.2, -0.2), (0.45, 0.45), 0.0), ((-0.6, 0.2), (0.8, 0.5), 70.0)]
)
def test_a_highlight_between_those_that_are_tried_first_is_found(
    middle: tuple[float, float], sds: tuple[float, float], turn_deg: float
) -> None:
    seen = 60.0 * _bell(middle, sds, turn_deg)
    found = highlight_in(seen, smooth_light(2), np.ones((WIDE, WIDE)))
    assert found is not None
    assert _left(seen, np.column_stack([smooth_light(2), found])) < 0.01


def test_what_is_as_narrow_as_a_part_of_the_shape_is_no_highlight() -> None:
    seen = 60.0 * _bell((0.2, -0.2), (0.15, 0.15), 0.0)
    found = highlight_in(seen, smooth_light(2), np.ones((WIDE, WIDE)))
    assert found is None or _left(seen, np.column_stack([smooth_light(2), found])) > 0.4


def test_where_light_is_missing_there_is_no_highlight() -> None:
    dark = -60.0 * _bell((0.0, 0.0), (0.5, 0.5), 0.0)
    found = highlight_in(dark, np.ones((WIDE * WIDE, 1)), np.ones((WIDE, WIDE)))
    assert found is None or _left(dark, np.column_stack([np.ones(WIDE * WIDE), found])) > 0.5
