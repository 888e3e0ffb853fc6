"""Pedicle measurement from one click: accuracy against phantoms, then rejections."""

import functools
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tests.tracker.plan.pedicles import off_by, rod_between_blocks, scanned
from tracker.errors import NavigationError
from tracker.geometry import rotation_from_vector
from tracker.plan import PedicleMeasure, Volume, measure_pedicle
from tracker.plan.pedicle import Side, axis_from_angles
from tracker.plan.pedicle.outlines import planes_across
from tracker.rehearsal.ct import (
    ContrastTube,
    PedicleTruth,
    Rod,
    ScanGrid,
    VertebraPhantom,
    pedicle_tube,
    scan,
    usual_bones,
)


def phantom(**changes: Any) -> VertebraPhantom:  # noqa: ANN401  any field of the phantom
    pedicles = {
        side: pedicle_tube(
            side,
            width_mm=width,
            height_mm=13.0,
            transverse_deg=angle,
            sagittal_deg=-6.0,
            waist_mm=(15.0, 0.0, 3.0),
            widening_per_mm2=0.003,
        )
        for side, width, angle in (("left", 8.0, 14.0), ("right", 7.0, 8.0))
    }
    return VertebraPhantom(pedicles=pedicles, bones=usual_bones(), **changes)


def grid(
    spacing_mm: tuple[float, float, float] = (0.6, 0.6, 1.0),
    **changes: Any,  # noqa: ANN401  any field of the grid
) -> ScanGrid:
    made = ScanGrid.around((0.0, -8.0, 0.0), size_mm=(54.0, 84.0, 36.0), spacing_mm=spacing_mm, **changes)
    # With more samples in a voxel, a scan takes longer than the measurement.
    return replace(made, samples=(2, 2, 3))


@functools.cache
def usual() -> tuple[VertebraPhantom, Volume]:
    made = phantom()
    return made, scan(made.hu_at, grid(noise_hu=25.0))


@functools.cache
def usual_measure(side: Side) -> PedicleMeasure:
    made, volume = usual()
    return measure_pedicle(volume, made.seed_lps_mm(side), side)


METAL = ContrastTube(
    part=Rod(start_mm=np.array([26.0, 0.0, -30.0]), end_mm=np.array([26.0, 0.0, 30.0]), radius_mm=3.0),
    hu=3000.0,
)


@pytest.mark.parametrize(
    ("made", "voxels"),
    [
        pytest.param(
            phantom(marrow_hu=45.0, cortex_mm=0.8, beside=(METAL,)),
            grid(noise_hu=20.0),
            id="osteoporotic-and-metal-beside",
        ),
        pytest.param(
            phantom(),
            grid((0.7, 0.7, 3.0), noise_hu=20.0, gantry_tilt_deg=18.0),
            id="thick-slices-tilted-gantry",
        ),
        pytest.param(
            phantom(tissue_hu=-1000.0),
            grid((0.8, 0.5, 1.2), rotation=rotation_from_vector(np.radians([14.0, -9.0, 8.0]))),
            id="dry-bone-in-air-oblique-stack-unequal-voxels",
        ),
    ],
)
def test_width_and_height_to_half_a_voxel_and_angles_to_a_degree(
    made: VertebraPhantom, voxels: ScanGrid
) -> None:
    volume = scan(made.hu_at, voxels)
    measure = measure_pedicle(volume, made.seed_lps_mm("left", (3.0, 1.5, -2.0)), "left")
    off = off_by(measure, made.truth("left"), volume)
    assert off.is_small, off
    # Marrow like muscle leaks out of the bone's solid: the entry was once 15 to 20 mm too far in front.
    assert abs(off.length_mm) < 1.5
    assert np.linalg.norm(measure.isthmus_lps_mm - made.truth("left").isthmus_lps_mm) < 1.5


@pytest.mark.parametrize(
    ("rod_hu", "block_hu", "around_hu", "spacing", "seed"),
    [
        pytest.param(800.0, 300.0, 0.0, (0.8, 0.8, 1.2), 1, id="softer-blocks"),
        # With such contrast to its surroundings, the fit takes many steps.
        pytest.param(350.0, 350.0, -1000.0, (0.8, 0.8, 0.8), 6, id="faint-rod-in-air"),
    ],
)
def test_a_solid_rod_without_cortex_is_measured_too(
    rod_hu: float, block_hu: float, around_hu: float, spacing: tuple[float, float, float], seed: int
) -> None:
    axis = axis_from_angles("left", transverse_deg=12.0, sagittal_deg=7.0)
    field = rod_between_blocks(
        width_mm=8.0, height_mm=12.0, axis=axis, rod_hu=rod_hu, block_hu=block_hu, around_hu=around_hu
    )
    volume = scanned(field, spacing_mm=spacing, noise_hu=15.0, seed=seed)
    measure = measure_pedicle(volume, (0.5, 1.0, -1.0), "left")
    truth = PedicleTruth(
        width_mm=8.0, height_mm=12.0, isthmus_lps_mm=np.zeros(3), axis_lps=axis, length_mm=measure.length_mm
    )
    assert off_by(measure, truth, volume).is_small
    assert (measure.entry_lps_mm[1], measure.front_lps_mm[1]) == pytest.approx((26.0, -42.0), abs=0.8)


