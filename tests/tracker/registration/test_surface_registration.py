"""Surface-based registration: sweeps with known truth, and insufficient sweeps."""

import numpy as np
import pytest
from scipy.special import chdtri

from tests.tracker.registration.constellations import VERTEBRA
from tests.tracker.registration.sweeps import (
    SweepTruth,
    closest_points_on_vertebra,
    corners_from_behind,
    plate,
    sweep_over,
    vertebra,
)
from tracker.errors import RegistrationError
from tracker.geometry import rotation_from_vector
from tracker.plan import Surface
from tracker.registration import AnchoredTo, Method
from tracker.registration.points import PointPairs
from tracker.registration.surface import (
    ClosestPointQuery,
    SurfaceGate,
    SurfaceRegistration,
    SurfaceSettings,
    principal_extents_mm,
    register_surface,
)
from tracker.registration.surface.closest_points import closest_points_on_triangles

TARGET = np.array([15.0, 10.0, 5.0])


def laid(truth: SweepTruth, settings: SurfaceSettings | None = None) -> SurfaceRegistration:
    return register_surface(
        closest_points_on_vertebra(), truth.moving_mm, truth.start, targets_mm=[TARGET], settings=settings
    )


def off_at_target(found: SurfaceRegistration, truth: SweepTruth) -> np.ndarray:
    tip = truth.fixed_from_moving.inverse.move_points(TARGET)
    return np.asarray(found.fixed_from_moving.move_points(tip) - TARGET)


def rejected(
    surface: Surface, truth: SweepTruth, *, landmarks: PointPairs | None = None
) -> RegistrationError:
    with pytest.raises(RegistrationError) as caught:
        register_surface(
            ClosestPointQuery(surface), truth.moving_mm, truth.start, targets_mm=[TARGET], landmarks=landmarks
        )
    return caught.value


def test_an_exact_sweep_comes_to_lie_where_it_was_made() -> None:
    truth = sweep_over(corners_from_behind(), np.random.default_rng(1), sd_mm=0.0, count=60)
    found = laid(truth)
    assert np.linalg.norm(off_at_target(found, truth)) < 0.01
    assert found.rms_mm < 0.01
    assert found.used_ratio == 1.0
    assert found.moved_mm == pytest.approx(2.0, abs=0.2)
    assert found.moved_deg == pytest.approx(2.5, abs=0.2)


def test_the_stated_uncertainty_holds_the_truth() -> None:
    rng, inside, off, stated, expected = np.random.default_rng(2), [], [], [], []
    for _ in range(6):
        truth = sweep_over(corners_from_behind(), rng)
        found = laid(truth)
        error, covariance = off_at_target(found, truth), found.target_covariance_mm2(TARGET)
        inside.append(bool(error @ np.linalg.solve(covariance, error) < chdtri(3, 0.05)))
        off.append(float(error @ error))
        stated.append(found.tre_stated_mm(TARGET))
        expected.append(found.tre_expected_mm(TARGET))
    assert sum(inside) >= 5
    assert 0.5 < np.mean(stated) / np.sqrt(np.mean(off)) < 2.0
    assert 0.7 < np.mean(expected) / np.sqrt(np.mean(off)) < 1.5


def test_below_the_floor_of_the_noise_only_the_expected_error_follows_the_residuals() -> None:
    found = laid(sweep_over(corners_from_behind(), np.random.default_rng(8), sd_mm=0.1, count=60))
    assert found.tre_expected_mm(TARGET) < 0.5 * found.tre_stated_mm(TARGET)


def test_a_third_of_outliers_does_not_pull() -> None:
    rng = np.random.default_rng(3)
    truth = sweep_over(corners_from_behind(), rng, count=60, sd_mm=0.2)
    moving = truth.moving_mm.copy()
    moving[:15] += rng.uniform(3.0, 8.0, (15, 3))
    found = register_surface(closest_points_on_vertebra(), moving, truth.start, targets_mm=[TARGET])
    assert np.linalg.norm(off_at_target(found, truth)) < 0.5
    assert 0.6 < found.used_ratio < 0.9


def test_the_ball_at_the_tip_is_taken_off() -> None:
    truth = sweep_over(corners_from_behind(), np.random.default_rng(4), count=60, sd_mm=0.05, lifted_mm=1.5)
    found = laid(truth, SurfaceSettings(tip_radius_mm=1.5))
    assert np.linalg.norm(off_at_target(found, truth)) < 0.25
    bare = laid(truth)
    assert np.linalg.norm(off_at_target(bare, truth)) > 0.6


