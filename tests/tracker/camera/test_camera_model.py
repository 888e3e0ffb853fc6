"""The camera model: invalid parameters, and equality of the compiled lens with OpenCV's."""

import pickle
from collections.abc import Sequence

import cv2
import numpy as np
import pytest

from tests.tracker.scenes import STRAIGHT, camera_of
from tracker import CameraModel, InvalidInput
from tracker.camera.projection_kernels import project_with_derivative

K = ((800.0, 0.0, 320.0), (0.0, 790.0, 240.0), (0.0, 0.0, 1.0))
LENSES = {
    4: (-0.21, 0.07, 0.002, -0.001),
    5: (-0.21, 0.07, 0.002, -0.001, 0.03),
    8: (-0.21, 0.07, 0.002, -0.001, 0.03, 0.11, -0.05, 0.02),
    12: (-0.21, 0.07, 0.002, -0.001, 0.03, 0.11, -0.05, 0.02, 0.003, -0.002, 0.004, 0.001),
    14: (-0.21, 0.07, 0.002, -0.001, 0.03, 0.11, -0.05, 0.02, 0.003, -0.002, 0.004, 0.001, 0.06, -0.04),
}


def _with_entry(row: int, column: int, value: float) -> list[list[float]]:
    matrix = [list(line) for line in K]
    matrix[row][column] = value
    return matrix


@pytest.mark.parametrize(
    ("matrix", "distortion", "size", "says"),
    [
        pytest.param(np.eye(2), (), (640, 480), r"shape \(2, 2\)", id="matrix of two rows"),
        pytest.param(K, (0.1, 0.2, 0.3), (640, 480), "3 distortion coefficients", id="three coefficients"),
        pytest.param(K, np.zeros(15), (640, 480), "15 distortion coefficients", id="fifteen coefficients"),
        pytest.param(_with_entry(0, 0, np.nan), (), (640, 480), "not finite", id="focal length not a number"),
        pytest.param(K, (np.inf, 0, 0, 0), (640, 480), "not finite", id="infinite distortion"),
        pytest.param(K, (), (0, 480), "0x480 px", id="no width"),
        pytest.param(K, (), (640, 15), "640x15 px", id="fifteen rows"),
        pytest.param(_with_entry(0, 0, 0.0), (), (640, 480), "focal lengths are 0", id="focal length zero"),
        pytest.param(_with_entry(1, 1, -5.0), (), (640, 480), "and -5 px", id="focal length negative"),
        pytest.param(_with_entry(0, 0, 5.0), (), (640, 480), "at least 64 px", id="wider than any lens sees"),
        pytest.param(_with_entry(0, 2, 32e3), (), (640, 480), "49.5 image sizes", id="centre far outside"),
        pytest.param(_with_entry(0, 1, 0.5), (), (640, 480), "is not", id="skew"),
        pytest.param(_with_entry(1, 0, 0.5), (), (640, 480), "is not", id="below the diagonal"),
        pytest.param(_with_entry(2, 2, 2.0), (), (640, 480), "is not", id="last row not 0 0 1"),
        pytest.param(np.transpose(K), (), (640, 480), "is not", id="transposed"),
    ],
)
def test_numbers_that_no_camera_has_are_rejected(
    matrix: Sequence[Sequence[float]], distortion: Sequence[float], size: tuple[int, int], says: str
) -> None:
    with pytest.raises(InvalidInput, match=says) as caught:
        CameraModel(matrix=np.array(matrix), distortion=np.array(distortion), size_wh_px=size)
    assert caught.value.code == "CAMERA_MODEL_INVALID"
    assert caught.value.remedy.endswith(".")


def test_no_distortion_is_five_zeros_and_the_arrays_are_its_own() -> None:
    matrix = np.array(K)
    camera = CameraModel(matrix=matrix, distortion=np.array([]), size_wh_px=(640, 480))
    np.testing.assert_array_equal(camera.distortion, np.zeros(5))
    matrix[0, 0] = 1.0
    assert camera.matrix[0, 0] == 800.0
    with pytest.raises(ValueError, match="read-only"):
        camera.matrix[0, 0] = 1.0


