"""Sections that are not a pedicle are rejected by their surroundings; ambiguous ones get a larger sd."""

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.plan.pedicles import scanned
from tracker.errors import PlanError
from tracker.plan.pedicle import axis_from_angles, checked_side, rejections, tube_model
from tracker.plan.pedicle.fit import FittedBar, narrowest
from tracker.plan.pedicle.neighbourhood import Neighbourhood, neighbourhood_of
from tracker.plan.pedicle.outlines import planes_across
from tracker.plan.pedicle.plausibility import (
    agrees,
    beyond_medial_wall_mm,
    max_beyond_mm,
    medial_wall_mm,
    with_widened_uncertainty,
)
from tracker.plan.pedicle.remarks import canal_remarks
from tracker.plan.pedicle.section import Isthmus, isthmus_of
from tracker.plan.pedicle.solid import Solid, solid_around
from tracker.rehearsal.ct import VertebraPhantom, pedicle_tube, usual_bones


@pytest.fixture(scope="module")
def vertebra() -> tuple[VertebraPhantom, Neighbourhood, Solid]:
    pedicles = {
        side: pedicle_tube(
            side,
            width_mm=8.0,
            height_mm=13.0,
            transverse_deg=14.0,
            sagittal_deg=0.0,
            waist_mm=(15.0, 0.0, 3.0),
        )
        for side in ("left", "right")
    }
    made = VertebraPhantom(pedicles=pedicles, bones=usual_bones())
    volume = scanned(made.hu_at, spacing_mm=(1.0, 1.0, 2.0), noise_hu=20.0)
    near = neighbourhood_of(volume, np.array([0.0, 0.0, 3.0]))
    return made, near, solid_around(near, np.array([0.0, 0.0, 3.0]))


@pytest.mark.parametrize("side", ["left", "right"])
def test_the_canal_begins_at_a_true_pedicles_medial_wall_and_not_at_the_bodys_side_wall(
    vertebra: tuple[VertebraPhantom, Neighbourhood, Solid], side: str
) -> None:
    made, near, solid = vertebra
    truth, outwards = made.truth(side), 1.0 if side == "left" else -1.0
    named = checked_side(side)
    allowed = max_beyond_mm(near)
    true = beyond_medial_wall_mm(solid, truth.isthmus_lps_mm, truth.axis_lps, 4.0, named)
    on_body = np.array([outwards * 18.0, -22.0, 0.0])
    wrong = beyond_medial_wall_mm(
        solid, on_body, axis_from_angles(named, transverse_deg=30.0, sagittal_deg=0.0), 4.0, named
    )
    assert -1.5 < true < 0.5 * allowed
    assert wrong > 1.5 * allowed


def test_a_section_without_a_canal_beside_it_is_rejected_with_numbers() -> None:
    isthmus = isthmus_of(bar(width_mm=8.0, height_mm=12.0, roll_deg=0.0), (0.5, 0.5))
    rejections.reject_without_canal(isthmus, 6.9, 7.0)
    with pytest.raises(PlanError, match=r"goes on for 15 mm \(allowed 7 mm\)") as caught:
        rejections.reject_without_canal(isthmus, 15.0, 7.0)
    assert caught.value.code == "PEDICLE_DOUBTFUL"


@pytest.mark.parametrize("roll_deg", [-47.0, -43.0, 43.0, 47.0])
def test_the_smaller_extent_of_an_oblique_section_is_the_width_and_its_sd_covers_both(
    roll_deg: float,
) -> None:
    one = isthmus_of(bar(width_mm=16.0, height_mm=11.0, roll_deg=roll_deg), (0.5, 0.5))
    assert one.is_oblique
    assert (one.width_mm, one.height_mm) == pytest.approx((11.0, 16.0), abs=0.05)
    assert one.width_sd_mm > 2.0
    # Its wall is further from the axis than half of the stated width.
    assert medial_wall_mm(one, "left") == pytest.approx(6.9, abs=0.2)


