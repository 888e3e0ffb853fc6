"""Highlight fit: position and width are recovered, and no part of a shape is taken for a highlight."""

import numpy as np
import pytest

from tracker.geometry import Array
from tracker.marker.photometric_fit.grid_kernels import GRID_CELLS
from tracker.marker.photometric_fit.illumination import grid, smooth_light
from tracker.marker.photometric_fit.stepwise_illumination import highlight_in


def _gaussian(middle: tuple[float, float], sds: tuple[float, float], rotation_deg: float) -> Array:
    u, v = grid()
    along, across = np.cos(np.radians(rotation_deg)), np.sin(np.radians(rotation_deg))
    x, y = u - middle[0], v - middle[1]
    far = ((x * along + y * across) / sds[0]) ** 2 + ((y * along - x * across) / sds[1]) ** 2
    return np.asarray(np.exp(-0.5 * far))


def _left(of: Array, light: Array) -> float:
    """Return the share of squared residuals that the illumination leaves."""
    solution, *_ = np.linalg.lstsq(light, of.ravel(), rcond=None)
    return float(np.sum((of.ravel() - light @ solution) ** 2) / np.sum((of - of.mean()) ** 2))


@pytest.mark.parametrize(
    ("middle", "sds", "rotation_deg"), [((0.2, -0.2), (0.45, 0.45), 0.0), ((-0.6, 0.2), (0.8, 0.5), 70.0)]
)
def test_a_highlight_between_the_initial_shapes_is_found(
    middle: tuple[float, float], sds: tuple[float, float], rotation_deg: float
) -> None:
    seen = 60.0 * _gaussian(middle, sds, rotation_deg)
    found = highlight_in(seen, smooth_light(2), np.ones((GRID_CELLS, GRID_CELLS)))
    assert found is not None
    assert _left(seen, np.column_stack([smooth_light(2), found])) < 0.01


def test_a_spot_as_narrow_as_a_part_of_the_shape_is_no_highlight() -> None:
    seen = 60.0 * _gaussian((0.2, -0.2), (0.15, 0.15), 0.0)
    found = highlight_in(seen, smooth_light(2), np.ones((GRID_CELLS, GRID_CELLS)))
    assert found is None or _left(seen, np.column_stack([smooth_light(2), found])) > 0.4


def test_a_dark_spot_is_no_highlight() -> None:
    dark = -60.0 * _gaussian((0.0, 0.0), (0.5, 0.5), 0.0)
    found = highlight_in(dark, np.ones((GRID_CELLS * GRID_CELLS, 1)), np.ones((GRID_CELLS, GRID_CELLS)))
    assert found is None or _left(dark, np.column_stack([np.ones(GRID_CELLS * GRID_CELLS), found])) > 0.5
