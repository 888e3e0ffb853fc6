"""Distance to the bone: true near the wall, marrow filled, cut bones bounded, the canal left open."""

import pickle
from collections.abc import Callable
from functools import lru_cache

import numpy as np
import pytest
import trimesh

from tests.tracker.navigation.bones import (
    ROD_CHANNEL,
    ROD_FRONT_MM,
    middles_mm,
    rod,
    together,
    without_faces,
)
from tracker.errors import PlanError
from tracker.geometry import Array
from tracker.navigation.clearance import (
    WallDistanceField,
    WallSource,
    bone_distance_field,
    channel_distance_field,
)
from tracker.navigation.clearance.voxels import dilated
from tracker.plan import Channel, Surface
from tracker.plan.triangles.connectivity import Faces
from tracker.rehearsal.anatomy import bone_field, pedicle_channels, vertebra_surface


@pytest.fixture(scope="module")
def solid_rod() -> WallDistanceField:
    return _shared_rod()


@pytest.mark.parametrize(
    ("point_mm", "distance_mm"),
    [
        pytest.param((1.5, 0.0, 0.0), -3.5, id="near-the-axis"),
        pytest.param((3.0, 0.0, 0.0), -2.0, id="two-inside"),
        pytest.param((0.0, -10.0, -4.9), -0.1, id="a-tenth-inside"),
        pytest.param((3.0, 5.0, 4.0), 0.0, id="on-the-wall"),
        pytest.param((0.0, 0.0, 8.0), 3.0, id="three-outside"),
        pytest.param((0.0, ROD_FRONT_MM + 1.5, 0.0), -1.5, id="before-the-front-wall"),
        pytest.param((0.0, ROD_FRONT_MM - 2.0, 1.0), 2.0, id="through-the-front-wall"),
        pytest.param((0.0, 18.0, 2.0), -3.0, id="under-the-back-which-is-no-wall"),
    ],
)
def test_distances_are_those_that_a_hand_measures(
    solid_rod: WallDistanceField, point_mm: tuple[float, float, float], distance_mm: float
) -> None:
    distance, _ = solid_rod.distances_mm(np.array(point_mm))
    assert distance[0] == pytest.approx(distance_mm, abs=0.06)


def test_the_gradient_is_the_slope_and_points_outwards(solid_rod: WallDistanceField) -> None:
    random = np.random.default_rng(1)
    off, turn = random.uniform(2.5, 8.0, 4000), random.uniform(0.0, 2.0 * np.pi, 4000)
    outwards = np.stack([np.cos(turn), np.zeros(4000), np.sin(turn)], axis=1)
    points = off[:, None] * outwards + random.uniform(-30.0, 10.0, 4000)[:, None] * [0.0, 1.0, 0.0]
    _, gradient = solid_rod.distances_mm(points)
    wrong = np.abs((gradient * outwards).sum(axis=1) - 1.0)
    assert np.median(wrong) < 0.02
    assert np.percentile(wrong, 99) < 0.12
    # Two nodes half a millimetre apart, each true to 0.06 mm.
    assert wrong.max() < 2.0 * 0.06 / 0.5


@lru_cache(maxsize=1)
def _shared_rod() -> WallDistanceField:
    return bone_distance_field(rod(), ROD_CHANNEL, margin_mm=15.0)


def _side_distances_mm(field: WallDistanceField) -> Array:
    """From near the axis, and a millimetre inside and outside; in the middle of the rod."""
    return field.distances_mm(np.array([[1.5, -10, 0], [4.0, -10, 0], [0.0, -10, -6.0]]))[0]


def test_marrow_counts_as_bone_and_its_walls_as_none() -> None:
    marrow = rod(3.5, turned_inside_out=True, shorter_mm=2.0)
    field = bone_distance_field(together(rod(), marrow), ROD_CHANNEL, margin_mm=15.0)
    np.testing.assert_allclose(_side_distances_mm(field), [-3.5, -1.0, 1.0], atol=0.06)


@pytest.mark.parametrize(("hole_mm", "closing_radius_mm"), [(0.8, 1.0), (2.2, 3.0)])
def test_a_hole_in_the_cortex_does_not_let_the_outside_in(hole_mm: float, closing_radius_mm: float) -> None:
    marrow = rod(3.5, turned_inside_out=True, shorter_mm=2.0)
    # Fine triangles with a hole in both walls.
    fine = _finer(together(rod(), marrow))
    middle = middles_mm(fine)
    hole = (np.hypot(middle[:, 1], middle[:, 0]) < hole_mm) & (middle[:, 2] > 0.0)
    assert hole.sum() > 3
    field = bone_distance_field(without_faces(fine, hole), ROD_CHANNEL, margin_mm=15.0)
    np.testing.assert_allclose(_side_distances_mm(field), [-3.5, -1.0, 1.0], atol=0.06)
    assert field.closing_radius_mm <= closing_radius_mm


def _finer(surface: Surface) -> Surface:
    divide: Callable[..., tuple[Array, Faces]] = trimesh.remesh.subdivide_to_size
    vertices, faces = divide(surface.vertices_mm, surface.faces, max_edge=1.2)
    return Surface(vertices_mm=vertices, faces=faces)


