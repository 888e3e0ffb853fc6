"""Edges: edgels on known steps, chains with the dark side on the right, straight segments."""

import cv2
import numpy as np
import numpy.typing as npt
import pytest

from tests.tracker.scenes import Image8
from tracker.edges import (
    Edgels,
    chains_of,
    edgels_of,
    gradient_of,
    joined_segments,
    segments_of,
)
from tracker.edges.edge_detection import MAX_THRESHOLD, MIN_THRESHOLD, SOBEL_GAIN
from tracker.edges.edge_kernels import crossing

FINE = 8
SIDE_PX = 80
Floats = npt.NDArray[np.float64]


def _area_sampled(bright: npt.NDArray[np.bool_], *, blur_px: float = 0.8) -> Image8:
    """Average 8 x 8 samples per pixel, blur and round, as a camera does."""
    height, width = bright.shape[0] // FINE, bright.shape[1] // FINE
    mean = bright.reshape(height, FINE, width, FINE).mean(axis=(1, 3)) * 160.0 + 40.0
    return np.asarray(np.rint(cv2.GaussianBlur(mean, (0, 0), blur_px)), dtype=np.uint8)


def _samples(side_px: int = SIDE_PX) -> tuple[Floats, Floats]:
    """Return the pixel coordinates of the sample centres; (0, 0) is the centre of the first pixel."""
    at = (np.arange(side_px * FINE) + 0.5) / FINE - 0.5
    u, v = np.meshgrid(at, at)
    return u, v


def _step(angle_deg: float, offset_px: float) -> tuple[Image8, Floats]:
    """Return a step edge: angle of the normal, dark to bright, and `offset_px` from the image centre."""
    normal = np.array([np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))])
    u, v = _samples()
    middle = (SIDE_PX - 1) / 2
    return _area_sampled((u - middle) * normal[0] + (v - middle) * normal[1] > offset_px), normal


def _away_from_border(edgels: Edgels, margin_px: float = 6.0) -> npt.NDArray[np.bool_]:
    inside = (edgels.x > margin_px) & (edgels.x < SIDE_PX - 1 - margin_px)
    return np.asarray(inside & (edgels.y > margin_px) & (edgels.y < SIDE_PX - 1 - margin_px))


@pytest.mark.parametrize("angle_deg", [0, 7, 20, 45, 70, 90, 135, 180, 200, 225, 290, 333])
@pytest.mark.parametrize("offset_px", [0.0, 0.25, 0.375, -0.25])
def test_edgels_lie_on_the_step_and_point_from_dark_to_bright(angle_deg: float, offset_px: float) -> None:
    """A half-pixel shift, swapped axes or a wrong sign would exceed a tenth of a pixel."""
    image, normal = _step(angle_deg, offset_px)
    edgels = edgels_of(gradient_of(image))
    retained = _away_from_border(edgels)
    assert retained.sum() > 50
    middle = (SIDE_PX - 1) / 2
    off = (edgels.x - middle) * normal[0] + (edgels.y - middle) * normal[1] - offset_px
    assert np.abs(off[retained]).max() < 0.1
    # A parabola through three samples of a blurred step is off by up to 0.04 px between two pixels.
    assert abs(off[retained].mean()) < 0.05
    along = edgels.nx * normal[0] + edgels.ny * normal[1]
    assert along[retained].min() > np.cos(np.radians(4.0))


def test_the_strength_of_a_sharp_step_is_four_times_its_height() -> None:
    image = np.full((40, 40), 50, np.uint8)
    image[:, 20:] = 150
    edgels = edgels_of(gradient_of(image))
    np.testing.assert_allclose(edgels.strength, SOBEL_GAIN * 100.0)
    np.testing.assert_allclose(edgels.x, 19.5)


def test_the_index_image_refers_to_each_edgel() -> None:
    image, _ = _step(30, 0.2)
    edgels = edgels_of(gradient_of(image))
    for i in range(len(edgels.x)):
        v, u = np.argwhere(edgels.at == i)[0]
        assert abs(edgels.x[i] - u) <= 0.5
        assert abs(edgels.y[i] - v) <= 0.5
    assert (edgels.at >= 0).sum() == len(edgels.x)


