"""Dark regions: corners of dark squares on a bright ground, none of round or cut shapes."""

import cv2
import numpy as np
import numpy.typing as npt
import pytest

from tests.tracker.scenes import Image8, Print, camera_of, code_image, corners_px_of, facing_at_px, rendered
from tracker.geometry import Array
from tracker.regions import (
    border_segments,
    dark_mask,
    noise_grey,
    normalise_illumination,
    quads_of,
    regions_of_mask,
)

CAMERA = camera_of((320, 240), focal_px=400.0)


def _quads(image: Image8) -> npt.NDArray[np.float64]:
    return quads_of(regions_of_mask(dark_mask(image, window_px=21, darker_grey=8.0))).astype(np.float64)


def _nearest_px(quads: Array, corners: Array) -> float:
    off = [np.abs(np.roll(quads, k, axis=1) - corners).max(axis=(1, 2)).min() for k in range(4)]
    return float(min(off))


@pytest.mark.parametrize("darker_grey", [1.0, 3.0, 8.7])
@pytest.mark.parametrize("size_wh", [(64, 48), (33, 17), (5, 90)])
def test_the_mask_is_that_of_an_adaptive_threshold(darker_grey: float, size_wh: tuple[int, int]) -> None:
    image = np.random.default_rng(2).integers(0, 256, size_wh[::-1]).astype(np.uint8)
    for picture in (image, np.asarray(cv2.blur(image, (5, 5)), dtype=np.uint8)):
        expected = cv2.adaptiveThreshold(
            picture, 255, cv2.ADAPTIVE_THRESH_MEAN_C, cv2.THRESH_BINARY_INV, 21, darker_grey
        )
        np.testing.assert_array_equal(dark_mask(picture, window_px=21, darker_grey=darker_grey), expected)


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.95, 1.0])
@pytest.mark.parametrize("width", [1, 2, 31, 64])
def test_runs_are_the_mask_row_by_row(share: float, width: int) -> None:
    mask = np.where(np.random.default_rng(4).random((40, width)) < share, 255, 0).astype(np.uint8)
    regions = regions_of_mask(mask)
    again = np.zeros_like(mask)
    for row, first, last in zip(regions.row, regions.first, regions.last, strict=True):
        again[row, first : last + 1] = 255
    np.testing.assert_array_equal(again, mask)
    count, labels = cv2.connectedComponents(mask, connectivity=8)
    parents = labels[regions.row[regions.parent], regions.first[regions.parent]]
    np.testing.assert_array_equal(parents, labels[regions.row, regions.first])
    assert len(np.unique(regions.parent)) == count - 1


@pytest.mark.parametrize(
    ("roll_deg", "side_px", "tilt_deg", "blur_px"),
    [
        (0, 14, 0, 0.6),
        (30, 14, 0, 1.5),
        (15, 30, 50, 1.5),
        (60, 30, 50, 0.6),
        (45, 60, 20, 1.5),
        (75, 60, 20, 0.6),
        (0, 150, 40, 1.5),
        (30, 150, 40, 0.6),
    ],
)
def test_a_dark_square_has_its_corners(
    roll_deg: int, side_px: float, tilt_deg: float, blur_px: float
) -> None:
    pose = facing_at_px(CAMERA, (160.0, 120.0), side_px, tilt_deg=tilt_deg, roll_deg=roll_deg)
    image = rendered(CAMERA, [Print(picture=code_image(), pose=pose)], blur_px=blur_px)
    assert _nearest_px(_quads(image), corners_px_of(CAMERA, pose)) < max(1.3, 0.04 * side_px)


def test_its_middle_is_not_shifted() -> None:
    """The border lies half a pixel beyond the outermost dark pixel on all sides."""
    for roll_deg in range(0, 90, 30):
        pose = facing_at_px(CAMERA, (160.3, 119.6), 60, roll_deg=roll_deg)
        image = rendered(CAMERA, [Print(picture=code_image(), pose=pose)], noise_grey=0.5)
        corners = corners_px_of(CAMERA, pose)
        quads = _quads(image)
        best = min(quads, key=lambda quad: _nearest_px(quad[None], corners))
        assert np.abs(best.mean(axis=0) - corners.mean(axis=0)).max() < 0.35


def test_corners_are_clockwise_on_the_screen() -> None:
    pose = facing_at_px(CAMERA, (160.0, 120.0), 50, roll_deg=20)
    for quad in _quads(rendered(CAMERA, [Print(picture=code_image(), pose=pose)])):
        along, down = quad[1] - quad[0], quad[3] - quad[0]
        assert along[0] * down[1] - along[1] * down[0] > 0.0


