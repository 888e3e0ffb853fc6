"""Codes are read from images of a screen, as the page draws it from the patterns."""

import cv2
import numpy as np
import pytest

from server.latency import CELLS, CodeReader, code_patterns, plan_codes

CELL_PX = 60
SCREEN_WH_PX = (1280, 720)


def drawn(code: int, cell_px: int = CELL_PX) -> np.ndarray:
    """The code as drawn by a page, with a white margin."""
    cells = np.array([int(one) for one in code_patterns()[code]]).reshape(CELLS, CELLS) * 255
    marker = np.pad(cells, 1).astype(np.uint8)
    return np.pad(np.kron(marker, np.ones((cell_px, cell_px), np.uint8)), cell_px, constant_values=255)


def screen(*placed: tuple[np.ndarray, int, int], size_wh_px: tuple[int, int] = SCREEN_WH_PX) -> np.ndarray:
    """A screen with pictures at these places (x, y)."""
    ground = np.full((size_wh_px[1], size_wh_px[0]), 255, np.uint8)
    for picture, x, y in placed:
        ground[y : y + picture.shape[0], x : x + picture.shape[1]] = picture
    return ground


def filmed(picture: np.ndarray, *, light: float = 1.0, blur_px: float = 1.5, seed: int = 0) -> np.ndarray:
    """A camera's oblique image of a screen in a dark room."""
    height, width = picture.shape
    ends = np.array([[0, 0], [width, 0], [width, height], [0, height]], np.float32)
    seen = np.array([[0.2, 0.15], [0.85, 0.22], [0.8, 0.85], [0.15, 0.8]], np.float32) * [width, height]
    warp = cv2.getPerspectiveTransform(ends, seen.astype(np.float32))
    image = cv2.warpPerspective(picture, warp, (width, height), borderValue=40)
    image = cv2.GaussianBlur(image, (0, 0), blur_px).astype(float) * light
    image += np.random.default_rng(seed).normal(0.0, 5.0, image.shape)
    return cv2.cvtColor(np.clip(image, 0, 255).astype(np.uint8), cv2.COLOR_GRAY2BGR)


def test_every_code_is_read_from_the_pattern_that_the_page_gets() -> None:
    reader = CodeReader()
    assert len(code_patterns()) == 250
    assert [reader.read(filmed(screen((drawn(code), 400, 120)))) for code in range(0, 250, 7)] == list(
        range(0, 250, 7)
    )


@pytest.mark.parametrize(
    ("light", "blur_px", "size_wh_px"),
    [
        pytest.param(0.25, 1.5, SCREEN_WH_PX, id="dim"),
        pytest.param(1.0, 6.0, SCREEN_WH_PX, id="out-of-focus"),
        pytest.param(1.0, 1.0, (640, 480), id="small-image"),
    ],
)
def test_a_code_is_read_in_poor_images(light: float, blur_px: float, size_wh_px: tuple[int, int]) -> None:
    cell_px = size_wh_px[1] // 10
    picture = screen((drawn(42, cell_px), 40, 20), size_wh_px=size_wh_px)
    assert CodeReader().read(filmed(picture, light=light, blur_px=blur_px)) == 42


def test_of_two_codes_in_an_image_the_larger_one_is_read() -> None:
    both = screen((drawn(7, 30), 20, 20), (drawn(200, 60), 400, 120))
    assert CodeReader().read(filmed(both)) == 200


def test_an_image_without_a_code_has_none() -> None:
    noise = np.random.default_rng(0).integers(0, 255, (480, 640, 3), dtype=np.uint8)
    assert CodeReader().read(noise) is None


def test_a_mixture_of_two_codes_is_one_of_them_or_none() -> None:
    reader = CodeReader()
    for code in range(0, 248, 8):
        mixed = 0.5 * drawn(code) + 0.5 * drawn(code + 1)
        image = filmed(screen((mixed.astype(np.uint8), 400, 120)), seed=code)
        assert reader.read(image) in {None, code, code + 1}


def test_a_slow_camera_has_longer_codes() -> None:
    fast, slow = plan_codes(160, rate_hz=30.0), plan_codes(160, rate_hz=5.0)
    assert (fast.min_code_ms, fast.max_code_ms, fast.min_timed) == (100.0, 150.0, 100)
    assert (slow.min_code_ms, slow.max_code_ms) == (400.0, 600.0)