def test_a_uniform_image_has_no_edges() -> None:
    edgels = edgels_of(gradient_of(np.full((50, 60), 128, np.uint8)))
    chains = chains_of(edgels)
    assert len(edgels.x) == 0
    assert len(chains.closed) == 0
    assert segments_of(edgels, chains, min_length_px=4.0).shape == (0, 4)
    assert joined_segments(np.empty((0, 4), np.float32)).shape == (0, 4)


def test_the_threshold_follows_the_noise_between_its_limits() -> None:
    random = np.random.default_rng(4)
    even = np.full((240, 320), 120.0)
    thresholds = [
        gradient_of(np.asarray(np.clip(even + random.normal(0, sd, even.shape), 0, 255), np.uint8)).threshold
        for sd in (0.0, 3.0, 6.0, 60.0)
    ]
    assert thresholds[0] == MIN_THRESHOLD
    # Sobel makes sqrt(12) sd of the noise; the median of its magnitude is 1.18 of that, and three are taken.
    assert thresholds[1] == pytest.approx(3 * 1.18 * np.sqrt(12) * 3.0, rel=0.1)
    assert thresholds[2] == pytest.approx(2 * thresholds[1], rel=0.1)
    assert thresholds[3] == MAX_THRESHOLD


def test_pure_noise_yields_few_edgels_and_fewer_segments() -> None:
    random = np.random.default_rng(9)
    image = np.asarray(np.clip(120 + random.normal(0, 5.0, (240, 320)), 0, 255), np.uint8)
    edgels = edgels_of(gradient_of(image))
    assert len(edgels.x) < image.size / 300
    assert len(segments_of(edgels, chains_of(edgels), min_length_px=8.0)) == 0


def test_a_step_of_opposite_polarity_has_opposite_normals() -> None:
    image, _ = _step(20, 0.0)
    one, other = edgels_of(gradient_of(image)), edgels_of(gradient_of(np.asarray(240 - image, np.uint8)))
    np.testing.assert_allclose(one.x[_away_from_border(one)].mean(), other.x[_away_from_border(other)].mean())
    np.testing.assert_allclose(one.nx.mean(), -other.nx.mean(), atol=0.02)


def _dark_square(side_px: float, rotation_deg: float, *, bright: bool = False) -> tuple[Image8, Floats]:
    """A dark square in the middle of the image and its corners (4, 2), clockwise on the screen."""
    c, s = np.cos(np.radians(rotation_deg)), np.sin(np.radians(rotation_deg))
    u, v = _samples()
    middle = (SIDE_PX - 1) / 2
    du, dv = u - middle, v - middle
    inside = np.maximum(np.abs(c * du + s * dv), np.abs(-s * du + c * dv)) < side_px / 2
    unit = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * side_px / 2
    return _area_sampled(inside if bright else ~inside), unit @ np.array([[c, s], [-s, c]]) + middle


def _area(points: Floats) -> float:
    """Positive when the points go clockwise on the screen (y down)."""
    x, y = points[:, 0], points[:, 1]
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


@pytest.mark.parametrize("rotation_deg", [0, 3, 12, 30, 44, 45, 60, 80, 89])
def test_a_dark_square_is_four_segments_clockwise_with_its_corners(rotation_deg: float) -> None:
    image, corners = _dark_square(40.0, rotation_deg)
    edgels = edgels_of(gradient_of(image))
    chains = chains_of(edgels)
    segments = segments_of(edgels, chains, min_length_px=6.0).astype(np.float64)
    assert segments.shape == (4, 4)
    starts, ends = segments[:, :2], segments[:, 2:]
    order = np.argsort(np.arctan2(*(starts.mean(axis=0) - starts).T[::-1]))
    assert _area(starts[order]) > 0
    for start, end in zip(starts, ends, strict=True):
        a = int(np.argmin(np.linalg.norm(corners - start, axis=1)))
        b = int(np.argmin(np.linalg.norm(corners - end, axis=1)))
        assert b == (a + 1) % 4
        side = corners[b] - corners[a]
        across = np.array([-side[1], side[0]]) / np.linalg.norm(side)
        assert abs(float((start - corners[a]) @ across)) < 0.1
        assert abs(float((end - corners[a]) @ across)) < 0.1
        assert np.linalg.norm(start - corners[a]) < 2.5
        assert np.linalg.norm(end - corners[b]) < 2.5


