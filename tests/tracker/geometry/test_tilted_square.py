"""Foreshortening of a tilted square, from two of its sides."""

import numpy as np
import pytest

from tracker.geometry.geometry_kernels import is_plausible_foreshortening


@pytest.mark.parametrize("tilt_deg", [10.0, 50.0, 70.0])
@pytest.mark.parametrize("roll_deg", [0.0, 30.0, 45.0, 80.0])
def test_the_squash_is_the_cosine_of_the_tilt_however_it_is_rolled(tilt_deg: float, roll_deg: float) -> None:
    roll, cosine = np.radians(roll_deg), float(np.cos(np.radians(tilt_deg)))
    a = 30.0 * np.array([np.cos(roll), cosine * np.sin(roll)])
    b = 30.0 * np.array([-np.sin(roll), cosine * np.cos(roll)])
    squares, squared_area = float(a @ a + b @ b), float(a[0] * b[1] - a[1] * b[0]) ** 2
    assert is_plausible_foreshortening(squares, squared_area, 0.99 * cosine)
    assert not is_plausible_foreshortening(squares, squared_area, 1.01 * cosine)
