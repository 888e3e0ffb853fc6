"""Score kernels against plain NumPy."""

import numpy as np
import pytest

from tests.tracker.scenes import Image8, camera_of, code_model, corners_px_of, facing, in_clutter
from tracker.edges import edgels_of, gradient_of
from tracker.geometry import Array
from tracker.marker import edge_crossings, model_agreement
from tracker.marker.score_kernels import count_matched_edgels, shift_corners
from tracker.pose.refinement import projected_edges

CAMERA = camera_of()
POSE = facing([15, -10, 260], tilt_deg=30, about_deg=40, roll_deg=25)
MODEL = code_model()
REACH_PX = 3.0


def _picture() -> Image8:
    image, corners = in_clutter(CAMERA, POSE, clutter=3, noise_grey=4.0)
    # A corner of the marker is covered, so that not all edges are found.
    corner = corners[2].astype(int)
    image[corner[1] - 12 : corner[1] + 12, corner[0] - 12 : corner[0] + 12] = 90
    return image


def test_agreement_matches_plain_sums() -> None:
    gradient, active = gradient_of(_picture()), MODEL.level_for(67.0)
    projected = projected_edges(CAMERA, POSE, active)
    assert projected is not None
    offset, response = edge_crossings(gradient, *projected, reach_px=2.68)
    answers = response > 0.0
    contrast = np.median(response[answers] / active.strength_ratio[answers])
    found = response >= np.maximum(0.6 * gradient.threshold, 0.35 * contrast * active.strength_ratio)
    assert 0.5 < found.mean() < 0.97
    length, inner = active.length_mm, active.inner
    agreement = model_agreement(gradient, active, *projected, side_px=67.0, shift_px=0.1)
    assert agreement.contrast == pytest.approx(contrast)
    assert agreement.model_coverage_ratio == pytest.approx(length[found].sum() / length.sum())
    assert agreement.inner_coverage_ratio == pytest.approx(length[found & inner].sum() / length[inner].sum())
    assert agreement.fit_error_px2 == pytest.approx(((offset[found] - 0.1) ** 2).mean())


@pytest.mark.parametrize("radius", [1.5, 3.0, 7.0])
def test_matched_edgels_equal_the_brute_force_count(radius: float) -> None:
    gradient, corners = gradient_of(_picture()), corners_px_of(CAMERA, POSE)
    edgels, projected = edgels_of(gradient), projected_edges(CAMERA, POSE, MODEL.level_for(67.0))
    assert projected is not None
    points, normals = projected
    along = np.roll(corners, -1, axis=0) - corners
    rows, columns = np.nonzero(edgels.at >= 0)
    index = edgels.at[rows, columns]
    at = np.stack([edgels.x, edgels.y], axis=1)[index].astype(np.float64)
    beyond = at[:, None] - corners[None]
    side = (along[:, 0] * beyond[..., 1] - along[:, 1] * beyond[..., 0]) / np.linalg.norm(along, axis=1)
    taken = index[(side >= -REACH_PX).all(axis=1) & (edgels.strength[index] >= 60.0)]
    x, y = edgels.x[taken, None] - points[:, 0], edgels.y[taken, None] - points[:, 1]
    is_same_direction = edgels.nx[taken, None] * normals[:, 0] + edgels.ny[taken, None] * normals[:, 1] > 0.5
    near = ((x * x + y * y <= radius * radius) & is_same_direction).any(axis=1)
    assert 0 < near.sum() < len(taken)
    counted = count_matched_edgels(
        edgels.at,
        edgels.x,
        edgels.y,
        edgels.nx,
        edgels.ny,
        edgels.strength,
        points,
        normals,
        corners,
        radius,
        REACH_PX,
        60.0,
    )
    assert counted == (near.sum(), len(taken))


def _shifted(active_offset: Array, usable: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]) -> Array:
    active = MODEL.level_for(67.0)
    corners, half = np.array([[-10.0, -10], [10, -10], [10, 10], [-10, 10]]), 12.5
    # Seen straight on: the image's rows run against the marker's y.
    normals = active.normals * [1.0, -1.0]
    moved = corners.copy()
    shift_corners(
        active.points_mm, active.normals, normals, usable, active_offset, half, 0.7 * half, 3.0, moved
    )
    return np.asarray(moved - corners)


def test_corners_move_to_the_adjacent_sides() -> None:
    """Every outline edge is placed where a shift (0.4, -0.3) and a small rotation would bring it."""
    active = MODEL.level_for(67.0)
    u, v = active.points_mm[:, 0], -active.points_mm[:, 1]
    motion = np.stack([0.4 - 0.02 * v, -0.3 + 0.02 * u], axis=1)
    offset = (motion * active.normals * [1.0, -1.0]).sum(axis=1)
    outline = ~active.inner & active.straight
    moved = _shifted(offset, outline)
    expected = np.array([[0.4 - 0.02 * b * 12.5, -0.3 + 0.02 * a * 12.5] for a, b in CORNERS])
    np.testing.assert_allclose(moved, expected, atol=0.02)
    # One outlier beside a corner changes nothing; without edgels a corner stays.
    wild = offset.copy()
    wild[np.flatnonzero(outline)[::9]] += 2.5
    np.testing.assert_allclose(_shifted(wild, outline), expected, atol=0.05)
    left = outline & (u > -5.0)
    moved = _shifted(offset, left)
    assert not moved[[0, 3]].any()
    assert moved[[1, 2]].all()


CORNERS = ((-1, -1), (1, -1), (1, 1), (-1, 1))
