"""Real pedicles: direction of the axis, and repeatability over neighbouring clicks."""

import functools
from pathlib import Path

import numpy as np
import pytest

from server.imaging.ct_reader import read_ct
from tests.real_data import real_data_file
from tracker.errors import PlanError
from tracker.plan import PedicleMeasure, Volume, measure_pedicle
from tracker.plan.pedicle.course import course_through
from tracker.plan.pedicle.neighbourhood import neighbourhood_of
from tracker.plan.pedicle.solid import solid_around


@functools.cache
def read(path: Path) -> Volume:
    return read_ct(path).volume


def thoracic() -> Volume:
    return read(real_data_file("ct", "thoracic-dicom"))


def lumbar() -> Volume:
    return read(real_data_file("ct", "lumbar-3mm", "ct.nii.gz"))


@pytest.mark.parametrize(
    ("side", "clicks"),
    [
        pytest.param("left", ((9.4, -91.0, -788.5), (9.5, -90.0, -784.5)), id="left"),
        pytest.param("right", ((-23.0, -89.0, -790.5),), id="right"),
    ],
)
def test_a_lower_thoracic_pedicle_runs_forwards_inside_the_bone(
    side: str, clicks: tuple[tuple[float, float, float], ...]
) -> None:
    found = [measure_pedicle(thoracic(), click, side) for click in clicks]
    for one in found:
        assert 0.0 <= one.transverse_deg <= 12.0
        # Estimated from the slices: 7 to 10 mm wide, 16 to 22 mm high.
        assert 7.0 < one.width_mm < 10.0
        assert 15.5 < one.height_mm < 23.0
        assert one.isthmus_lps_mm[2] == pytest.approx(-788.0, abs=4.0)
        assert np.linalg.norm(one.isthmus_lps_mm - np.mean(clicks, axis=0)) < 5.0
        # A short pedicle determines its direction to some degrees only, as stated.
        assert 2.0 <= one.sd.transverse_deg <= 8.0
    assert bone_around(thoracic(), found[0]) > 1.0
    assert np.ptp([one.transverse_deg for one in found]) < 4.0


@pytest.mark.parametrize(
    ("side", "click", "allowed_deg"),
    [
        pytest.param("right", (-10.5, -104.5, 385.0), (5.0, 16.0), id="L1-right"),
        pytest.param("left", (26.0, -122.0, 250.0), (18.0, 34.0), id="L5-left"),
    ],
)
def test_lumbar_pedicles_converge_as_their_level_does_even_in_thick_voxels(
    side: str, click: tuple[float, float, float], allowed_deg: tuple[float, float]
) -> None:
    one = measure_pedicle(lumbar(), click, side)
    assert allowed_deg[0] <= one.transverse_deg <= allowed_deg[1]
    assert 40.0 <= one.length_mm <= 70.0


def test_a_section_on_the_side_wall_of_the_body_is_rejected() -> None:
    # L5's process joins the side wall of its body, where a narrow closed section stands beside no canal.
    with pytest.raises(PlanError) as caught:
        measure_pedicle(lumbar(), (-23.0, -120.0, 251.0), "right")
    assert caught.value.code == "PEDICLE_DOUBTFUL"


def test_marrow_is_filled_and_the_canal_is_not() -> None:
    volume = thoracic()
    solid = solid_around(
        neighbourhood_of(volume, np.array([9.7, -90.6, -787.0])), np.array([9.7, -90.6, -787.0])
    )
    body, canal, pedicle = np.array([[-7.0, -118.0, -787.0], [-7.0, -89.0, -787.0], [9.7, -90.6, -787.0]])
    assert solid.depth_at(body[None])[0] > 8.0
    assert solid.depth_at(canal[None])[0] < -5.0
    assert solid.depth_at(pedicle[None])[0] > 2.0


def test_the_course_is_the_same_on_both_sides_and_converges() -> None:
    volume = thoracic()
    found = []
    for side, point in (("left", (9.7, -90.6, -787.0)), ("right", (-23.6, -90.3, -788.0))):
        at = np.array(point)
        found.append(course_through(solid_around(neighbourhood_of(volume, at), at), at, side))
    assert found[0].transverse_deg == pytest.approx(found[1].transverse_deg, abs=4.0)
    assert found[0].sagittal_deg == pytest.approx(found[1].sagittal_deg, abs=8.0)


def bone_around(volume: Volume, one: PedicleMeasure) -> float:
    """Least bone around the axis, in mm, from 6 mm behind the isthmus to 24 mm ahead of it."""
    solid = solid_around(neighbourhood_of(volume, one.isthmus_lps_mm), one.isthmus_lps_mm)
    along = np.arange(-6.0, 24.0, 1.0)
    return float(solid.depth_at(one.isthmus_lps_mm + along[:, None] * one.axis_lps).min())