@pytest.mark.parametrize(
    ("is_diagonal", "inside", "in_corner"),
    [pytest.param(False, 7, 4, id="over-faces"), pytest.param(True, 27, 8, id="over-edges-and-corners-too")],
)
def test_a_voxel_grows_into_its_neighbours_and_not_around_the_grid(
    is_diagonal: bool, inside: int, in_corner: int
) -> None:
    for at, count in (((2, 2, 2), inside), ((0, 3, 0), in_corner), ((4, 0, 4), in_corner)):
        voxels = np.zeros((5, 4, 5), np.bool_)
        voxels[at] = True
        grown = dilated(voxels, is_diagonal=is_diagonal)
        assert grown.sum() == count
        assert np.abs(np.argwhere(grown) - at).max() == 1
        assert voxels.sum() == 1


def test_a_bone_cut_open_in_front_goes_on_there() -> None:
    whole = rod()
    cut = without_faces(whole, middles_mm(whole)[:, 1] < ROD_FRONT_MM + 1e-3)
    field = bone_distance_field(cut, ROD_CHANNEL, margin_mm=15.0)
    np.testing.assert_allclose(_side_distances_mm(field), [-3.5, -1.0, 1.0], atol=0.06)
    assert field.distances_mm(np.array([0.0, ROD_FRONT_MM - 1.0, 0.0]))[0][0] < 0.0


def test_the_canal_is_outside_even_where_nothing_joins_it_to_the_rest() -> None:
    # A block as high as the grid, with a through canal: it has side walls only.
    block = trimesh.creation.box(extents=(60.0, 60.0, 200.0))
    canal = trimesh.creation.cylinder(radius=8.0, height=400.0, sections=64)
    bone = together(
        Surface(vertices_mm=block.vertices, faces=block.faces),
        Surface(vertices_mm=canal.vertices, faces=canal.faces[:, ::-1]),
    )
    channel = Channel(
        name="L3 left",
        entry_in_vertebra_mm=np.array([15.0, 30.0, 0.0]),
        target_in_vertebra_mm=np.array([15.0, -20.0, 0.0]),
        radius_mm=3.0,
    )
    field = bone_distance_field(bone, channel, step_mm=0.8)
    distance, _ = field.distances_mm(np.array([[3.0, 0.0, 0.0], [9.0, 0.0, 2.0], [7.0, 0.0, -3.0]]))
    np.testing.assert_allclose(distance, [5.0, -1.0, 1.0], atol=0.06)


def test_near_the_rehearsed_pedicle_s_wall_the_distance_is_true_to_a_tenth() -> None:
    channel = pedicle_channels()[0]
    field = bone_distance_field(vertebra_surface(), channel, margin_mm=15.0)
    # From points inside, perpendicular to the wall: the bone's implicit shape gives the crossing.
    along = np.linspace(12.0, 30.0, 10)[:, None] * channel.axis_in_vertebra
    centre = channel.entry_in_vertebra_mm + along
    _, gradient = field.distances_mm(centre + np.array([2.5, 0.0, 0.5]))
    way = gradient / np.linalg.norm(gradient, axis=1, keepdims=True)
    steps = np.arange(0.0, 9.0, 0.01)
    line = centre[:, None] + np.array([2.5, 0.0, 0.5]) + steps[:, None] * way[:, None]
    wall = line[np.arange(10), (bone_field(line) > 0.0).argmax(axis=1)]
    # The mesh itself is up to some hundredths off that shape.
    assert np.abs(field.distances_mm(wall)[0]).max() < 0.12


def test_a_field_is_small_read_only_and_goes_through_a_pipe(solid_rod: WallDistanceField) -> None:
    sent = pickle.dumps(solid_rod)
    assert len(sent) < 2 * solid_rod.values.size + 200_000
    received = pickle.loads(sent)  # noqa: S301  # our own bytes
    np.testing.assert_array_equal(received.values, solid_rod.values)
    # Writable arrays would make the kernels compile again, in theatre.
    for field in (solid_rod, received):
        for array in (field.values, field.grid.origin_mm, field.posterior.floor_mm):
            assert not array.flags.writeable


@pytest.mark.parametrize(
    "surface",
    [
        pytest.param(Surface(vertices_mm=rod().vertices_mm / 1000.0, faces=rod().faces), id="in-metres"),
        pytest.param(Surface(vertices_mm=rod().vertices_mm + 300.0, faces=rod().faces), id="elsewhere"),
    ],
)
def test_a_surface_that_is_not_at_the_channel_is_rejected(surface: Surface) -> None:
    with pytest.raises(PlanError) as caught:
        bone_distance_field(surface, ROD_CHANNEL, margin_mm=15.0)
    assert caught.value.code == "BONE_NOT_AT_CHANNEL"


def test_a_surface_that_is_wound_inside_out_is_rejected() -> None:
    with pytest.raises(PlanError) as caught:
        bone_distance_field(rod(turned_inside_out=True), ROD_CHANNEL, margin_mm=15.0)
    assert caught.value.code == "BONE_INSIDE_OUT"


def test_a_channel_as_long_as_a_patient_is_rejected() -> None:
    channel = Channel(
        name="x", entry_in_vertebra_mm=np.zeros(3), target_in_vertebra_mm=np.full(3, 900.0), radius_mm=3.0
    )
    with pytest.raises(PlanError) as caught:
        bone_distance_field(rod(), channel)
    assert caught.value.code == "FIELD_TOO_LARGE"


def test_where_only_the_channel_is_known_it_is_the_wall() -> None:
    field = channel_distance_field(ROD_CHANNEL)
    assert field.against is WallSource.CHANNEL
    distance, _ = field.distances_mm(np.array([[1.0, 0.0, 0.0], [0.0, -10.0, 6.0], [4.5, 25.0, 0.0]]))
    np.testing.assert_allclose(distance, [-3.0, 2.0, -4.5], atol=0.06)
