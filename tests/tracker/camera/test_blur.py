"""Blur as an ellipse: its axes, and what keeps it within bounds."""

import numpy as np
import pytest

from tracker.camera.blur_kernels import axes_of, clamp_blur, level_of

BLURS = [(2.0, 2.0, 0.0), (3.0, 1.0, 0.0), (1.0, 3.0, 0.0), (2.0, 2.0, 1.5), (0.5, 4.0, -1.2)]


@pytest.mark.parametrize("blur", BLURS)
def test_axes_are_those_of_the_matrix(blur: tuple[float, float, float]) -> None:
    along_u, along_v, between = blur
    larger, smaller, x, y = axes_of(along_u, along_v, between)
    matrix = np.array([[along_u, between], [between, along_v]])
    np.testing.assert_allclose([smaller, larger], np.linalg.eigvalsh(matrix), atol=1e-12)
    np.testing.assert_allclose(matrix @ [x, y], larger * np.array([x, y]), atol=1e-12)


def test_only_the_axis_that_is_out_of_bounds_is_changed() -> None:
    blur = np.array([2.0, 2.0, 1.9])
    clamp_blur(blur, 0.5, 10.0)
    np.testing.assert_allclose(blur, [2.2, 2.2, 1.7], atol=1e-12)
    clamp_blur(blur, 0.5, 3.0)
    np.testing.assert_allclose(blur, [1.75, 1.75, 1.25], atol=1e-12)


def test_what_is_no_blur_becomes_one() -> None:
    blur = np.array([1.0, -0.5, 2.0])
    clamp_blur(blur, 0.1, 4.0)
    np.testing.assert_allclose(axes_of(blur[0], blur[1], blur[2])[1], 0.1, atol=1e-12)


@pytest.mark.parametrize(("sd", "level"), [(0.1, 0), (1.4, 0), (1.5, 1), (2.9, 2), (50.0, 2)])
def test_the_next_picture_is_next_by_ratio(sd: float, level: int) -> None:
    assert level_of(sd * sd, np.array([1.0, 2.0, 4.0])) == level
