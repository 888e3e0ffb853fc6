"""Proposed shapes satisfy the design rules and are reproducible by seed."""

import itertools
from collections.abc import Sequence

import cv2
import numpy as np
import pytest

from tracker.design import Patch, Shape, proposed_shapes, rendered_face, satisfies_rules
from tracker.marker import MarkerModel

BODY = ((0.17, 0.5), (0.45, 0.17), (0.83, 0.25), (0.8, 0.6), (0.5, 0.83))


def shape_of(*polygons: Sequence[tuple[float, float]], black: Sequence[int] = ()) -> Shape:
    return Shape(
        patches=tuple(
            Patch(corners=np.array(corners), white=k not in black) for k, corners in enumerate(polygons)
        )
    )


def first(seed: int, count: int = 5) -> list[Shape]:
    return list(itertools.islice(proposed_shapes(seed), count))


def pictures(shapes: list[Shape]) -> list[bytes]:
    return [rendered_face(shape, 64).tobytes() for shape in shapes]


def test_a_seed_gives_the_same_shapes_again_and_another_seed_others() -> None:
    assert pictures(first(4)) == pictures(first(4))
    assert not set(pictures(first(4))) & set(pictures(first(5)))


@pytest.mark.parametrize("seed", [1, 2])
def test_parts_of_a_proposed_marker_remain_visible_at_25_px(seed: int) -> None:
    for shape in first(seed, 4):
        picture = rendered_face(shape, 400)
        MarkerModel.from_image(picture, side_mm=25.0, name="proposed")
        small = cv2.resize(picture, (25, 25), interpolation=cv2.INTER_AREA)
        seen = cv2.GaussianBlur(small, (0, 0), 0.7)
        again = cv2.resize(seen, (400, 400), interpolation=cv2.INTER_CUBIC) > 127
        # What differs is corners and edges; a thin part that is gone would be more.
        assert (again != (picture > 127)).mean() < 0.02


@pytest.mark.parametrize(
    "shape",
    [
        pytest.param(
            shape_of(BODY, ((0.2, 0.47), (0.8, 0.53), (0.8, 0.58), (0.2, 0.52)), black=[1]), id="thin-gap"
        ),
        pytest.param(shape_of(((0.2, 0.3), (0.8, 0.5), (0.8, 0.57), (0.2, 0.37))), id="thin-bar"),
        pytest.param(shape_of(((0.17, 0.8), (0.5, 0.17), (0.62, 0.8))), id="spike"),
        pytest.param(
            shape_of(((0.25, 0.25), (0.75, 0.25), (0.75, 0.75), (0.25, 0.75))), id="two-directions-only"
        ),
        pytest.param(shape_of(tuple((x / 2 + 0.25, y / 2 + 0.25) for x, y in BODY)), id="little-white"),
        pytest.param(shape_of((*BODY[:1], (0.2, 0.42), *BODY[1:])), id="short-edge"),
        pytest.param(Shape(patches=()), id="nothing"),
    ],
)
def test_a_shape_that_blur_destroys_is_rejected(shape: Shape) -> None:
    assert not satisfies_rules(shape)


def test_a_shape_of_large_parts_satisfies_the_rules() -> None:
    assert satisfies_rules(shape_of(BODY))


def test_the_black_square_fills_the_picture_and_a_patch_lies_at_its_corners() -> None:
    picture = rendered_face(shape_of(((0.25, 0.5), (0.75, 0.5), (0.75, 0.75), (0.25, 0.75))), 400)
    white = np.argwhere(picture > 127)
    assert white.min(axis=0) == pytest.approx([200, 100], abs=1)
    assert white.max(axis=0) == pytest.approx([299, 299], abs=1)
    assert picture[:90].max() == picture[:, -90:].max() == 0
