"""CT phantoms: voxels are averages of their content, and the truth is that of the shape."""

import numpy as np
import pytest

from tracker.plan import measure_pedicle
from tracker.rehearsal.ct import ScanGrid, random_phantom, rehearsal_ct, scan


def test_a_voxel_is_the_mean_of_what_lies_in_its_box() -> None:
    grid = ScanGrid(lps_from_ijk=np.diag([1.0, 1.0, 3.0, 1.0]), shape_ijk=(6, 5, 4), samples=(4, 3, 8))
    volume = scan(lambda p: np.where(p[:, 0] + p[:, 2] / 6.0 > 2.75, 1000.0, 0.0), grid)
    assert volume.hu[0, 2].tolist() == pytest.approx([0, 0, 20, 765, 1000, 1000], abs=60)


def test_a_seed_makes_the_same_phantom_again() -> None:
    one, two = random_phantom(5).truth("left"), random_phantom(5).truth("left")
    assert (one.width_mm, one.length_mm) == (two.width_mm, two.length_mm)
    assert random_phantom(6).truth("left").width_mm != one.width_mm


def test_the_truth_lies_on_the_bone_itself() -> None:
    made = random_phantom(5)
    pedicle = made.pedicles["right"]
    half = 0.5 * pedicle.width_mm
    inside, outside = (
        made.bone_distance_mm(made.seed_lps_mm("right", (0.0, half + way, 0.0))[None])[0]
        for way in (-0.1, 0.1)
    )
    assert inside < 0.0 < outside


def test_the_rehearsals_own_vertebra_can_be_planned_on() -> None:
    volume = rehearsal_ct(spacing_mm=(0.8, 0.8, 1.5))
    for side, x in (("left", 16.0), ("right", -16.0)):
        measure = measure_pedicle(volume, (x, 0.0, 4.5), side)
        assert 7.0 < measure.width_mm < 11.0
        assert 10.0 < measure.height_mm < 18.0
        assert abs(measure.sagittal_deg) < 8.0
