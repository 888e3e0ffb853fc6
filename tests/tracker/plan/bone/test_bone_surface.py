"""The extracted surface lies at the bone's boundary for any orientation of the scan."""

from typing import Any

import numpy as np
import pytest

from tests.tracker.plan.bone.ellipsoids import HALF_HU, Ellipsoid, affine_of, scanned
from tracker.errors import PlanError
from tracker.plan import Volume
from tracker.plan.bone import BoneSettings, BoneSurface, Region, bone_surface
from tracker.plan.triangles import connectivity_of

BODY = Ellipsoid()
WAYS = {
    "along-the-patient": affine_of(),
    "oblique": affine_of(turn=(0.4, -0.3, 0.2)),
    "all-of-it": affine_of(turn=(2.5, 0.4, -1.0), shear=-0.3, mirrored=True),
}


@pytest.fixture(scope="module", params=["along-the-patient", "all-of-it"])
def scan(request: pytest.FixtureRequest) -> Volume:
    return scanned((BODY,), WAYS[request.param])


def codes(made: BoneSurface) -> list[str]:
    return [remark.code for remark in made.remarks]


def test_the_surface_lies_where_the_bone_ends_and_is_wound_outwards(scan: Volume) -> None:
    made = bone_surface(scan, BoneSettings(threshold_hu=HALF_HU))
    off_mm = BODY.distances_mm(made.surface.vertices_mm)
    voxel_mm = float(np.cbrt(scan.voxel_mm3))
    assert np.abs(off_mm).max() < 0.3 * voxel_mm
    assert np.sqrt(np.mean(off_mm**2)) < 0.1 * voxel_mm
    assert made.surface.volume_ml == pytest.approx(BODY.volume_ml, rel=0.01)
    assert made.closed
    assert made.cut_at == ()
    assert connectivity_of(made.surface.faces).misoriented_edges == 0


def test_the_proposed_threshold_serves_too(scan: Volume) -> None:
    made = bone_surface(scan)
    assert made.threshold_hu == made.proposal.threshold_hu == pytest.approx(HALF_HU, abs=25.0)
    assert np.abs(BODY.distances_mm(made.surface.vertices_mm)).max() < 0.3 * float(np.cbrt(scan.voxel_mm3))


def test_in_noise_smoothing_brings_the_surface_nearer_to_the_truth() -> None:
    size = (72, 60, 48)
    scan = scanned((BODY,), affine_of(spacing=(0.5, 0.5, 0.5), shape_ijk=size), shape_ijk=size, noise_hu=60.0)
    rms = {}
    for rounds in (0, 40):
        settings = BoneSettings(threshold_hu=HALF_HU, smoothing_rounds=rounds, max_faces=None)
        made = bone_surface(scan, settings)
        rms[rounds] = float(np.sqrt(np.mean(BODY.distances_mm(made.surface.vertices_mm) ** 2)))
        # Laplacian smoothing alone would shrink it by a tenth in 40 rounds.
        assert made.surface.volume_ml == pytest.approx(BODY.volume_ml, rel=0.01)
    assert rms[40] < 0.7 * rms[0]


def test_fewer_triangles_keep_the_shape() -> None:
    made = bone_surface(scanned((BODY,), WAYS["oblique"]), BoneSettings(threshold_hu=HALF_HU, max_faces=1000))
    assert made.faces_before > 4000
    assert 800 <= made.surface.faces.shape[0] <= 1000
    assert np.abs(BODY.distances_mm(made.surface.vertices_mm)).max() < 0.2
    assert made.surface.volume_ml == pytest.approx(BODY.volume_ml, rel=0.01)
    assert made.closed


def test_small_components_are_removed_on_request() -> None:
    small = Ellipsoid(centre_lps_mm=(27.0, -230.0, 950.0), half_axes_mm=(1.5, 1.5, 3.0))
    big = Ellipsoid(centre_lps_mm=(7.0, -230.0, 950.0), half_axes_mm=(10.0, 8.0, 8.0))
    scan = scanned((big, small), affine_of())
    largest = bone_surface(scan, BoneSettings(threshold_hu=HALF_HU))
    both = bone_surface(scan, BoneSettings(threshold_hu=HALF_HU, largest_part_only=False))
    assert largest.parts == both.parts == 2
    assert largest.surface.vertices_mm[:, 0].max() < 18.0
    assert both.surface.vertices_mm[:, 0].max() == pytest.approx(28.5, abs=0.3)


def test_a_region_takes_one_bone_out_of_two_and_reads_only_it() -> None:
    above = Ellipsoid(centre_lps_mm=(12.0, -230.0, 958.0), half_axes_mm=(9.0, 7.0, 3.5))
    below = Ellipsoid(centre_lps_mm=(12.0, -230.0, 944.0), half_axes_mm=(12.0, 8.0, 4.0))
    scan = scanned((above, below), affine_of(turn=(0.1, 0.2, 0.3)))
    region = Region.around([[12.0, -230.0, 958.0]], reach_mm=12.0)
    region = Region.between([*region.low_lps_mm[:2], 951.0], region.high_lps_mm)
    made = bone_surface(scan, BoneSettings(threshold_hu=HALF_HU, region=region))
    assert made.region is region
    assert made.surface.volume_ml == pytest.approx(above.volume_ml, rel=0.02)
    assert region.contains(made.surface.vertices_mm).all()
    assert made.closed