def test_a_medial_wall_three_times_as_thick_as_the_lateral_one_is_measured_to_its_outside() -> None:
    axis = axis_from_angles("left", transverse_deg=12.0, sagittal_deg=7.0)
    (left,), (up,) = planes_across(axis[None])
    bone = rod_between_blocks(
        width_mm=9.0, height_mm=13.0, axis=axis, rod_hu=900.0, block_hu=300.0, around_hu=40.0
    )

    def hu_at(p: np.ndarray) -> np.ndarray:
        hu = bone(p)
        oval = ((p @ left - 0.6) / 3.3) ** 2 + (p @ up / 5.3) ** 2
        hu[(hu == 900.0) & (oval < 1.0)] = 100.0
        return hu

    volume = scan(hu_at, grid((0.7, 0.7, 1.0), noise_hu=25.0, blur_mm=0.4))
    measure = measure_pedicle(volume, (0.5, 1.0, -1.0), "left")
    assert (measure.width_mm, measure.height_mm) == pytest.approx((9.0, 13.0), abs=0.15)
    assert max(measure.sd.width_mm, measure.sd.height_mm) < 0.2


def test_clicks_anywhere_in_the_pedicle_give_the_same_pedicle() -> None:
    made, volume = usual()
    widths = [
        usual_measure("left").width_mm,
        *(
            measure_pedicle(volume, made.seed_lps_mm("left", offset), "left").width_mm
            for offset in ((6.0, -1.0, 4.0),)
        ),
    ]
    assert np.ptp(widths) < 0.15
    assert np.mean(widths) == pytest.approx(8.0, abs=0.25)


@pytest.mark.parametrize(("side", "width"), [("left", 8.0), ("right", 7.0)])
def test_the_stated_sd_covers_the_error_on_both_sides(side: Side, width: float) -> None:
    measure = usual_measure(side)
    assert abs(measure.width_mm - width) < 4.0 * measure.sd.width_mm
    assert measure.sd.width_mm < 0.3
    assert measure.sd.transverse_deg < 1.0


@pytest.mark.parametrize(
    ("seed", "side", "code"),
    [
        pytest.param((0.0, 0.0, 500.0), "left", "SEED_OUTSIDE_CT", id="outside-the-ct"),
        pytest.param((np.nan, 0.0, 0.0), "left", "SEED_INVALID", id="not-a-number"),
        pytest.param((15.0, 0.0, 3.0), "port", "SIDE_INVALID", id="no-side"),
        pytest.param((15.0, 0.0, 3.0), "right", "SEED_ON_OTHER_SIDE", id="the-other-side"),
    ],
)
def test_invalid_arguments_are_rejected(seed: tuple[float, float, float], side: str, code: str) -> None:
    with pytest.raises(NavigationError) as caught:
        measure_pedicle(usual()[1], seed, side)
    assert caught.value.code == code


@pytest.mark.parametrize(
    "seed",
    [
        pytest.param((0.0, -1.0, 0.0), id="canal"),
        pytest.param((0.0, -27.0, 0.0), id="body"),
        pytest.param((24.0, 0.0, 9.0), id="muscle"),
    ],
)
def test_a_click_outside_a_pedicle_is_rejected(seed: tuple[float, float, float]) -> None:
    with pytest.raises(NavigationError) as caught:
        measure_pedicle(usual()[1], seed, "left")
    assert caught.value.code in {
        "SEED_NOT_IN_BONE",
        "PEDICLE_NOT_FOUND",
        "SEED_NOT_IN_PEDICLE",
        "PEDICLE_CUT",
    }


def test_a_click_in_air_is_reported_as_air() -> None:
    made = phantom(tissue_hu=-1000.0)
    volume = scan(made.hu_at, grid((1.0, 1.0, 1.5)))
    with pytest.raises(NavigationError) as caught:
        measure_pedicle(volume, (24.0, 0.0, 3.0), "left")
    assert caught.value.code == "SEED_IN_AIR"


def test_a_pedicle_cut_by_the_end_of_the_ct_is_rejected() -> None:
    made, volume = usual()
    cut = Volume(hu=volume.hu[:20], lps_from_ijk=volume.lps_from_ijk)
    with pytest.raises(NavigationError) as caught:
        measure_pedicle(cut, made.seed_lps_mm("left", (0.0, 0.0, -3.0)), "left")
    assert caught.value.code in {"PEDICLE_CUT", "PEDICLE_NOT_FOUND"}
