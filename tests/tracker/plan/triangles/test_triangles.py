"""Mesh connectivity, and invariants of smoothing and decimation."""

import numpy as np
import numpy.typing as npt
import pytest

from tracker.plan.triangles import (
    connectivity_of,
    decimated,
    largest_part,
    referenced,
    smoothed,
    smoothed_values,
    vertex_normals,
)
from tracker.plan.triangles.connectivity import equal_rows

TETRAHEDRON = np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [0.0, 10.0, 0.0], [0.0, 0.0, 10.0]])
OUTWARDS = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def sheet(side: int = 12) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
    """A flat square of triangles 1 mm wide, far from the origin."""
    y, x = np.mgrid[:side, :side]
    vertices = np.stack([x.ravel() + 500.0, y.ravel() - 900.0, np.full(x.size, 1200.0)], axis=1)
    at = np.arange(side * side).reshape(side, side)
    a, b, c, d = (part.ravel() for part in (at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]))
    return vertices, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def test_a_tetrahedron_is_closed_and_a_sheet_is_not() -> None:
    assert connectivity_of(OUTWARDS).closed
    assert connectivity_of(OUTWARDS).edges.shape == (6, 2)
    open_sheet = connectivity_of(sheet()[1])
    assert not open_sheet.closed
    assert open_sheet.border_edges == 44
    assert open_sheet.border_vertices.size == 44


def test_one_flipped_triangle_is_detected() -> None:
    turned = OUTWARDS.copy()
    turned[3] = turned[3, ::-1]
    assert connectivity_of(turned).misoriented_edges == 3
    assert connectivity_of(turned).closed


def test_a_non_manifold_edge_is_detected() -> None:
    crowded = connectivity_of(np.concatenate([OUTWARDS, [[0, 1, 4]]]))
    assert crowded.non_manifold_edges == 1
    assert not crowded.closed


def test_the_largest_part_is_that_with_the_largest_area_not_the_most_triangles() -> None:
    vertices, faces = sheet()
    both = np.concatenate([vertices, 5.0 * TETRAHEDRON])
    count, retained = largest_part(both, np.concatenate([faces, OUTWARDS + vertices.shape[0]]))
    assert count == 2
    assert retained.tolist() == (OUTWARDS + vertices.shape[0]).tolist()
    points, renamed = referenced(both, retained)
    assert points == pytest.approx(5.0 * TETRAHEDRON)
    assert renamed.tolist() == OUTWARDS.tolist()


def test_smoothing_flattens_steps_and_leaves_a_border_where_it_is() -> None:
    vertices, faces = sheet()
    rough = vertices.copy()
    rough[:, 2] += np.where(np.arange(vertices.shape[0]) % 2, 0.2, -0.2)
    smooth = smoothed(rough, faces, rounds=20)
    border = connectivity_of(faces).border_vertices
    assert smooth[border] == pytest.approx(rough[border], abs=1e-9)
    inner = np.setdiff1d(np.arange(vertices.shape[0]), border)
    assert smooth[inner, 2].std() < 0.5 * rough[inner, 2].std()


def test_joining_triangles_keeps_a_sheet_flat_and_its_outline() -> None:
    vertices, faces = sheet(30)
    points, retained = decimated(vertices, faces, max_faces=200)
    assert retained.shape[0] <= 200
    assert points[:, 2] == pytest.approx(1200.0, abs=1e-6)
    assert points.min(axis=0) == pytest.approx(vertices.min(axis=0), abs=1e-6)
    assert points.max(axis=0) == pytest.approx(vertices.max(axis=0), abs=1e-6)


def test_few_enough_triangles_are_left_alone() -> None:
    assert decimated(TETRAHEDRON, OUTWARDS, max_faces=100)[1] is OUTWARDS


def test_equal_rows_are_found_as_numpy_does() -> None:
    rows = np.random.default_rng(1).integers(-2, 2, (200, 3)).astype(np.float64)
    first, group = equal_rows(rows)
    unique, inverse = np.unique(rows, axis=0, return_inverse=True)
    assert rows[first].tolist() == unique.tolist()
    assert group.tolist() == inverse.reshape(-1).tolist()


def test_normals_of_vertices_point_outwards_and_weigh_triangles_by_area() -> None:
    normals = vertex_normals(TETRAHEDRON, OUTWARDS)
    # Three equal triangles meet at the origin; the large one tilts the normal towards itself.
    np.testing.assert_allclose(normals[0], -np.ones(3) / np.sqrt(3.0))
    np.testing.assert_allclose(normals[1], [1.0, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(vertex_normals(*sheet()), np.tile([0.0, 0.0, 1.0], (144, 1)))


def test_an_uncertain_value_follows_its_neighbours_and_a_certain_one_stays() -> None:
    faces = sheet()[1]
    values, sd = np.full(144, 0.3), np.full(144, 0.05)
    values[66], sd[66] = 0.0, 1.0
    values[13], sd[13] = 1.0, 1e-4
    smooth = smoothed_values(values, sd, faces, step_sd=0.05)
    assert smooth[66] == pytest.approx(0.3, abs=0.02)
    assert smooth[13] == pytest.approx(1.0, abs=0.01)
    assert smooth[135] == pytest.approx(0.3, abs=0.02)