def test_bone_that_a_region_cuts_is_left_open_there() -> None:
    region = Region.between([-20.0, -260.0, 930.0], [12.0, -200.0, 970.0])
    made = bone_surface(scanned((BODY,), affine_of()), BoneSettings(threshold_hu=HALF_HU, region=region))
    assert not made.closed
    assert made.cut_at == ()
    assert codes(made) == []
    assert made.surface.vertices_mm[:, 0].max() <= 12.0


def test_bone_that_the_scan_cuts_is_reported_with_the_end() -> None:
    affine = affine_of()
    affine[2, 3] += 9.0
    made = bone_surface(scanned((BODY,), affine), BoneSettings(threshold_hu=HALF_HU))
    assert made.cut_at == ("first slice",)
    assert codes(made) == ["BONE_CUT_BY_CT"]
    assert "first slice" in made.remarks[0].message
    assert not made.closed


def test_too_many_voxels_are_averaged_and_stay_in_their_place() -> None:
    scan = scanned((BODY,), WAYS["all-of-it"])
    made = bone_surface(scan, BoneSettings(threshold_hu=HALF_HU, max_voxels=31_000))
    # The closest voxels are merged first: 0.5 mm by 0.5 mm before 1 mm.
    assert made.averaged_ijk == (2, 2, 1)
    assert made.voxel_mm[:2] == pytest.approx([1.0, 1.0])
    assert codes(made) == ["BONE_AVERAGED"]
    off_mm = BODY.distances_mm(made.surface.vertices_mm)
    assert np.abs(off_mm).max() < 0.3
    assert abs(off_mm.mean()) < 0.05


@pytest.mark.parametrize("threshold_hu", [-3000.0, 39.0, 40.0, 641.0, 9000.0])
def test_a_threshold_outside_the_values_is_rejected_with_their_range(threshold_hu: float) -> None:
    scan = scanned((BODY,), affine_of(), fine=1)
    with pytest.raises(PlanError, match=r"40 to 640 HU") as reported:
        bone_surface(scan, BoneSettings(threshold_hu=threshold_hu))
    assert reported.value.code == "BONE_THRESHOLD_OUTSIDE"


def test_a_threshold_that_is_the_very_value_of_the_voxels_makes_whole_triangles() -> None:
    made = bone_surface(
        scanned((BODY,), affine_of(), fine=1),
        BoneSettings(threshold_hu=640.0, smoothing_rounds=0, max_faces=None),
    )
    a, b, c = (made.surface.vertices_mm[made.surface.faces[:, i]] for i in range(3))
    assert np.linalg.norm(np.cross(b - a, c - a), axis=1).min() > 1e-9
    assert made.closed


def test_an_unusual_threshold_is_reported() -> None:
    made = bone_surface(scanned((BODY,), affine_of()), BoneSettings(threshold_hu=620.0))
    assert codes(made) == ["BONE_THRESHOLD_UNUSUAL"]


def test_a_scan_of_soft_tissue_alone_has_no_bone() -> None:
    flat = Volume(hu=np.full((20, 20, 20), 40, np.int16), lps_from_ijk=np.eye(4))
    with pytest.raises(PlanError) as reported:
        bone_surface(flat)
    assert reported.value.code == "BONE_THRESHOLD_OUTSIDE"


def test_a_surface_through_noise_is_rejected_before_it_fills_the_memory(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("tracker.plan.bone.extraction.MAX_VERTICES", 10_000)
    noise = np.random.default_rng(1).integers(-500, 500, (40, 40, 40)).astype(np.int16)
    with pytest.raises(PlanError, match="allowed 10000") as reported:
        bone_surface(Volume(hu=noise, lps_from_ijk=np.eye(4)), BoneSettings(threshold_hu=0.0))
    assert reported.value.code == "BONE_TOO_LARGE"


@pytest.mark.parametrize(
    ("low", "high", "code"),
    [
        pytest.param([0, 0, 0], [5, 5, 5], "REGION_OUTSIDE", id="beside-the-scan"),
        pytest.param([5, 5, 5], [0, 9, 9], "REGION_INVALID", id="corners-swapped"),
        pytest.param([np.nan, 0, 0], [5, 5, 5], "REGION_INVALID", id="not-a-number"),
    ],
)
def test_a_region_without_voxels_is_rejected(low: list[float], high: list[float], code: str) -> None:
    scan = scanned((BODY,), affine_of(), fine=1)
    with pytest.raises(PlanError) as reported:
        bone_surface(scan, BoneSettings(region=Region.between(low, high)))
    assert reported.value.code == code


def test_a_region_of_soft_tissue_has_no_bone() -> None:
    scan = scanned((BODY,), affine_of(), fine=1)
    region = Region.around([[28.0, -243.0, 961.0]], reach_mm=1.5)
    with pytest.raises(PlanError) as reported:
        bone_surface(scan, BoneSettings(region=region, threshold_hu=300.0))
    assert reported.value.code == "BONE_THRESHOLD_OUTSIDE"


def test_invalid_settings_are_rejected() -> None:
    wrong: list[dict[str, Any]] = [
        {"threshold_hu": np.nan},
        {"smoothing_rounds": -1},
        {"max_faces": 3},
        {"max_voxels": 1},
    ]
    for settings in wrong:
        with pytest.raises(PlanError) as reported:
            BoneSettings(**settings)
        assert reported.value.code == "BONE_SETTINGS_INVALID"
