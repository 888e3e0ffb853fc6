"""Marker model: rejected images, and the position of its active edges."""

from functools import cache

import cv2
import numpy as np
import pytest

from tests.tracker.scenes import CODE, Image8, code_image
from tracker import InvalidInput, MarkerModel
from tracker.marker import ActiveEdges, reject_mirror_symmetric
from tracker.marker.model import MAX_SYMMETRY
from tracker.rehearsal.marker_images import drill_marker_image

SIDE_MM = 40.0


def _grey(value: int, shape: tuple[int, ...] = (60, 60)) -> Image8:
    return np.full(shape, value, np.uint8)


def _with_margin() -> Image8:
    return np.pad(code_image(), 12, constant_values=255)


def _faint() -> Image8:
    return np.where(code_image() > 0, 139, 100).astype(np.uint8)


@pytest.mark.parametrize(
    ("picture", "says"),
    [
        pytest.param(_with_margin(), "0% of its border is dark", id="white margin"),
        pytest.param(np.asarray(255 - code_image(), np.uint8), "of its border is dark", id="negative"),
        pytest.param(code_image()[:, :90], "it is 90x120 px", id="not square"),
        pytest.param(_faint(), "its contrast is 39 grey levels, at least 40", id="low contrast"),
        pytest.param(_grey(0), "its contrast is 0", id="all black"),
        pytest.param(code_image()[::20, ::20], "it is 6x6 px, at least 8x8", id="six pixels wide"),
        pytest.param(_grey(0, (0, 0)), "it is 0x0 px", id="empty"),
        pytest.param(np.dstack([code_image()] * 3), "3 dimensions", id="in colour"),
        pytest.param(code_image().astype(np.float64), "float64", id="not 8 bits"),
    ],
)
def test_an_unusable_marker_image_is_rejected_with_numbers(picture: Image8, says: str) -> None:
    with pytest.raises(InvalidInput, match=says) as caught:
        MarkerModel.from_image(picture, side_mm=SIDE_MM, name="mine")
    assert caught.value.code == "MARKER_IMAGE_INVALID"
    assert "'mine'" in caught.value.message


@pytest.mark.parametrize("side_mm", [0.0, -1.0, float("nan"), float("inf")])
def test_an_invalid_side_is_rejected(side_mm: float) -> None:
    with pytest.raises(InvalidInput) as caught:
        MarkerModel.from_image(code_image(), side_mm=side_mm, name="mine")
    assert caught.value.code == "MARKER_SIDE_INVALID"


@pytest.mark.parametrize(
    ("fields", "turned_deg"),
    [
        pytest.param(((0, 1, 0), (1, 0, 1), (0, 1, 0)), 90, id="a cross: four tops"),
        pytest.param(((1, 1, 1), (1, 1, 1), (1, 1, 1)), 90, id="a square in the square"),
        pytest.param(((1, 0, 0), (0, 1, 0), (0, 0, 1)), 180, id="a diagonal: two tops"),
        pytest.param(((1, 1, 1), (0, 0, 0), (1, 1, 1)), 180, id="two bars"),
    ],
)
def test_a_rotationally_symmetric_shape_is_rejected(
    fields: tuple[tuple[int, ...], ...], turned_deg: int
) -> None:
    with pytest.raises(InvalidInput, match="looks the same when rotated") as caught:
        MarkerModel.from_image(code_image(fields), side_mm=SIDE_MM, name="mine")
    assert caught.value.code == "MARKER_SYMMETRIC"
    assert caught.value.context["turned_deg"] == turned_deg


def test_a_mirror_symmetric_shape_is_accepted() -> None:
    model = MarkerModel.from_image(
        code_image(((1, 1, 0), (0, 0, 1), (1, 1, 0))), side_mm=SIDE_MM, name="mine"
    )
    by_rotation, by_reflection = model.own_correlation
    assert by_rotation < MAX_SYMMETRY < by_reflection
    assert all(len(level.points_mm) > 0 for level in model.levels)


def test_a_mirror_symmetric_shape_is_rejected_where_a_reflection_can_be_in_view() -> None:
    arrow, other = (
        MarkerModel.from_image(code_image(fields), side_mm=SIDE_MM, name=name)
        for name, fields in (("arrow", ((1, 1, 0), (0, 0, 1), (1, 1, 0))), ("other", CODE))
    )
    reject_mirror_symmetric([other])
    with pytest.raises(InvalidInput, match="'arrow' is its own mirror image") as caught:
        reject_mirror_symmetric([other, arrow])
    assert caught.value.code == "MARKER_MIRROR_SYMMETRIC"


def test_corners_go_clockwise_from_the_top_left_with_y_up() -> None:
    model = MarkerModel.from_image(code_image(), side_mm=SIDE_MM, name="mine")
    np.testing.assert_array_equal(model.corners_mm, [[-20, 20, 0], [20, 20, 0], [20, -20, 0], [-20, -20, 0]])


def test_the_image_is_stored_as_a_copy() -> None:
    picture = code_image()
    model = MarkerModel.from_image(picture, side_mm=SIDE_MM, name="mine")
    np.testing.assert_array_equal(model.image, code_image())
    picture[:] = 0
    assert model.image.max() == 255


