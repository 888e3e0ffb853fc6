"""Rigid motions: group laws, rejections, and covariance carried to a point."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.errors import InvalidInput
from tracker.geometry import (
    Camera,
    Marker,
    Rigid,
    Tool,
    angle_between_deg,
    nearest_rotation,
    point_covariance_mm2,
    rotation_between,
    rotation_from_half_axes,
    rotation_from_vector,
    skew,
    vector_from_rotation,
)

Motion = Rigid[Camera, Camera]
numbers = st.floats(-3.0, 3.0, allow_subnormal=False)
vectors = st.tuples(numbers, numbers, numbers)
motions = st.builds(lambda turn, shift: Motion.from_vector(turn, np.array(shift) * 100.0), vectors, vectors)


@given(motions, motions, motions)
def test_products_are_associative(a: Motion, b: Motion, c: Motion) -> None:
    np.testing.assert_allclose(((a @ b) @ c).matrix, (a @ (b @ c)).matrix, atol=1e-9)


@given(motions)
def test_the_inverse_undoes_from_both_sides(a: Motion) -> None:
    np.testing.assert_allclose((a @ a.inverse).matrix, np.eye(4), atol=1e-9)
    np.testing.assert_allclose((a.inverse @ a).matrix, np.eye(4), atol=1e-9)


@given(motions, motions, vectors)
def test_a_product_moves_points_like_its_factors_one_after_the_other(
    a: Motion, b: Motion, point: tuple[float, float, float]
) -> None:
    np.testing.assert_allclose((a @ b).move_points(point), a.move_points(b.move_points(point)), atol=1e-9)
    np.testing.assert_allclose((a @ b).matrix, a.matrix @ b.matrix, atol=1e-9)


@given(motions, vectors, vectors)
def test_directions_are_differences_of_points(
    a: Motion, p: tuple[float, float, float], q: tuple[float, float, float]
) -> None:
    difference = a.move_points(q) - a.move_points(p)
    np.testing.assert_allclose(a.rotate_directions(np.subtract(q, p)), difference, atol=1e-9)


def test_a_quarter_turn_about_z_takes_x_to_y_and_then_shifts() -> None:
    a = Rigid[Camera, Marker].from_vector([0, 0, np.pi / 2], [10, 20, 30])
    np.testing.assert_allclose(a.move_points([1, 0, 0]), [10, 21, 30], atol=1e-12)
    np.testing.assert_allclose(a.rotate_directions([1, 0, 0]), [0, 1, 0], atol=1e-12)
    np.testing.assert_allclose(a.inverse.move_points([10, 21, 30]), [1, 0, 0], atol=1e-12)
    np.testing.assert_array_equal(Rigid.from_matrix(a.matrix).matrix, a.matrix)
    np.testing.assert_array_equal(Motion.identity().matrix, np.eye(4))


def test_a_stack_of_points_keeps_its_shape() -> None:
    a = Rigid[Camera, Marker].from_vector([0.1, 0.2, 0.3], [1, 2, 3])
    points = np.arange(24.0).reshape(2, 4, 3)
    moved = a.move_points(points)
    assert moved.shape == (2, 4, 3)
    np.testing.assert_allclose(moved[1, 2], a.rotation @ points[1, 2] + a.translation_mm)


@pytest.mark.parametrize(
    ("rotation", "translation"),
    [
        pytest.param(np.eye(3) * 1.01, np.zeros(3), id="scaled by one percent"),
        pytest.param(np.diag([1.0, 1.0, -1.0]), np.zeros(3), id="mirrored"),
        pytest.param(-np.eye(3), np.zeros(3), id="all axes turned round"),
        pytest.param(np.eye(3) + 0.01 * np.eye(3, k=1), np.zeros(3), id="sheared"),
        pytest.param(np.full((3, 3), np.nan), np.zeros(3), id="rotation not a number"),
        pytest.param(np.eye(3), np.array([0.0, np.nan, 0.0]), id="translation not a number"),
        pytest.param(np.eye(3), np.array([np.inf, 0.0, 0.0]), id="infinitely far"),
        pytest.param(np.zeros((3, 3)), np.zeros(3), id="all zero"),
    ],
)
def test_what_is_no_rigid_motion_is_rejected(
    rotation: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
    translation: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
) -> None:
    with pytest.raises(InvalidInput, match="not a rigid motion") as caught:
        Rigid(rotation=rotation, translation_mm=translation)
    assert caught.value.code == "ROTATION_INVALID"


def test_a_rotation_with_six_digits_is_taken() -> None:
    rotation = rotation_from_vector([0.3, -0.5, 1.1])
    taken: Motion = Rigid(rotation=np.round(rotation, 6), translation_mm=np.zeros(3))
    # Only the rounding error remains: it is the stored rotation.
    assert np.abs(taken.rotation - rotation).max() <= 0.5e-6
    assert vector_from_rotation(taken.rotation) == pytest.approx([0.3, -0.5, 1.1], abs=2e-6)
    with pytest.raises(InvalidInput):
        Rigid(rotation=np.round(rotation, 2), translation_mm=np.zeros(3))


def test_its_arrays_are_its_own_and_cannot_be_written() -> None:
    rotation, shift = np.eye(3), np.zeros(3)
    a: Motion = Rigid(rotation=rotation, translation_mm=shift)
    rotation[0, 0], shift[0] = 7.0, 7.0
    assert a.rotation[0, 0] == 1.0
    assert a.translation_mm[0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        a.rotation[0, 0] = 2.0
    with pytest.raises(ValueError, match="read-only"):
        a.translation_mm[0] = 2.0


@given(vectors)
def test_a_rotation_vector_comes_back_or_its_equal_of_less_than_half_a_turn(
    vector: tuple[float, float, float],
) -> None:
    rotation = rotation_from_vector(vector)
    back = vector_from_rotation(rotation)
    assert np.linalg.norm(back) <= np.pi + 1e-9
    np.testing.assert_allclose(rotation_from_vector(back), rotation, atol=1e-8)
    if np.linalg.norm(vector) < 3.0:
        np.testing.assert_allclose(back, vector, atol=1e-8)


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-9, 1e-6, 9e-5, 1.1e-4, 1e-3])
def test_a_small_rotation_vector_keeps_its_digits(angle: float) -> None:
    vector = np.array([0.6, 0.0, -0.8]) * angle
    np.testing.assert_allclose(vector_from_rotation(rotation_from_vector(vector)), vector, rtol=1e-9)


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (0.6, 0.8, 0), (-0.6, 0, 0.8), (2, -1, 2)])
@pytest.mark.parametrize("short_of_half_a_turn", [0.0, 1e-9, 1e-7, 1e-5])
def test_about_half_a_turn_the_axis_is_still_known(
    axis: tuple[float, float, float], short_of_half_a_turn: float
) -> None:
    unit = np.array(axis) / np.linalg.norm(axis)
    rotation = rotation_from_vector(unit * (np.pi - short_of_half_a_turn))
    back = vector_from_rotation(rotation)
    np.testing.assert_allclose(rotation_from_vector(back), rotation, atol=2e-7)
    assert np.linalg.norm(back) == pytest.approx(np.pi, abs=2e-5)


@given(vectors, vectors)
def test_skew_makes_the_cross_product(a: tuple[float, float, float], b: tuple[float, float, float]) -> None:
    np.testing.assert_allclose(skew(a) @ np.array(b), np.cross(a, b), atol=1e-12)
    np.testing.assert_array_equal(skew(a).T, -skew(a))


@given(vectors.filter(lambda v: np.linalg.norm(v) > 1e-3), vectors.filter(lambda v: np.linalg.norm(v) > 1e-3))
def test_the_rotation_between_two_directions_takes_one_to_the_other(
    a: tuple[float, float, float], b: tuple[float, float, float]
) -> None:
    rotation = rotation_between(a, b)
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-9)
    np.testing.assert_allclose(
        rotation @ np.array(a) / np.linalg.norm(a), np.array(b) / np.linalg.norm(b), atol=1e-6
    )
    turned_deg = np.degrees(np.linalg.norm(vector_from_rotation(rotation)))
    assert turned_deg == pytest.approx(angle_between_deg(a, b), abs=1e-4)


def test_a_rotation_that_rounding_has_bent_becomes_one_again() -> None:
    rotation = rotation_from_vector([0.3, -1.2, 0.7])
    bent = rotation + 1e-4 * np.array([[1.0, -2.0, 0.5], [0.3, 1.0, -1.0], [2.0, 0.2, -0.7]])
    straight = nearest_rotation(bent)
    np.testing.assert_allclose(straight @ straight.T, np.eye(3), atol=1e-14)
    assert np.linalg.det(straight) == pytest.approx(1.0)
    assert np.linalg.norm(straight - bent) < np.linalg.norm(rotation - bent)


@pytest.mark.parametrize("direction", [(0, 0, 1), (1, 0, 0), (1, -2, 3)])
def test_opposite_directions_are_half_a_turn_apart(direction: tuple[float, float, float]) -> None:
    rotation = rotation_between(direction, np.negative(direction))
    np.testing.assert_allclose(rotation @ np.array(direction), np.negative(direction), atol=1e-9)
    assert np.linalg.det(rotation) == pytest.approx(1.0)


@pytest.mark.parametrize("angle_deg", [1e-9, 1e-6, 0.001, 1.0, 45.0, 90.0, 179.0, 180.0 - 1e-6])
def test_angles_keep_their_digits_even_near_zero(angle_deg: float) -> None:
    turned = [np.sin(np.radians(angle_deg)), 0.0, np.cos(np.radians(angle_deg))]
    assert angle_between_deg([0, 0, 2.0], turned) == pytest.approx(angle_deg, rel=1e-7)


def test_the_covariance_of_a_point_is_that_of_many_shaken_poses() -> None:
    """A wrong sign of the lever arm, or a rotation multiplied from the right, is far outside 5 percent."""
    random = np.random.default_rng(3)
    pose = Rigid[Camera, Tool].from_vector([0.4, -1.1, 0.7], [30, -20, 400])
    spread = random.normal(size=(6, 6)) * np.array([0.2, 0.2, 0.5, 0.004, 0.004, 0.002])[:, None]
    covariance = spread @ spread.T
    point = np.array([3.0, -120.0, -10.0])
    shaken = random.multivariate_normal(np.zeros(6), covariance, size=40_000)
    arm = pose.rotate_directions(point)
    # Rodrigues to second order: the angles are under 2 degrees.
    turned = arm + np.cross(shaken[:, 3:], arm) + np.cross(shaken[:, 3:], np.cross(shaken[:, 3:], arm)) / 2
    measured = np.cov((turned + shaken[:, :3] + pose.translation_mm).T)
    stated = point_covariance_mm2(pose, covariance, point)
    assert np.abs(measured - stated).max() < 0.05 * np.abs(stated).max()


def test_a_turn_does_not_move_the_point_it_turns_about() -> None:
    pose = Rigid[Camera, Tool].from_vector([0.4, 0.0, 0.0], [0, 0, 400])
    only_turns = np.diag([0, 0, 0, 1e-4, 1e-4, 1e-4])
    np.testing.assert_array_equal(point_covariance_mm2(pose, only_turns, [0, 0, 0]), np.zeros((3, 3)))
    at_100_mm = point_covariance_mm2(Rigid[Camera, Tool].identity(), only_turns, [100, 0, 0])
    np.testing.assert_allclose(at_100_mm, np.diag([0.0, 1.0, 1.0]), atol=1e-12)


@given(vectors, st.sampled_from([(5.0, 2.0, 0.5), (5.0, 2.0, 0.0), (5.0, 0.0, 0.0), (0.0, 0.0, 0.0)]))
def test_a_rotation_takes_the_axes_to_the_half_axes_of_an_ellipsoid(
    turn: tuple[float, float, float], lengths: tuple[float, float, float]
) -> None:
    half_axes = np.diag(lengths) @ rotation_from_vector(turn).T
    rotation = rotation_from_half_axes(half_axes)
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(rotation) > 0.0
    # The shape is the same; the sign of a half axis is arbitrary.
    shape = rotation @ np.diag(np.square(lengths)) @ rotation.T
    np.testing.assert_allclose(shape, half_axes.T @ half_axes, atol=1e-9)
