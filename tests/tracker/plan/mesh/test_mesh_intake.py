"""An imported mesh: unit, winding, holes."""

import numpy as np
import pytest

from tests.tracker.plan.bone.ellipsoids import HALF_HU, Ellipsoid, affine_of, scanned
from tracker.errors import PlanError
from tracker.plan import Surface
from tracker.plan.bone import BoneSettings, bone_surface
from tracker.plan.mesh import MeshSurface, fitting_units, surface_from_mesh

BODY = Ellipsoid(half_axes_mm=(17.0, 14.0, 12.0))


@pytest.fixture(scope="module")
def bone() -> Surface:
    """Closed, 34 x 28 x 24 mm."""
    scan = scanned((BODY,), affine_of(spacing=(0.6, 0.6, 1.0)), fine=2)
    return bone_surface(scan, BoneSettings(threshold_hu=HALF_HU, max_faces=800)).surface


def codes(taken: MeshSurface) -> list[str]:
    return [remark.code for remark in taken.remarks]


@pytest.mark.parametrize(
    ("size", "first", "kind"),
    [
        pytest.param([92.3, 94.6, 54.6], "mm", "vertebra", id="a-loin-in-mm"),
        pytest.param([0.0923, 0.0946, 0.0546], "m", "vertebra", id="in-metres"),
        pytest.param([9.23, 9.46, 5.46], "cm", "vertebra", id="in-centimetres"),
        pytest.param([3.63, 3.72, 2.15], "inch", "vertebra", id="in-inches"),
        pytest.param([92300.0, 94600.0, 54600.0], "um", "vertebra", id="in-micrometres"),
        pytest.param([50.0, 48.0, 18.0], "mm", "vertebra", id="a-neck"),
        pytest.param([95.0, 100.0, 190.0], "mm", "several vertebrae", id="five-loins"),
        pytest.param([0.1, 0.12, 0.6], "m", "several vertebrae", id="a-spine-in-metres"),
        pytest.param([9.0, 12.0, 60.0], "cm", "several vertebrae", id="a-spine-in-centimetres"),
    ],
)
def test_the_unit_shows_by_the_size(size: list[float], first: str, kind: str) -> None:
    fits = fitting_units(np.array(size))
    assert (fits[0].unit, fits[0].kind) == (first, kind)


@pytest.mark.parametrize("size", [[1e-9] * 3, [1e7] * 3, [60.0, 0.0, 60.0], [900.0, 2.0, 900.0]])
def test_what_is_no_bone_fits_in_no_unit(size: list[float]) -> None:
    assert fitting_units(np.array(size)) == ()


def test_a_vertebra_in_mm_needs_no_unit(bone: Surface) -> None:
    taken = surface_from_mesh(bone.vertices_mm, bone.faces)
    assert codes(taken) == []
    assert (taken.closed, taken.parts, taken.flipped_faces) == (True, 1, 0)
    assert taken.surface.volume_ml == pytest.approx(bone.volume_ml)


def test_another_unit_is_proposed_and_taken_only_when_given(bone: Surface) -> None:
    with pytest.raises(PlanError) as reported:
        surface_from_mesh(bone.vertices_mm / 10.0, bone.faces)
    assert reported.value.code == "MESH_UNIT_NEEDED"
    assert "cm" in reported.value.remedy
    assert reported.value.context["possible_units"] == ["inch", "cm"]
    taken = surface_from_mesh(bone.vertices_mm / 10.0, bone.faces, unit="cm")
    assert taken.surface.volume_ml == pytest.approx(bone.volume_ml)
    assert (taken.unit, taken.unit_given) == ("cm", True)


@pytest.mark.parametrize(
    ("scale", "unit", "code"),
    [
        (1.0, "m", "MESH_SIZE_IMPLAUSIBLE"),
        (1.0, "furlong", "MESH_UNIT_INVALID"),
        (1e-9, None, "MESH_SIZE_IMPLAUSIBLE"),
    ],
)
def test_an_impossible_unit_is_rejected(bone: Surface, scale: float, unit: str | None, code: str) -> None:
    with pytest.raises(PlanError) as reported:
        surface_from_mesh(bone.vertices_mm * scale, bone.faces, unit=unit)
    assert reported.value.code == code


def test_inside_out_triangles_are_flipped_and_reported(bone: Surface) -> None:
    taken = surface_from_mesh(bone.vertices_mm, bone.faces[:, ::-1])
    assert taken.surface.volume_ml == pytest.approx(bone.volume_ml)
    assert taken.flipped_faces == bone.faces.shape[0]
    assert codes(taken) == ["MESH_FLIPPED"]


