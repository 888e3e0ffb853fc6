"""The stated uncertainty at the end of a lever, against pose errors drawn at random."""

import pytest

from tests.tracker.navigation.levers import LEVERS_MM, TILTS_SD_DEG, entries_inside, tips_inside

DRAWS = 3000
# The deviation from the tangent is not normally distributed. The coverage is 95.5 to 97 % at every lever,
# with a standard error of 0.4 % here. The term of 120 mm would cover 90 % at 250 mm, and 98.8 % at 60 mm.
MIN_RATIO, MAX_RATIO = 0.945, 0.98


@pytest.mark.parametrize("tilt_sd_deg", TILTS_SD_DEG)
@pytest.mark.parametrize("lever_mm", LEVERS_MM)
def test_95_percent_cover_the_tip_of_a_tool_of_any_length(lever_mm: float, tilt_sd_deg: float) -> None:
    inside = tips_inside(lever_mm, tilt_sd_deg, draws=DRAWS, seed=3)
    assert MIN_RATIO < inside / DRAWS < MAX_RATIO


@pytest.mark.parametrize("lever_mm", LEVERS_MM)
def test_95_percent_cover_the_entry_at_any_distance_from_the_reference(lever_mm: float) -> None:
    inside = entries_inside(lever_mm, 1.0, draws=DRAWS, seed=4)
    assert MIN_RATIO < inside / DRAWS < MAX_RATIO
