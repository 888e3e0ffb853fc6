"""Errors of an accuracy test as they are raised are German, with their phrases."""

from dataclasses import replace

import pytest

from server.texts import reason_of_error
from tests.tracker.accuracy.test_accuracy_assessment import MEASURED, PLATE, POINTS, SOUND, captures_of
from tracker.accuracy import DivotPlate, PlateScale, assess_accuracy
from tracker.accuracy.rehearsed import RehearsedFaults
from tracker.errors import NavigationError


def problems_of(faults: RehearsedFaults, scale: PlateScale | None = MEASURED) -> list[NavigationError]:
    system = replace(SOUND, faults=faults)
    return list(assess_accuracy(captures_of(system), PLATE, system.tool, plate_scale=scale).problems)


@pytest.mark.parametrize(
    ("faults", "scale", "german"),
    [
        pytest.param(
            RehearsedFaults(focal_error_ratio=0.02), MEASURED, "zu groß angegeben", id="focal length"
        ),
        pytest.param(RehearsedFaults(tip_offset_mm=1.0), MEASURED, "die Spitze des Instruments", id="tip"),
        pytest.param(RehearsedFaults(print_scale_ratio=-0.01), MEASURED, "zu klein", id="marker"),
        pytest.param(RehearsedFaults(print_scale_ratio=-0.01), None, "zu klein gedruckt", id="print"),
        pytest.param(
            RehearsedFaults(),
            PlateScale(x_ratio=1.0, y_ratio=1.0, sd_ratio=0.01),
            "ein falscher Maßstab",
            id="unknown",
        ),
    ],
)
def test_each_problem_of_a_test_is_german(
    faults: RehearsedFaults, scale: PlateScale | None, german: str
) -> None:
    reasons = [reason_of_error(one) for one in problems_of(faults, scale)]
    assert all(one.is_translated for one in reasons), [one.code for one in reasons]
    assert german in reasons[0].message["de"]


def test_a_plate_that_is_no_reference_is_german() -> None:
    for points in ({}, {**POINTS, "10": (1.0, 0.0, 0.0)}, {str(n): (9.0 * n, 0.0, 0.0) for n in range(5)}):
        with pytest.raises(NavigationError) as raised:
            DivotPlate(name="odd", points_mm=points)
        assert reason_of_error(raised.value).is_translated, raised.value.message
