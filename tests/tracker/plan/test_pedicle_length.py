"""Start and end of a pedicle's length: at the arch, not a process; at the body, not a vessel."""

import numpy as np
import pytest

from tracker.plan import PedicleMeasure, measure_pedicle
from tracker.rehearsal.ct import (
    ContrastTube,
    Rod,
    ScanGrid,
    VertebraPhantom,
    pedicle_tube,
    scan,
    usual_bones,
)
from tracker.rehearsal.ct.distance_fields import Part

UP = np.array([0.0, 0.0, 60.0])


def vertebra(bones: tuple[Part, ...] = (), beside: tuple[ContrastTube, ...] = ()) -> VertebraPhantom:
    pedicles = {
        side: pedicle_tube(
            side,
            width_mm=8.0,
            height_mm=13.0,
            transverse_deg=10.0,
            sagittal_deg=0.0,
            waist_mm=(15.0, 0.0, 2.0),
            widening_per_mm2=0.003,
        )
        for side in ("left", "right")
    }
    return VertebraPhantom(pedicles=pedicles, bones=(*usual_bones(), *bones), beside=beside, marrow_hu=120.0)


def measured(made: VertebraPhantom) -> PedicleMeasure:
    grid = ScanGrid.around(
        (0.0, -6.0, 0.0), size_mm=(64.0, 112.0, 40.0), spacing_mm=(0.7, 0.7, 1.25), noise_hu=20.0, blur_mm=0.3
    )
    return measure_pedicle(scan(made.hu_at, grid), made.seed_lps_mm("left"), "left")


def test_a_process_that_the_axis_runs_into_is_not_part_of_the_length() -> None:
    plain = vertebra()
    axis = plain.truth("left").axis_lps
    base = plain.truth("left").isthmus_lps_mm - 18.0 * axis
    process = Rod(start_mm=base, end_mm=base - 18.0 * axis, radius_mm=4.5)
    made = vertebra(bones=(process,))
    assert made.truth("left").length_mm > plain.truth("left").length_mm + 15.0
    one = measured(made)
    assert one.length_mm == pytest.approx(plain.truth("left").length_mm, abs=3.0)
    assert any("process" in warning for warning in one.warnings)


@pytest.mark.parametrize("vessel_hu", [150.0, 300.0])
def test_a_vessel_that_touches_the_body_is_not_part_of_the_length(vessel_hu: float) -> None:
    at = np.array([8.0, -52.0, 0.0])
    made = vertebra(
        beside=(ContrastTube(part=Rod(start_mm=at - UP, end_mm=at + UP, radius_mm=11.0), hu=vessel_hu),)
    )
    one = measured(made)
    assert one.length_mm == pytest.approx(made.truth("left").length_mm, abs=1.2)
    assert any("touches the front wall" in warning for warning in one.warnings)
