"""The outline of a cylinder touches it, and nothing of the cylinder is outside of it."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tracker.geometry import cylinder_ring_mm, cylinder_silhouette_mm

coordinate = st.floats(-80, 80)


def test_a_ring_is_closed_and_stands_across_its_axis() -> None:
    axis = np.array([1.0, 2.0, 2.0]) / 3.0
    ring = cylinder_ring_mm([5.0, 6.0, 100.0], axis, 4.0)
    arms = ring - [5.0, 6.0, 100.0]
    assert np.allclose(ring[0], ring[-1])
    assert np.allclose(np.linalg.norm(arms, axis=1), 4.0)
    assert np.allclose(arms @ axis, 0.0)


@given(coordinate, coordinate, coordinate, coordinate, st.floats(0.5, 8))
def test_lines_of_sight_touch_the_cylinder_along_its_outline(
    x: float, y: float, dx: float, dy: float, radius_mm: float
) -> None:
    start, end = np.array([x, y, 200.0]), np.array([x + dx, y + dy, 240.0])
    axis = (end - start) / np.linalg.norm(end - start)
    to_axis = start - (start @ axis) * axis
    # On the wall itself, rounding decides the side of the eye.
    assume(abs(np.linalg.norm(to_axis) - radius_mm) > 1e-9)
    lines = cylinder_silhouette_mm(start, end, radius_mm)
    if np.linalg.norm(to_axis) <= radius_mm:
        assert lines == ()
        return
    assert len(lines) == 2
    for near, far in lines:
        assert np.linalg.norm(near - start) == pytest.approx(radius_mm)
        assert np.allclose(far - near, end - start)
        # Tangent: the normal at the line is perpendicular to the line of sight.
        assert (near - start) @ near == pytest.approx(0.0, abs=1e-6)


def test_an_eye_inside_sees_no_outline() -> None:
    assert cylinder_silhouette_mm([0, 0, 10], [0, 0, 50], 4.0) == ()