@pytest.mark.parametrize(
    "shape",
    [
        pytest.param(lambda p: cv2.circle(p, (80, 60), 25, 30, -1), id="disc"),
        pytest.param(lambda p: cv2.line(p, (20, 20), (130, 90), 30, 2), id="line"),
        pytest.param(
            lambda p: cv2.fillPoly(p, [np.array([[80, 20], [110, 90], [50, 90]], np.int32)], 30),
            id="triangle",
        ),
        pytest.param(lambda p: cv2.rectangle(p, (-5, 40), (60, 90), 30, -1), id="cut by the image's border"),
        pytest.param(lambda p: p, id="nothing"),
    ],
)
def test_other_shapes_have_no_quad(shape: object) -> None:
    assert callable(shape)
    picture = np.asarray(shape(np.full((120, 160), 200, np.uint8)), dtype=np.uint8)
    soft = np.asarray(cv2.GaussianBlur(picture, (0, 0), 0.8), dtype=np.uint8)
    assert len(_quads(soft)) == 0


@pytest.mark.parametrize("noise", [0.0, 1.0, 3.0, 16.0])
def test_the_noise_is_measured(noise: float) -> None:
    random = np.random.default_rng(2)
    image = np.asarray(np.clip(np.rint(128 + random.normal(0, noise, (240, 320))), 0, 255), np.uint8)
    assert noise_grey(image) == pytest.approx(noise, rel=0.15, abs=0.3)


def test_illumination_normalisation_removes_a_shadow() -> None:
    """Ink and paper have the same contrast on both sides of a shadow of half intensity."""
    tile = np.kron(np.indices((12, 16)).sum(axis=0) % 2 * 160 + 40, np.ones((10, 10)))
    tile[:, 80:] *= 0.5
    even = normalise_illumination(tile.astype(np.uint8), window_px=41, noise_grey=0.0).astype(float)
    lit, in_shadow = even[30:90, 20:50], even[30:90, 110:140]
    for share in (10, 90):
        assert np.percentile(lit, share) == pytest.approx(np.percentile(in_shadow, share), rel=0.15)


@pytest.mark.parametrize("period_px", [1, 2, 3, 8])
def test_an_image_full_of_runs_fits_the_buffer(period_px: int) -> None:
    board = np.indices((91, 133)).sum(axis=0) // period_px % 2 * 255
    assert np.isfinite(quads_of(regions_of_mask(board.astype(np.uint8)))).all()
    assert np.isfinite(quads_of(regions_of_mask(np.full((91, 133), 255, np.uint8)))).all()
    assert len(quads_of(regions_of_mask(np.zeros((91, 133), np.uint8)))) == 0


def test_the_border_of_a_square_is_its_four_sides_with_the_dark_on_the_right_hand() -> None:
    mask = np.zeros((60, 80), np.uint8)
    mask[10:40, 20:60] = 255
    pieces = border_segments(regions_of_mask(mask))
    for start, end in (
        ((19.5, 9.5), (59.5, 9.5)),
        ((59.5, 9.5), (59.5, 39.5)),
        ((59.5, 39.5), (19.5, 39.5)),
        ((19.5, 39.5), (19.5, 9.5)),
    ):
        off = np.abs(pieces - np.array([*start, *end]))
        nearest = off[off.max(axis=1).argmin()]
        # Along it a corner may be rounded; across it stands between the pixels.
        across = [1, 3] if start[1] == end[1] else [0, 2]
        assert nearest.max() < 1.5
        assert nearest[across].max() < 0.3


def test_the_border_of_a_hole_has_the_opposite_direction() -> None:
    """A bright square in the dark is traced with the dark outside on the right."""
    mask = np.full((60, 80), 255, np.uint8)
    mask[10:40, 20:60] = 0
    pieces = border_segments(regions_of_mask(mask))
    assert np.abs(pieces - np.array([59.5, 9.5, 19.5, 9.5])).max(axis=1).min() < 1.5
    assert np.abs(pieces - np.array([19.5, 9.5, 59.5, 9.5])).max(axis=1).min() > 10.0


@pytest.mark.parametrize("roll_deg", range(0, 90, 15))
def test_a_slanted_border_is_one_segment(roll_deg: int) -> None:
    angle = np.radians(roll_deg)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    corners = np.array([[-30, -30], [30, -30], [30, 30], [-30, 30]]) @ turn.T + np.array([80.0, 60.0])
    mask = np.zeros((120, 160), np.uint8)
    cv2.fillPoly(mask, [np.rint(corners * 16).astype(np.int32)], 255, cv2.LINE_8, 4)
    pieces = border_segments(regions_of_mask(mask)).astype(np.float64)
    sides = np.hstack([corners, np.roll(corners, -1, axis=0)])
    for side in sides:
        assert np.abs(pieces - side).max(axis=1).min() < 3.0


def test_a_mask_of_specks_has_no_borders() -> None:
    mask = np.zeros((60, 80), np.uint8)
    mask[::4, ::4] = 255
    assert len(border_segments(regions_of_mask(mask))) == 0


def test_tracing_ends_where_two_regions_meet_at_a_corner() -> None:
    mask = np.zeros((80, 80), np.uint8)
    mask[10:40, 10:40] = 255
    mask[40:70, 40:70] = 255
    pieces = border_segments(regions_of_mask(mask))
    assert 8 <= len(pieces) <= 12
