"""No detection in images without a marker."""

import pytest

from tests.benchmarks.limits.conditions_run import measure_empty
from tests.benchmarks.limits.evaluation import Outcome
from tests.benchmarks.scenes.rigs import RIGS
from tests.tracker.levels import SEED

# A sample; the benchmark searches more.
EMPTY_IMAGES = {"A": 2, "B": 1}


@pytest.mark.parametrize("rig", EMPTY_IMAGES)
def test_nothing_is_claimed_in_images_without_a_marker(rig: str) -> None:
    found = measure_empty(RIGS[rig], peers=(), count=EMPTY_IMAGES[rig], seed=SEED)["coaxial"]
    assert len(found) == 3 * EMPTY_IMAGES[rig]
    assert [one for one in found if one.outcome is not Outcome.MISSED] == []