def test_a_place_that_was_dwelt_upon_counts_once() -> None:
    rng = np.random.default_rng(5)
    truth = sweep_over(corners_from_behind(), rng, count=40, sd_mm=0.2)
    dwelt = np.vstack([truth.moving_mm, truth.moving_mm[:1] + 0.05 * rng.normal(size=(200, 3))])
    once = laid(truth)
    often = register_surface(closest_points_on_vertebra(), dwelt, truth.start, targets_mm=[TARGET])
    apart = np.linalg.norm(off_at_target(once, truth) - off_at_target(often, truth))
    assert apart < 0.15
    assert often.tre_stated_mm(TARGET) > 0.8 * once.tre_stated_mm(TARGET)


@pytest.mark.parametrize("bumps_mm", [0.0, 0.15])
def test_a_flat_bone_slides_with_and_without_the_bumps_of_its_mesh(bumps_mm: float) -> None:
    surface = plate(step_mm=1.5, bumps_mm=bumps_mm)
    corners = surface.vertices_mm[surface.faces]
    inner = corners[(np.abs(corners.mean(axis=1)) < 18.0).all(axis=1)]
    truth = sweep_over(inner, np.random.default_rng(6), sd_mm=0.1, off_mm=0.5, off_deg=0.5)
    error = rejected(surface, truth)
    assert error.code == "SURFACE_SLIDES"
    assert error.context["direction"] in {
        "to the left or right",
        "along the spine (to head or feet)",
        "tilting to the side (about the front-back axis)",
    }


def test_a_trough_along_the_spine_slides_along_the_spine() -> None:
    turn = np.linspace(0.2, np.pi - 0.2, 30)
    z = np.linspace(-40.0, 40.0, 30)
    ring = np.column_stack([15.0 * np.cos(turn), 9.0 * np.sin(turn)])
    vertices = np.array([[x, y, height] for height in z for x, y in ring])
    cells = [row * 30 + column for row in range(29) for column in range(29)]
    faces = np.array([face for a in cells for face in ((a, a + 30, a + 1), (a + 1, a + 30, a + 31))])
    surface = Surface(vertices_mm=vertices, faces=faces)
    corners = vertices[faces]
    inner = corners[np.abs(corners.mean(axis=1)[:, 2]) < 20.0]
    truth = sweep_over(inner, np.random.default_rng(7), sd_mm=0.1, off_mm=0.5, off_deg=0.5)
    assert rejected(surface, truth).context["direction"] == "along the spine (to head or feet)"


def test_landmarks_hold_what_slides_and_that_is_reported() -> None:
    surface = plate()
    corners = surface.vertices_mm[surface.faces]
    inner = corners[(np.abs(corners.mean(axis=1)) < 18.0).all(axis=1)]
    truth = sweep_over(inner, np.random.default_rng(8), sd_mm=0.1, off_mm=0.5, off_deg=0.5)
    pairs = PointPairs(fixed_mm=VERTEBRA, moving_mm=truth.fixed_from_moving.inverse.move_points(VERTEBRA))
    found = register_surface(
        ClosestPointQuery(surface), truth.moving_mm, truth.start, targets_mm=[TARGET], landmarks=pairs
    )
    assert [one.code for one in found.remarks] == ["SURFACE_CONSTRAINED_BY_LANDMARKS"]
    assert np.linalg.norm(off_at_target(found, truth)) < 0.1


def test_a_patch_of_one_lamina_is_not_believed() -> None:
    middles = corners_from_behind().mean(axis=1)
    patch = corners_from_behind()[np.linalg.norm(middles - middles[700], axis=1) < 9.0]
    truth = sweep_over(patch, np.random.default_rng(9), sd_mm=0.2)
    assert rejected(vertebra(), truth).code in {"SURFACE_SLIDES", "SURFACE_AMBIGUOUS", "SURFACE_SWEEP_SMALL"}


