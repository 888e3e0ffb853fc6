"""Layers: where the drill's body is drawn, what occludes it, and compositing over an image."""

import numpy as np
import numpy.typing as npt
import pytest

from tracker.camera import CameraModel
from tracker.rehearsal.drill import PROFILE_MM, RADIUS_MM, drill_portrait
from tracker.rehearsal.layer_kernels import Axis, composite, draw_body
from tracker.rehearsal.lens import RayGrid

WIDTH, HEIGHT = 160, 320
CAMERA = CameraModel(
    matrix=np.array([[300.0, 0.0, 79.5], [0.0, 300.0, 159.5], [0.0, 0.0, 1.0]]),
    distortion=np.zeros(5),
    size_wh_px=(WIDTH, HEIGHT),
)
RAYS = RayGrid(CAMERA)
# From left to right and a little down, near the lower border, 1.5 px to a millimetre.
TIP_MM, BACK = np.array([-30.0, 75.0, 200.0]), np.array([np.cos(0.2), np.sin(0.2), 0.0])


def body(still_mm: float, places: tuple[tuple[int, int], ...] = ((0, 0),)) -> npt.NDArray[np.uint8]:
    layer = np.zeros((len(places) * HEIGHT, WIDTH, 4), dtype=np.uint8)
    still = np.full((HEIGHT, WIDTH), still_mm, dtype=np.float32)
    draw_body(layer, np.array(places), RAYS.nodes, drill_portrait(), Axis(TIP_MM, BACK), still)
    return layer


@pytest.mark.parametrize("from_tip_mm", [20.0, 48.0])
def test_the_body_is_as_wide_as_its_profile_beside_its_axis(from_tip_mm: float) -> None:
    coverage = body(still_mm=500.0)[..., 3] / 255.0
    at = CAMERA.px_from_camera(TIP_MM + from_tip_mm * BACK)[0]
    column = round(at[0])
    across = coverage[:, column]
    rows = np.arange(HEIGHT)
    middle = float((rows * across).sum() / across.sum())
    assert middle == pytest.approx(at[1] + (column - at[0]) * np.tan(0.2), abs=0.1)
    # A sphere is drawn longer towards the image's border, by its distance over its depth.
    longer = float(np.linalg.norm(TIP_MM[1:])) / TIP_MM[2]
    width_px = 2.0 * float(np.interp(from_tip_mm, PROFILE_MM, RADIUS_MM)) * longer * 300.0 / 200.0
    assert across.sum() * np.cos(0.2) == pytest.approx(width_px, rel=0.05)


def test_nothing_is_drawn_ahead_of_the_tip() -> None:
    coverage = body(still_mm=500.0)[..., 3]
    tip_px = CAMERA.px_from_camera(TIP_MM)[0]
    assert coverage[:, : int(tip_px[0]) - 2].max() == 0
    assert coverage[:, int(tip_px[0]) + 2 :].max() == 255


@pytest.mark.parametrize(
    ("still_mm", "share"), [(190.0, 0.0), (210.0, 1.0)], ids=["bone before it", "bone behind it"]
)
def test_bone_hides_the_body_behind_it(still_mm: float, share: float) -> None:
    # Nothing that is further from its tip comes near the bone.
    near = round(CAMERA.px_from_camera(TIP_MM + 70.0 * BACK)[0, 0])
    visible, free = body(still_mm)[:, :near, 3], body(500.0)[:, :near, 3]
    np.testing.assert_array_equal(visible, np.rint(share * free))


def test_bone_at_the_axis_hides_nothing_of_the_surface_before_it() -> None:
    # The shaft's surface is 1.15 mm before its axis in its middle, and beside the axis at its border.
    across = body(still_mm=200.0)[:, round(CAMERA.px_from_camera(TIP_MM + 20.0 * BACK)[0, 0]), 3]
    assert across.max() == 255


def test_rectangles_draw_what_one_large_one_draws() -> None:
    whole = body(500.0)
    parts = body(500.0, places=((-8, 0), (12, -16)))
    np.testing.assert_array_equal(parts[:HEIGHT, 8:], whole[:, : WIDTH - 8])
    np.testing.assert_array_equal(parts[HEIGHT + 16 :, : WIDTH - 12], whole[: HEIGHT - 16, 12:])


def lay(
    layer: npt.NDArray[np.uint8], place: tuple[int, int] = (1, 1), *, gain: float = 1.0, sigma: int = 0
) -> npt.NDArray[np.uint8]:
    """Lay a layer over a grey 4 x 4 image; the noise is 1 in blue, 2 in green and 3 in red."""
    image = np.full((4, 4, 3), 100, dtype=np.uint8)
    bank = np.broadcast_to(np.array([1, 2, 3], dtype=np.int16), (4, 4, 3)).copy()
    light = (np.full((4, 4), gain / 2.0, dtype=np.float32), 2.0)
    composite(image, np.array([place]), layer, 0, light, (np.full(256, sigma, dtype=np.int16), bank, 0.5))
    return image


@pytest.mark.parametrize(
    ("pixel", "gain", "sigma", "expected"),
    [
        ((0, 0, 0, 0), 1.0, 8, (100, 100, 100)),
        ((10, 20, 30, 255), 1.0, 0, (10, 20, 30)),
        ((10, 20, 30, 255), 2.0, 0, (20, 40, 60)),
        ((10, 20, 30, 255), 1.0, 8, (14, 28, 42)),
        ((10, 20, 30, 51), 1.0, 8, (90, 100, 110)),
        ((200, 200, 200, 255), 2.0, 0, (255, 255, 255)),
        ((10, 20, 30, 255), 1.0, -80, (0, 0, 0)),
        ((40, 255), 1.0, 2, (41, 42, 43)),
        ((40, 102), 0.5, 2, (80, 80, 80)),
    ],
    ids=[
        "not covered: the image",
        "covered: the layer",
        "twice the light",
        "with noise",
        "a fifth covered: the image's own noise",
        "no brighter than white",
        "no darker than black",
        "grey with noise",
        "grey, two fifths covered, in half the light",
    ],
)
def test_a_pixel_is_blended_with_light_and_noise(
    pixel: tuple[int, ...], gain: float, sigma: int, expected: tuple[int, int, int]
) -> None:
    image = lay(np.array([[pixel]], dtype=np.uint8), gain=gain, sigma=sigma)
    assert tuple(image[1, 1]) == expected
    image[1, 1] = 100
    assert (image == 100).all()


@pytest.mark.parametrize("place", [(-1, -1), (2, 2), (-9, 1), (1, 9)], ids=str)
def test_what_lies_beyond_the_image_is_cut_off(place: tuple[int, int]) -> None:
    layer = np.full((3, 3, 2), 255, dtype=np.uint8)
    image = lay(layer, place)
    expected = np.full((4, 4), 100, dtype=np.uint8)
    for row in range(3):
        for column in range(3):
            if 0 <= place[1] + row < 4 and 0 <= place[0] + column < 4:
                expected[place[1] + row, place[0] + column] = 255
    np.testing.assert_array_equal(image[..., 0], expected)