GOOD: dict[str, object] = {
    "matrix": [list(row) for row in K],
    "distortion": list(LENSES[5]),
    "size_wh_px": [640, 480],
}


def test_a_camera_file_is_read_and_other_keys_are_let_be() -> None:
    camera = CameraModel.from_mapping(GOOD | {"rms_px": 0.2})
    np.testing.assert_array_equal(camera.matrix, K)
    np.testing.assert_array_equal(camera.distortion, LENSES[5])
    assert camera.size_wh_px == (640, 480)


@pytest.mark.parametrize(
    ("change", "code"),
    [
        pytest.param({"matrix": None}, "CAMERA_MODEL_INVALID", id="matrix is null"),
        pytest.param({"matrix": "K"}, "CAMERA_FILE_INVALID", id="matrix is a word"),
        pytest.param({"matrix": [[1, 2], [3]]}, "CAMERA_FILE_INVALID", id="rows of unequal length"),
        pytest.param({"distortion": ["a"]}, "CAMERA_FILE_INVALID", id="distortion is a word"),
        pytest.param({"size_wh_px": [640]}, "CAMERA_FILE_INVALID", id="one size"),
        pytest.param({"size_wh_px": [640, 480, 3]}, "CAMERA_FILE_INVALID", id="three sizes"),
        pytest.param({"size_wh_px": {"w": 640}}, "CAMERA_FILE_INVALID", id="size is a mapping"),
        pytest.param({"matrix": np.eye(4).tolist()}, "CAMERA_MODEL_INVALID", id="matrix is 4x4"),
    ],
)
def test_a_wrong_value_in_a_camera_file_is_an_error_with_a_code(change: dict[str, object], code: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        CameraModel.from_mapping(GOOD | change)
    assert caught.value.code == code


@pytest.mark.parametrize("key", ["matrix", "distortion", "size_wh_px"])
def test_a_missing_key_of_a_camera_file_is_named(key: str) -> None:
    with pytest.raises(InvalidInput, match=f"lacks {key}") as caught:
        CameraModel.from_mapping({k: v for k, v in GOOD.items() if k != key})
    assert caught.value.code == "CAMERA_FILE_INCOMPLETE"
    assert caught.value.context == {"missing": [key], "keys": key}


def _points() -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    random = np.random.default_rng(8)
    z = random.uniform(100, 700, 200)
    return np.column_stack([random.uniform(-0.4, 0.4, 200) * z, random.uniform(-0.3, 0.3, 200) * z, z])


@pytest.mark.parametrize("count", LENSES)
def test_the_compiled_lens_is_opencvs(count: int) -> None:
    camera = CameraModel(matrix=np.array(K), distortion=np.array(LENSES[count]), size_wh_px=(640, 480))
    lens, derivative = camera.lens, np.empty((2, 3))
    for point in _points():
        expected = cv2.projectPoints(
            point.reshape(1, 1, 3), np.zeros(3), np.zeros(3), camera.matrix, camera.distortion
        )[0].ravel()
        np.testing.assert_allclose(project_with_derivative(point, lens, derivative), expected, atol=1e-6)
        np.testing.assert_allclose(camera.px_from_camera(point)[0], expected, atol=1e-9)


@pytest.mark.parametrize("count", LENSES)
def test_its_derivative_is_that_of_finite_differences(count: int) -> None:
    camera = CameraModel(matrix=np.array(K), distortion=np.array(LENSES[count]), size_wh_px=(640, 480))
    lens, derivative = camera.lens, np.empty((2, 3))
    for point in _points()[:40]:
        project_with_derivative(point, lens, derivative)
        steps = np.eye(3) * 1e-3
        there = camera.px_from_camera(point + steps) - camera.px_from_camera(point - steps)
        np.testing.assert_allclose(derivative, there.T / 2e-3, atol=2e-6)


def test_without_a_lens_the_short_way_is_the_long_one() -> None:
    camera = CameraModel(matrix=np.array(K), distortion=np.zeros(8), size_wh_px=(640, 480))
    short, long = camera.lens, camera.lens.copy()
    assert short[25] == 1.0
    long[25] = 0.0
    derivatives = np.empty((2, 2, 3))
    for point in _points():
        pixel = project_with_derivative(point, short, derivatives[0])
        np.testing.assert_allclose(pixel, camera.px_from_camera(point)[0], atol=1e-9)
        np.testing.assert_allclose(pixel, project_with_derivative(point, long, derivatives[1]), atol=1e-9)
        np.testing.assert_allclose(derivatives[0], derivatives[1], atol=1e-9)


@pytest.mark.parametrize("count", LENSES)
def test_taking_the_lens_out_is_the_inverse(count: int) -> None:
    camera = CameraModel(matrix=np.array(K), distortion=np.array(LENSES[count]), size_wh_px=(640, 480))
    points = _points()
    points = points[np.abs(points[:, 0] / points[:, 2]) < 0.35]
    np.testing.assert_allclose(
        camera.normalised_from_px(camera.px_from_camera(points)), points[:, :2] / points[:, 2:], atol=1e-6
    )


def test_the_middle_of_the_top_left_pixel_is_zero_zero() -> None:
    """With the principal point at (2, 1) a ray along the axis lands in the middle of column 2, row 1."""
    matrix = np.array([[100.0, 0, 2.0], [0, 100.0, 1.0], [0, 0, 1]])
    camera = CameraModel(matrix=matrix, distortion=np.zeros(5), size_wh_px=(64, 48))
    np.testing.assert_allclose(camera.px_from_camera([[0, 0, 50.0], [1, 1, 50.0]]), [[2, 1], [4, 3]])


def test_the_lens_of_these_tests_bends() -> None:
    bent, straight = camera_of(), camera_of(distortion=STRAIGHT)
    corner = [[100.0, 80.0, 250.0]]
    assert np.linalg.norm(bent.px_from_camera(corner) - straight.px_from_camera(corner)) > 5.0


def test_a_camera_from_another_process_is_as_read_only_as_before() -> None:
    camera = CameraModel(matrix=np.array(K), distortion=np.array(LENSES[5]), size_wh_px=(640, 480))
    arrived = pickle.loads(pickle.dumps(camera))  # noqa: S301  our own bytes
    for name in ("matrix", "distortion", "lens"):
        np.testing.assert_array_equal(getattr(arrived, name), getattr(camera, name))
        assert not getattr(arrived, name).flags.writeable, name


def spot(size_wh_px: tuple[int, int], centre_px: np.ndarray) -> np.ndarray:
    """A bright Gaussian spot."""
    columns, rows = np.meshgrid(np.arange(size_wh_px[0]), np.arange(size_wh_px[1]))
    return np.asarray(np.exp(-((columns - centre_px[0]) ** 2 + (rows - centre_px[1]) ** 2) / (2 * 6.0**2)))


def centroid_px(image: np.ndarray) -> np.ndarray:
    columns, rows = np.meshgrid(np.arange(image.shape[1]), np.arange(image.shape[0]))
    return np.asarray([(columns * image).sum(), (rows * image).sum()]) / float(image.sum())


def test_a_scaled_camera_sees_a_point_where_joined_pixels_show_it() -> None:
    camera = camera_of((640, 480), distortion=[-0.2, 0.05, 0.001, -0.002, 0.0])
    point_mm = np.array([[60.0, -40.0, 500.0]])
    whole = spot((640, 480), camera.px_from_camera(point_mm)[0])
    for size_wh_px in ((320, 240), (160, 120)):
        joined = cv2.resize(whole, size_wh_px, interpolation=cv2.INTER_AREA)
        seen_px = camera.scaled_to(size_wh_px).px_from_camera(point_mm)[0]
        np.testing.assert_allclose(seen_px, centroid_px(joined), atol=0.01)
    back = camera.scaled_to((320, 240)).scaled_to((640, 480))
    np.testing.assert_allclose(back.matrix, camera.matrix)


@pytest.mark.parametrize("size_wh_px", [(640, 479), (480, 640), (1280, 720)])
def test_a_camera_is_not_scaled_to_another_shape(size_wh_px: tuple[int, int]) -> None:
    camera = camera_of((640, 480))
    assert not camera.has_aspect_of(size_wh_px)
    with pytest.raises(InvalidInput) as caught:
        camera.scaled_to(size_wh_px)
    assert caught.value.code == "CAMERA_ASPECT_DIFFERS"
    assert "640x480" in caught.value.message
