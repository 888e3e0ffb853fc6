"""Start and end of a pedicle's length: at the arch, not a process; at the body, not a vessel."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import ndtr

from tracker.errors import PlanError
from tracker.geometry import Array
from tracker.plan import PedicleMeasure, measure_pedicle
from tracker.plan.edge_model import Imaging
from tracker.plan.pedicle.length import WallAhead
from tracker.plan.pedicle.length.entry import arch_back_mm
from tracker.plan.pedicle.length.walls import _grazing_sd_mm, _wall
from tracker.plan.pedicle.neighbourhood import Neighbourhood
from tracker.plan.pedicle.rejections import reject_implausible_length
from tracker.plan.pedicle.solid import STEP_MM, Solid
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
# In a voxel; enough for lengths, and a scan with the usual ones takes longer than the measurement.
SAMPLES = (2, 2, 3)


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
    grid = replace(grid, samples=SAMPLES)
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
    assert any("process" in warning.message for warning in one.warnings)


def test_a_vessel_that_touches_the_body_is_not_part_of_the_length() -> None:
    at = np.array([8.0, -52.0, 0.0])
    made = vertebra(
        beside=(ContrastTube(part=Rod(start_mm=at - UP, end_mm=at + UP, radius_mm=11.0), hu=150.0),)
    )
    one = measured(made)
    assert one.length_mm == pytest.approx(made.truth("left").length_mm, abs=1.2)
    assert any("touches the front wall" in warning.message for warning in one.warnings)


def measured_with(made: VertebraPhantom, hu_at: Callable[[Array], Array]) -> PedicleMeasure:
    grid = ScanGrid.around(
        (0.0, -6.0, 0.0), size_mm=(64.0, 112.0, 44.0), spacing_mm=(1.5, 1.5, 1.5), noise_hu=20.0, blur_mm=0.3
    )
    grid = replace(grid, samples=SAMPLES)
    return measure_pedicle(scan(hu_at, grid), made.seed_lps_mm("left"), "left")


def with_void(made: VertebraPhantom, centre_mm: Array, radius_mm: float) -> Callable[[Array], Array]:
    """The phantom with weak trabeculae in the body, as dark as fat, that a channel joins to its side."""

    def hu_at(points: Array) -> Array:
        hu = made.hu_at(points)
        depth = -made.bone_distance_mm(points)
        channel = (np.linalg.norm(points[:, 1:] - centre_mm[1:], axis=1) < 4.0) & (
            points[:, 0] > centre_mm[0]
        )
        void = np.linalg.norm(points - centre_mm, axis=1) < radius_mm
        hu[(channel | (void & (depth > made.cortex_mm))) & (depth > 0.0)] = -30.0
        return hu

    return hu_at


def test_the_front_wall_lies_behind_weak_trabeculae_that_open_to_the_side() -> None:
    made = vertebra()
    truth = made.truth("left")
    void = with_void(made, truth.isthmus_lps_mm + 20.0 * truth.axis_lps, radius_mm=8.0)
    assert measured_with(made, void).length_mm == pytest.approx(truth.length_mm, abs=2.5)


def wall(distance_mm: float, *, chord_mm: float = 0.0) -> WallAhead:
    return WallAhead(
        distance_mm=distance_mm, found=True, outwards=UP / 60.0, faced_ratio=1.0, chord_mm=chord_mm
    )


@pytest.mark.parametrize(
    ("front", "back", "message"),
    [
        pytest.param(wall(14.0), wall(8.0), r"22\.0 mm in bone \(25 to 75", id="short"),
        pytest.param(wall(60.0), wall(20.0), r"80\.0 mm in bone", id="long"),
        pytest.param(wall(22.0, chord_mm=36.0), wall(16.0), "body reaches 36 mm", id="dent"),
    ],
)
def test_a_length_that_the_vertebra_contradicts_is_rejected(
    front: WallAhead, back: WallAhead, message: str
) -> None:
    with pytest.raises(PlanError, match=message) as caught:
        reject_implausible_length(front, back, 6.0)
    assert caught.value.code == "PEDICLE_DOUBTFUL"


def test_a_front_wall_at_the_outline_is_accepted() -> None:
    reject_implausible_length(wall(34.0, chord_mm=36.0), wall(16.0), 6.0)


@pytest.mark.parametrize(
    ("faced_ratio", "sd_mm"),
    [
        pytest.param(1.0, 0.0, id="at right angles"),
        pytest.param(0.6, 0.0, id="obliquely"),
        pytest.param(0.2, 3.0, id="along the surface"),
    ],
)
def test_an_exit_along_a_surface_is_less_certain(faced_ratio: float, sd_mm: float) -> None:
    """The end of a plane moved by a voxel of 1 mm to either side, beyond that of one met at 60 degrees."""
    direction = np.array([faced_ratio, np.sqrt(1.0 - faced_ratio**2), 0.0])
    nodes = STEP_MM * np.arange(40)
    depth = np.broadcast_to((20.0 * faced_ratio - nodes)[:, None, None], (40, 40, 40)).astype(np.float32)
    solid = Solid(corner_mm=np.zeros(3), depth_mm=depth)
    found = _grazing_sd_mm(
        solid, np.array([0.0, 0.0, 5.0]), direction, 20.0, max(faced_ratio, 0.5), voxel_mm=1.0
    )
    assert found == pytest.approx(sd_mm, abs=0.2)


WALL_MM, SPACING_MM = 16.0, 0.8
IMAGING = Imaging(
    cortex_hu=900.0, cortex_sd_hu=100.0, blur_mm=0.4, blur_sd_log=0.2, tissue_hu=40.0, noise_hu=10.0
)


def bone_up_to_a_wall(cortex_mm: float) -> Neighbourhood:
    """Bone up to x = 16 mm, in voxels of 0.8 mm."""
    sigma_mm = np.hypot(SPACING_MM / np.sqrt(12.0), 0.4)
    x = SPACING_MM * np.arange(40)
    hu = 40.0 + 860.0 * ndtr((WALL_MM - x) / sigma_mm) - 800.0 * ndtr((WALL_MM - cortex_mm - x) / sigma_mm)
    block = np.broadcast_to(hu, (24, 24, 40)).astype(np.float32)
    return Neighbourhood(
        block=block,
        smooth=block,
        lps_from_index=np.diag([SPACING_MM, SPACING_MM, SPACING_MM, 1.0]),
        noise_hu=10.0,
        tissue_hu=40.0,
        cortex_hu=900.0,
    )


def solid_up_to(normal: Array, at_mm: float) -> Solid:
    """All that lies this far along a direction at most."""
    points = STEP_MM * np.moveaxis(np.indices((26, 26, 16)), 0, -1)
    return Solid(corner_mm=np.zeros(3), depth_mm=(at_mm - points @ normal).astype(np.float32))


@pytest.mark.parametrize("cortex_mm", [0.4, 1.2])
def test_a_wall_is_at_the_outside_of_its_cortex_however_thin(cortex_mm: float) -> None:
    """The half level of the profile lies 0.45 mm outside of a cortex of 0.4 mm."""
    start, axis = np.array([4.0, 9.0, 9.0]), np.array([1.0, 0.0, 0.0])
    near, solid = bone_up_to_a_wall(cortex_mm), solid_up_to(axis, WALL_MM)
    wall = _wall(near, solid, IMAGING, start, axis, from_mm=2.0, exit_mm=12.5)
    assert wall.distance_mm == pytest.approx(WALL_MM - 4.0, abs=0.1)
    assert wall.sd_mm < 0.3


def test_an_endplate_beside_a_disc_that_the_solid_fills_is_met_obliquely() -> None:
    """The length then depends on the wall by the inverse of the cosine, as stated."""
    start, axis = np.array([14.0, 4.0, 9.0]), np.array([0.25, np.sqrt(1.0 - 0.25**2), 0.0])
    near, solid = bone_up_to_a_wall(1.0), solid_up_to(axis, float(axis @ start) + 9.0)
    wall = _wall(near, solid, IMAGING, start, axis, from_mm=2.0, exit_mm=9.0)
    assert wall.faced_ratio == pytest.approx(0.25, abs=0.05)
    assert wall.sd_mm > 2.0


@pytest.mark.parametrize(("hole_mm", "face_mm"), [(0.0, 12.0), (3.0, None)])
def test_marrow_that_is_missing_on_the_axis_is_not_the_back_of_the_arch(
    hole_mm: float, face_mm: float | None
) -> None:
    # A pedicle, an arch up to 12 mm, and a process on its axis; thin trabeculae leave a hole in the solid.
    side = np.arange(-14.0, 14.1, STEP_MM)
    behind = np.arange(-4.0, 34.1, STEP_MM)
    x, y, z = np.meshgrid(side, behind, side, indexing="ij")
    beside = np.hypot(x, z)
    depth = np.where(y < 12.0, np.where(y < 6.0, 5.0, 9.0), 3.0) - beside
    depth = np.where(np.hypot(beside, y - 5.0) < hole_mm, -1.0, depth)
    solid = Solid(corner_mm=np.array([side[0], behind[0], side[0]]), depth_mm=depth.astype(np.float32))
    found = arch_back_mm(solid, np.zeros(3), np.array([0.0, -1.0, 0.0]))
    assert found == (None if face_mm is None else pytest.approx(face_mm, abs=0.5))