@pytest.mark.parametrize("rotation_deg", [7, 12, 30, 44, 45, 60, 80])
def test_the_outline_of_a_rotated_square_is_one_closed_chain(rotation_deg: float) -> None:
    """Along pixel rows a corner may split it; rotated, blur rounds the corner and the chain continues."""
    image, _ = _dark_square(40.0, rotation_deg)
    chains = chains_of(edgels_of(gradient_of(image)))
    assert chains.closed.tolist() == [True]
    # Four sides of 40 px, an edgel for each row or column that they cross.
    assert len(chains.order) > 105


def test_a_bright_square_is_traced_in_the_opposite_direction() -> None:
    image, _ = _dark_square(40.0, 10.0, bright=True)
    edgels = edgels_of(gradient_of(image))
    segments = segments_of(edgels, chains_of(edgels), min_length_px=6.0).astype(np.float64)
    turns = [
        (a[2] - a[0]) * (b[3] - b[1]) - (a[3] - a[1]) * (b[2] - b[0])
        for a in segments
        for b in segments
        if np.linalg.norm(a[2:] - b[:2]) < 6.0
    ]
    assert len(turns) == 4
    assert max(turns) < 0


@pytest.mark.parametrize("rotation_deg", range(0, 360, 30))
def test_the_dark_side_of_a_chain_is_on_its_right_hand(rotation_deg: float) -> None:
    image, normal = _step(rotation_deg, 0.1)
    edgels = edgels_of(gradient_of(image))
    segments = segments_of(edgels, chains_of(edgels), min_length_px=20.0)
    assert len(segments) >= 1
    for x0, y0, x1, y1 in segments.tolist():
        # On the screen (y down) the right hand of (dx, dy) is (-dy, dx).
        assert -(y1 - y0) * normal[0] + (x1 - x0) * normal[1] < 0


def test_a_chain_is_a_run_of_neighbours() -> None:
    image, _ = _dark_square(40.0, 20.0)
    edgels = edgels_of(gradient_of(image))
    chains = chains_of(edgels)
    assert chains.starts[0] == 0
    assert chains.starts[-1] == len(chains.order)
    assert len(set(chains.order.tolist())) == len(chains.order)
    run = chains.order
    jumps = np.hypot(np.diff(edgels.x[run]), np.diff(edgels.y[run]))
    assert jumps.max() < 2.5
    closing = np.hypot(edgels.x[run[-1]] - edgels.x[run[0]], edgels.y[run[-1]] - edgels.y[run[0]])
    assert closing < 2.5


def test_two_squares_side_by_side_are_two_chains() -> None:
    u, v = _samples()
    dark = np.zeros(u.shape, dtype=np.bool_)
    for left in (10, 44):
        dark |= (u > left) & (u < left + 26) & (v > 20) & (v < 50)
    edgels = edgels_of(gradient_of(_area_sampled(~dark)))
    chains = chains_of(edgels)
    assert chains.closed.tolist() == [True, True]
    assert segments_of(edgels, chains, min_length_px=6.0).shape == (8, 4)