def test_triangles_that_disagree_with_their_neighbours_are_flipped(bone: Surface) -> None:
    faces = bone.faces.copy()
    wrong = np.random.default_rng(2).choice(faces.shape[0], 150, replace=False)
    faces[wrong] = faces[wrong, ::-1]
    taken = surface_from_mesh(bone.vertices_mm, faces)
    assert taken.flipped_faces == 150
    assert taken.surface.volume_ml == pytest.approx(bone.volume_ml)


def test_of_two_bones_the_one_inside_out_is_flipped(bone: Surface) -> None:
    vertices = np.concatenate([bone.vertices_mm, bone.vertices_mm + np.array([40.0, 0.0, 0.0])])
    faces = np.concatenate([bone.faces, bone.faces[:, ::-1] + bone.vertices_mm.shape[0]])
    taken = surface_from_mesh(vertices, faces)
    assert taken.surface.volume_ml == pytest.approx(2.0 * bone.volume_ml)
    assert codes(taken) == ["MESH_FLIPPED", "MESH_IN_PARTS"]


@pytest.mark.parametrize("turned", [False, True])
def test_a_cavity_stays_a_cavity(bone: Surface, turned: bool) -> None:
    middle = bone.vertices_mm.mean(axis=0)
    vertices = np.concatenate([bone.vertices_mm, middle + 0.5 * (bone.vertices_mm - middle)])
    faces = np.concatenate([bone.faces, bone.faces[:, ::-1] + bone.vertices_mm.shape[0]])
    taken = surface_from_mesh(vertices, faces[:, ::-1] if turned else faces)
    assert taken.surface.volume_ml == pytest.approx(0.875 * bone.volume_ml)


@pytest.mark.parametrize("turned", [False, True])
def test_an_open_surface_is_reported_and_still_wound_outwards(bone: Surface, turned: bool) -> None:
    retained = bone.faces[bone.vertices_mm[bone.faces][:, :, 2].mean(axis=1) < 955.0]
    taken = surface_from_mesh(bone.vertices_mm, retained[:, ::-1] if turned else retained)
    assert "MESH_OPEN" in codes(taken)
    assert not taken.closed
    corners = taken.surface.vertices_mm[taken.surface.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("ij,ij->i", normals, corners.mean(axis=1) - BODY.centre_lps_mm) > 0.0).mean() > 0.99


def test_degenerate_triangles_are_removed_and_counted(bone: Surface) -> None:
    extra = np.array([[0, 0, 1], [2, 2, 2], [*bone.faces[5]]])
    apart = bone.vertices_mm[np.concatenate([bone.faces, extra])].reshape(-1, 3)
    taken = surface_from_mesh(apart, np.arange(apart.shape[0]).reshape(-1, 3))
    assert taken.surface.faces.shape == bone.faces.shape
    assert taken.surface.vertices_mm.shape == bone.vertices_mm.shape
    assert codes(taken) == ["MESH_CLEANED"]
    assert taken.closed


def test_a_non_manifold_edge_is_reported(bone: Surface) -> None:
    a, b, _ = bone.faces[0]
    vertices = np.concatenate([bone.vertices_mm, [bone.vertices_mm[a] + [0.5, 0.5, 0.5]]])
    taken = surface_from_mesh(vertices, np.concatenate([bone.faces, [[a, b, vertices.shape[0] - 1]]]))
    assert {"MESH_NOT_MANIFOLD", "MESH_OPEN"} <= set(codes(taken))
    assert not taken.closed


def test_a_whole_spine_is_reported(bone: Surface) -> None:
    taken = surface_from_mesh(bone.vertices_mm * [3.0, 3.0, 20.0], bone.faces)
    assert codes(taken) == ["MESH_SEVERAL_VERTEBRAE"]
    assert taken.kind == "several vertebrae"


@pytest.mark.parametrize(
    ("vertices", "faces", "code"),
    [
        pytest.param(np.zeros((0, 3)), np.zeros((0, 3)), "MESH_EMPTY", id="nothing"),
        pytest.param(np.zeros((9, 3)), np.arange(9).reshape(3, 3), "MESH_EMPTY", id="all-in-one-point"),
        pytest.param(np.eye(3), [[0, 1, 3]], "MESH_INVALID", id="a-vertex-that-is-not-there"),
        pytest.param(np.eye(3), [[0, 1, -1]], "MESH_INVALID", id="a-vertex-below-the-first"),
        pytest.param(np.eye(3) * np.nan, [[0, 1, 2]], "MESH_INVALID", id="no-numbers"),
        pytest.param(np.eye(4), [[0, 1, 2]], "MESH_INVALID", id="four-coordinates"),
    ],
)
def test_an_invalid_mesh_is_rejected(vertices: np.ndarray, faces: object, code: str) -> None:
    with pytest.raises(PlanError) as reported:
        surface_from_mesh(vertices, np.asarray(faces))
    assert reported.value.code == code