def test_an_upright_section_is_as_certain_as_its_walls() -> None:
    wide: Isthmus = isthmus_of(bar(width_mm=16.0, height_mm=11.0, roll_deg=15.0), (0.5, 0.5))
    assert not wide.is_oblique
    assert wide.width_mm == pytest.approx(16.0, abs=0.05)
    assert wide.width_sd_mm < 0.15


def test_a_late_canal_gives_a_warning_before_it_is_rejected() -> None:
    assert canal_remarks(6.9, 7.0) == []
    assert "8 mm beyond the medial wall" in canal_remarks(8.0, 7.0)[0].message


def test_two_starts_agree_within_their_spreads_and_their_difference_widens_them() -> None:
    one = isthmus_of(bar(width_mm=9.0, height_mm=14.0, roll_deg=0.0), (3.0, 3.0))
    near_by = replace(one, width_mm=10.5, centre_mm=one.centre_mm + 3.0 * one.axis)
    assert agrees(one, near_by)
    assert with_widened_uncertainty(one, near_by).width_sd_mm == pytest.approx(1.5 / np.sqrt(2.0), abs=0.05)
    assert with_widened_uncertainty(one, near_by).centre_sd_mm > 2.0
    assert with_widened_uncertainty(one, one).width_sd_mm == one.width_sd_mm
    assert not agrees(one, replace(one, width_mm=16.0))
    assert agrees(one, replace(one, width_mm=16.0, width_sd_mm=3.0))
    assert not agrees(one, replace(one, centre_mm=one.centre_mm - 8.0 * one.axis))
    oblique = axis_from_angles("left", transverse_deg=30.0, sagittal_deg=0.0)
    assert not agrees(one, replace(one, axis=oblique))


def test_where_two_starts_differ_in_which_extent_is_the_width_the_lesser_is() -> None:
    wide = isthmus_of(bar(width_mm=17.0, height_mm=12.0, roll_deg=35.0), (3.0, 3.0))
    high = isthmus_of(bar(width_mm=12.0, height_mm=17.0, roll_deg=0.0), (3.0, 3.0))
    both = with_widened_uncertainty(wide, high)
    assert (both.width_mm, both.height_mm) == (wide.height_mm, wide.width_mm)
    assert both.is_oblique
    assert min(both.width_sd_mm, both.height_sd_mm) > 3.0
    assert with_widened_uncertainty(high, wide).width_mm == high.width_mm


def test_the_narrowest_place_of_a_bar_with_hardly_a_waist_never_jumps() -> None:
    slope, bends = -0.017, np.linspace(-0.02, 0.08, 200)
    places = [narrowest(bar(width_mm=9.0, height_mm=12.0, roll_deg=0.0, growth=(slope, b))) for b in bends]
    assert np.abs(np.diff(places)).max() < 0.01
    assert min(places) > 0.08
    assert narrowest(bar(width_mm=9.0, height_mm=12.0, roll_deg=0.0, growth=(0.0, 0.0))) == 0.0


def bar(
    *, width_mm: float, height_mm: float, roll_deg: float, growth: tuple[float, float] = (0.0, 0.1)
) -> FittedBar:
    axis = np.array([0.0, -1.0, 0.0])
    (left,), (up,) = planes_across(axis[None])
    parameters = np.zeros(tube_model.COUNT)
    parameters[tube_model.AXES] = [np.log(0.5 * width_mm), np.log(0.5 * height_mm), np.radians(roll_deg)]
    parameters[tube_model.GROWTH] = [*growth, *growth]
    return FittedBar(
        origin_mm=np.zeros(3),
        axis=axis,
        left=left,
        up=up,
        half_mm=5.0,
        parameters=parameters,
        covariance=np.eye(tube_model.COUNT) * 1e-5,
        residual_hu=10.0,
        misfit_ratio=0.0,
        fitted=True,
    )