@pytest.mark.parametrize(
    ("segments", "joined"),
    [
        pytest.param([[0, 10, 20, 10], [24, 10, 50, 10]], [[0, 10, 50, 10]], id="a gap of four pixels"),
        pytest.param([[24, 10, 50, 10], [0, 10, 20, 10]], [[0, 10, 50, 10]], id="in any order"),
        pytest.param(
            [[0, 10, 20, 10], [23, 10, 40, 10], [44, 10, 70, 10]], [[0, 10, 70, 10]], id="three in a row"
        ),
        pytest.param([[50, 10, 24, 10], [20, 10, 0, 10]], [[50, 10, 0, 10]], id="running to the left"),
        pytest.param([[0, 10, 20, 10], [40, 10, 60, 10]], [], id="a gap of twenty pixels"),
        pytest.param([[0, 10, 20, 10], [50, 10, 24, 10]], [], id="opposite directions"),
        pytest.param([[0, 10, 20, 10], [24, 15, 50, 15]], [], id="five pixels beside"),
        pytest.param([[0, 10, 20, 10], [22, 11, 22, 40]], [], id="round a corner"),
        pytest.param([[0, 10, 20, 10], [22, 10, 40, 20]], [], id="turned by thirty degrees"),
    ],
)
def test_collinear_segments_are_joined_and_others_are_not(
    segments: list[list[float]], joined: list[list[float]]
) -> None:
    out = joined_segments(np.array(segments, dtype=np.float32))
    np.testing.assert_allclose(out, np.array(joined, dtype=np.float32).reshape(-1, 4))


@pytest.mark.parametrize("offset_px", [-2.625, -1.0, -0.25, 0.0, 0.375, 1.75, 2.875])
@pytest.mark.parametrize("angle_deg", [0, 25, 130, 260])
def test_the_crossing_of_a_normal_is_the_distance_to_the_step(offset_px: float, angle_deg: float) -> None:
    image, normal = _step(angle_deg, offset_px)
    gradient = gradient_of(image)
    middle = (SIDE_PX - 1) / 2
    offset, response = crossing(gradient.x, gradient.y, middle, middle, normal[0], normal[1], 3.5)
    assert offset == pytest.approx(offset_px, abs=0.08)
    assert response > 150.0


def test_a_step_of_wrong_polarity_or_out_of_reach_or_image_is_not_found() -> None:
    image, normal = _step(0, 2.0)
    gradient = gradient_of(image)
    middle = (SIDE_PX - 1) / 2
    assert crossing(gradient.x, gradient.y, middle, middle, -normal[0], -normal[1], 3.5) == (0.0, 0.0)
    assert crossing(gradient.x, gradient.y, middle, middle, normal[0], normal[1], 1.5) == (0.0, 0.0)
    assert crossing(gradient.x, gradient.y, -50.0, middle, normal[0], normal[1], 3.5) == (0.0, 0.0)
    assert crossing(gradient.x, gradient.y, middle, 500.0, normal[0], normal[1], 3.5) == (0.0, 0.0)


def test_of_two_edges_the_nearer_is_the_expected_one() -> None:
    image = np.full((60, 60), 20, np.uint8)
    image[:, 30:35] = 120  # dark to bright between columns 29 and 30
    image[:, 35:] = 220  # and again between columns 34 and 35
    gradient = gradient_of(image)
    assert crossing(gradient.x, gradient.y, 30.0, 30.0, 1.0, 0.0, 6.0)[0] == pytest.approx(-0.5, abs=0.05)
    assert crossing(gradient.x, gradient.y, 34.0, 30.0, 1.0, 0.0, 6.0)[0] == pytest.approx(0.5, abs=0.05)


def test_pure_noise_of_full_contrast_does_not_overflow_the_edgel_buffer() -> None:
    """An unplugged analogue camera sends this. A buffer for half of the pixels was once overflowed."""
    image = np.random.default_rng(1).integers(0, 256, (360, 480)).astype(np.uint8)
    edgels = edgels_of(gradient_of(image))
    assert len(edgels.x) > image.size / 2
    chains = chains_of(edgels)
    assert len(chains.order) <= len(edgels.x)
    np.testing.assert_array_equal(np.sort(edgels.at[edgels.at >= 0]), np.arange(len(edgels.x)))
