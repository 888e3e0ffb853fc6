"""The size of a JPEG, read without decoding."""

import cv2
import numpy as np
import pytest

from server.capture.jpeg_header import jpeg_size_wh_px


def jpeg(width: int, height: int, *options: int) -> bytes:
    noise = np.random.default_rng(1).integers(0, 256, (height, width, 3), dtype=np.uint8)
    return cv2.imencode(".jpg", noise, list(options))[1].tobytes()


WHOLE = jpeg(40, 30)


@pytest.mark.parametrize(
    "options",
    [
        pytest.param([], id="baseline"),
        pytest.param([cv2.IMWRITE_JPEG_PROGRESSIVE, 1], id="progressive"),
        pytest.param([cv2.IMWRITE_JPEG_OPTIMIZE, 1, cv2.IMWRITE_JPEG_RST_INTERVAL, 2], id="with-restarts"),
    ],
)
def test_a_whole_jpeg_states_its_size(options: list[int]) -> None:
    assert jpeg_size_wh_px(jpeg(160, 90, *options)) == (160, 90)


@pytest.mark.parametrize(
    "content",
    [
        pytest.param(b"", id="nothing"),
        pytest.param(b"\x89PNG\r\n\x1a\n" + b"\x00" * 40, id="another-format"),
        pytest.param(WHOLE[:-2], id="cut-off-at-its-end"),
        pytest.param(WHOLE[: len(WHOLE) // 2], id="cut-off-in-the-middle"),
        pytest.param(b"\xff\xd8\xff\xd9", id="without-an-image"),
        pytest.param(b"\xff\xd8\xff\xe0\x00\x00\xff\xd9", id="with-a-part-of-no-length"),
        pytest.param(b"\xff\xd8" + b"\xff" * 1000 + b"\xff\xd9", id="of-fill-bytes"),
    ],
)
def test_what_is_no_whole_jpeg_has_no_size(content: bytes) -> None:
    assert jpeg_size_wh_px(content) is None


def test_a_size_that_would_take_gigabytes_is_read_without_decoding() -> None:
    at = WHOLE.index(b"\xff\xc0") + 5
    assert jpeg_size_wh_px(WHOLE[:at] + b"\xff\xff\xff\xff" + WHOLE[at + 4 :]) == (65535, 65535)