@cache
def _code() -> MarkerModel:
    """The code's model; computing its edges takes a third of a second."""
    return MarkerModel.from_image(code_image(), side_mm=SIDE_MM, name="mine")


@cache
def _drill() -> MarkerModel:
    return MarkerModel.from_image(drill_marker_image(), side_mm=25.0, name="drill")


@pytest.mark.parametrize("side_px", [12, 359, 500])
def test_any_image_size_gives_the_same_edges(side_px: int) -> None:
    picture = cv2.resize(code_image(field_px=100), (side_px, side_px), interpolation=cv2.INTER_AREA)
    model = MarkerModel.from_image(np.asarray(picture, np.uint8), side_mm=SIDE_MM, name="mine")
    for side in (24, 48, 136):
        assert model.level_for(side).length_mm.sum() == pytest.approx(
            _code().level_for(side).length_mm.sum(), rel=0.08
        )


# White fields of CODE as rectangles in mm: left, bottom, right, top. The fields are a sixth of the side.
FIELD_MM = SIDE_MM / 6.0


def _distance_to_true_edges_mm(points: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> float:
    """Return the largest distance of these points (n, 2) from the true edges of the code."""
    segments = []
    cells = np.pad(np.array(CODE), 1)
    for row in range(5):
        for column in range(5):
            x, y = (column - 2.5) * FIELD_MM, (2.5 - row) * FIELD_MM
            if column < 4 and cells[row, column] != cells[row, column + 1]:
                segments.append([x + FIELD_MM, y - FIELD_MM, x + FIELD_MM, y])
            if row < 4 and cells[row, column] != cells[row + 1, column]:
                segments.append([x, y - FIELD_MM, x + FIELD_MM, y - FIELD_MM])
    h = SIDE_MM / 2
    segments += [[-h, -h, h, -h], [-h, h, h, h], [-h, -h, -h, h], [h, -h, h, h]]
    away = []
    for x0, y0, x1, y1 in segments:
        nearest = np.clip(points, [min(x0, x1), min(y0, y1)], [max(x0, x1), max(y0, y1)])
        away.append(np.linalg.norm(points - nearest, axis=1))
    return float(np.min(away, axis=0).max())


LARGE = (48, 68, 96, 136, 192)


def _level(side_px: int) -> ActiveEdges:
    return _code().level_for(side_px)


@pytest.mark.parametrize("side_px", LARGE)
def test_straight_active_edges_lie_on_the_shape_as_it_was_drawn(side_px: int) -> None:
    """Half a pixel of the model's picture, or y down for up, would be over a hundredth of the side."""
    active = _level(side_px)
    assert _distance_to_true_edges_mm(active.points_mm[active.straight]) < 0.01 * SIDE_MM


@pytest.mark.parametrize("side_px", LARGE)
def test_their_length_is_that_of_the_shape(side_px: int) -> None:
    # The outline is 4 sides. Of the white fields two touch at a side, two at corners: 14 sixths.
    outline_mm, inside_mm = 4 * SIDE_MM, 14 * FIELD_MM
    active = _level(side_px)
    assert active.length_mm[~active.inner].sum() == pytest.approx(outline_mm, rel=0.08)
    assert active.length_mm[active.inner].sum() == pytest.approx(inside_mm, rel=0.15)


@pytest.mark.parametrize("side_px", [24, 34, *LARGE])
def test_the_outline_is_distinguished_from_inner_edges(side_px: int) -> None:
    active = _level(side_px)
    far = np.abs(active.points_mm).max(axis=1)
    assert far[~active.inner].min() > 0.46 * SIDE_MM
    assert far[active.inner].max() < 0.30 * SIDE_MM


@pytest.mark.parametrize("side_px", LARGE)
def test_their_normals_point_from_dark_to_bright(side_px: int) -> None:
    active = _level(side_px)
    np.testing.assert_allclose(np.linalg.norm(active.normals, axis=1), 1.0, atol=1e-5)
    outward = active.points_mm[~active.inner] / np.abs(active.points_mm[~active.inner]).max(axis=1)[:, None]
    assert ((outward * active.normals[~active.inner]).sum(axis=1) > 0.5).all()
    picture = code_image(field_px=60)
    inside = active.inner & active.straight
    for point, normal in zip(active.points_mm[inside], active.normals[inside], strict=True):
        x, y = point + normal * 0.03 * SIDE_MM
        row, column = int((0.5 - y / SIDE_MM) * 360), int((x / SIDE_MM + 0.5) * 360)
        assert picture[row, column] == 255


@pytest.mark.parametrize(
    ("side_px", "level_px"),
    [(1, 12), (12, 12), (14, 12), (15, 17), (30, 34), (60, 68), (192, 192), (900, 192)],
)
def test_the_level_is_that_of_the_nearest_size(side_px: float, level_px: int) -> None:
    assert _drill().level_for(side_px).level_px == level_px


def test_no_level_has_too_many_edgels_or_none() -> None:
    for level in _drill().levels:
        count = len(level.points_mm)
        assert 12 < count <= 360
        assert {len(level.normals), len(level.length_mm), len(level.inner), len(level.straight)} == {count}
        assert level.strength_ratio.min() >= 0.3
        assert level.strength_ratio.max() <= 1.0
