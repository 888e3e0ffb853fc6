"""Conversion of industrial pixel formats to BGR, with colours that are easy to check."""

import numpy as np
import pytest

from server.capture.industrial.pixel_formats import bgr_from_pixels


@pytest.mark.parametrize(
    ("name", "rows"),
    [
        pytest.param("BayerRG8", ["RG", "GB"], id="RG"),
        pytest.param("BayerGR8", ["GR", "BG"], id="GR"),
        pytest.param("BayerGB8", ["GB", "RG"], id="GB"),
        pytest.param("BayerBG8", ["BG", "GR"], id="BG"),
    ],
)
def test_a_mosaic_is_read_from_its_first_row(name: str, rows: list[str]) -> None:
    colour = {"R": 200, "G": 120, "B": 40}
    tile = np.array([[colour[letter] for letter in row] for row in rows], dtype=np.uint8)
    image = bgr_from_pixels(np.tile(tile, (8, 8)), name)
    assert image is not None
    assert image[8, 8].tolist() == [40, 120, 200]


@pytest.mark.parametrize("name", ["RGB8", "RGB8Packed", "RGBa8"])
def test_colours_are_put_into_the_order_of_opencv(name: str) -> None:
    pixels = np.full((4, 4, 4 if "a" in name[:4] else 3), 255, dtype=np.uint8)
    pixels[:, :, :3] = (200, 120, 40)
    image = bgr_from_pixels(pixels, name)
    assert image is not None
    assert image[0, 0].tolist() == [40, 120, 200]
    assert image.shape == (4, 4, 3)
    assert bgr_from_pixels(pixels, "Mono16") is None