@pytest.mark.parametrize(
    ("points", "code"),
    [
        pytest.param(np.zeros((0, 3)), "SURFACE_SWEEP_SMALL", id="none"),
        pytest.param(np.zeros((500, 3)), "SURFACE_SWEEP_SMALL", id="all-in-one-place"),
        pytest.param(VERTEBRA, "SURFACE_SWEEP_SMALL", id="few"),
        pytest.param(np.full((30, 3), np.nan), "SURFACE_SWEEP_INVALID", id="not-numbers"),
        pytest.param(np.zeros((30, 2)), "SURFACE_SWEEP_INVALID", id="flat"),
    ],
)
def test_what_is_no_sweep_is_rejected(points: np.ndarray, code: str) -> None:
    truth = sweep_over(corners_from_behind(), np.random.default_rng(10))
    with pytest.raises(RegistrationError) as caught:
        register_surface(closest_points_on_vertebra(), points, truth.start)
    assert caught.value.code == code


def test_a_start_that_is_far_is_rejected() -> None:
    truth = sweep_over(corners_from_behind(), np.random.default_rng(11), off_mm=60.0)
    assert rejected(vertebra(), truth).code == "SURFACE_START_FAR"


def test_a_sweep_that_mostly_left_the_bone_is_rejected() -> None:
    rng = np.random.default_rng(12)
    truth = sweep_over(corners_from_behind(), rng, sd_mm=0.1, count=60)
    moving = truth.moving_mm + rng.uniform(-12.0, 12.0, (60, 3)) * (np.arange(60) % 4 > 0)[:, None]
    found: RegistrationError | tuple[RegistrationError, ...]
    try:
        found = register_surface(
            closest_points_on_vertebra(), moving, truth.start, targets_mm=[TARGET]
        ).failures(SurfaceGate(), [TARGET])
    except RegistrationError as error:
        found = error
    assert found


def test_the_gate_names_what_is_too_large() -> None:
    truth = sweep_over(corners_from_behind(), np.random.default_rng(14))
    found = laid(truth)
    assert found.failures(SurfaceGate(), [TARGET]) == ()
    gate = SurfaceGate(max_rms_mm=0.01, max_tre_mm=0.01, max_moved_mm=0.01)
    assert [error.code for error in found.failures(gate, [TARGET])] == [
        "SURFACE_FIT_TOO_LARGE",
        "SURFACE_TARGET_UNCERTAIN",
        "SURFACE_MOVED_FAR",
    ]
    used = found.registration(AnchoredTo.CAMERA)
    assert used.method is Method.SURFACE
    assert np.trace(used.point_covariance_mm2(TARGET)) == pytest.approx(found.tre_stated_mm(TARGET) ** 2)


def test_nearest_points_are_the_nearest_of_all_triangles() -> None:
    rng = np.random.default_rng(15)
    # Triangles of all sizes, in which the nearest middle is often not the nearest triangle.
    corners = rng.uniform(-40.0, 40.0, (60, 1, 3)) + rng.uniform(-1.0, 1.0, (60, 3, 3)) * rng.uniform(
        1, 40, (60, 1, 1)
    )
    surface = Surface(vertices_mm=corners.reshape(-1, 3), faces=np.arange(180).reshape(-1, 3))
    points = rng.uniform(-60.0, 60.0, (200, 3))
    found = np.linalg.norm(ClosestPointQuery(surface).at(points).points_mm - points, axis=1)
    every = closest_points_on_triangles(points[:, None], corners[None])
    assert np.allclose(found, np.linalg.norm(every - points[:, None], axis=2).min(axis=1))
    # No point of a triangle's own grid is nearer than what is called its nearest.
    shares = rng.dirichlet([0.5, 0.5, 0.5], 3000)
    sampled = np.einsum("sk,nkj->nsj", shares, corners)
    grid = np.linalg.norm(sampled[None] - points[:20, None, None], axis=3).min(axis=(1, 2))
    assert (found[:20] <= grid + 1e-9).all()
    assert (grid - found[:20]).max() < 3.0


def test_the_extents_of_a_sweep_are_those_of_its_box_in_any_pose() -> None:
    corners = np.array(np.meshgrid([0.0, 30.0], [0.0, 12.0], [0.0, 4.0])).reshape(3, -1).T
    turned = corners @ rotation_from_vector([0.4, -1.1, 0.7]).T + [7.0, -90.0, 400.0]
    np.testing.assert_allclose(principal_extents_mm(turned), (30.0, 12.0, 4.0), atol=1e-9)
    np.testing.assert_allclose(principal_extents_mm(turned[:2]), (np.ptp(corners[:2]), 0.0, 0.0), atol=1e-9)
    assert principal_extents_mm(turned[:1]) == (0.0, 0.0, 0.0)
