"""The paper's ruler: its equations are inverses of each other, and impossible values are rejected."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.camera.ruler import Ruler, angle_deg, axial_distance_mm, pixels_per_mm
from tracker.errors import InvalidInput

LENGTH = st.floats(1.0, 5000.0)


def test_three_four_five() -> None:
    ruler = Ruler(vertical_mm=300.0, horizontal_mm=400.0, focal_length_px=1000.0)
    assert ruler.axial_distance_mm == pytest.approx(500.0)
    assert ruler.angle_deg == pytest.approx(36.8699, abs=1e-4)
    assert ruler.pixels_per_mm == pytest.approx(2.0)
    assert ruler.displacement_mm([0.0, 20.0, 7.0]) == pytest.approx([0.0, 10.0, 3.5])


def test_a_camera_straight_above_is_at_ninety_degrees() -> None:
    assert angle_deg(590.0, 0.0) == pytest.approx(90.0)
    assert axial_distance_mm(590.0, 0.0) == pytest.approx(590.0)


@given(vertical=LENGTH, horizontal=LENGTH, moved_mm=LENGTH, moved_px=LENGTH)
def test_what_made_the_ruler_is_what_it_measures(
    vertical: float, horizontal: float, moved_mm: float, moved_px: float
) -> None:
    ruler = Ruler.from_displacement(
        vertical_mm=vertical, horizontal_mm=horizontal, pixels_per_mm=pixels_per_mm(moved_px, moved_mm)
    )
    assert float(ruler.displacement_mm(moved_px)) == pytest.approx(moved_mm)


@pytest.mark.parametrize(
    ("vertical", "horizontal", "focal", "said"),
    [
        pytest.param(-1.0, 5.0, 1000.0, "vertical distance is -1 mm", id="below-the-floor"),
        pytest.param(5.0, math.nan, 1000.0, "horizontal distance is nan", id="not-measured"),
        pytest.param(0.0, 0.0, 1000.0, "distance to the camera is 0 mm", id="in-the-lens"),
        pytest.param(5.0, 5.0, 0.0, "focal length is 0 px", id="no-focal-length"),
        pytest.param(5.0, 5.0, math.inf, "focal length is inf px", id="endless-focal-length"),
    ],
)
def test_a_ruler_that_cannot_be_is_rejected(
    vertical: float, horizontal: float, focal: float, said: str
) -> None:
    with pytest.raises(InvalidInput, match=said) as reported:
        Ruler(vertical_mm=vertical, horizontal_mm=horizontal, focal_length_px=focal)
    assert reported.value.code == "RULER_INVALID"


@pytest.mark.parametrize(("moved_px", "moved_mm"), [(0.0, 20.0), (20.0, 0.0), (math.nan, 1.0)])
def test_a_displacement_that_cannot_be_seen_gives_no_ratio(moved_px: float, moved_mm: float) -> None:
    with pytest.raises(InvalidInput, match="needed above 0"):
        pixels_per_mm(moved_px, moved_mm)
