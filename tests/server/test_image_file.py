"""Pictures are decoded up to a size that fits into memory, whatever their header states."""

import os
import subprocess
import sys
import zlib
from pathlib import Path

import cv2
import numpy as np
import pytest

from server.image_file import DamagedJpeg, decode_jpeg
from tests.server.capture.damaged_jpegs import JPEG, WITH_GAP, jpeg_of

REPOSITORY = Path(__file__).parents[2]
# Found by `make fuzz`: a height of 606 million, a kind of pixels that there is not, and a cut chunk.
FOUND = bytes.fromhex(
    "89504e470d0a1a0a"
    "0000000d4948445200002424" + "24" * 9 + "b23388ba"
    "2400006e4944415438118dc1310100000cc2b0d6bf6826008e253284264368328426436832842643683284264368328426436832842643683284264368328426436832842643683284264368861fc3a72de867"
)
# The first segment of images of USB cameras, which have no Huffman tables.
AVI1 = b"\xff\xe0\x00\x21AVI1" + bytes(27)
REPORT = (
    "import resource, sys, server.image_file as f; before = resource.getrusage(0).ru_maxrss;"
    "assert f.decoded(sys.stdin.buffer.read()) is None;"
    "print(resource.getrusage(0).ru_maxrss - before)"
)


def png_of(width: int, height: int, rows: int) -> bytes:
    """A black PNG that states this size, and has so many rows."""
    parts = [
        (b"IHDR", width.to_bytes(4, "big") + height.to_bytes(4, "big") + bytes([8, 0, 0, 0, 0])),
        (b"IDAT", zlib.compress(bytes((width + 1) * rows))),
        (b"IEND", b""),
    ]
    chunks = [
        len(body).to_bytes(4, "big") + kind + body + zlib.crc32(kind + body).to_bytes(4, "big")
        for kind, body in parts
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


def bmp_of(width: int, height: int) -> bytes:
    """The header of a BMP with one bit a pixel, and its pixels."""
    head = (40, width, height, 1 | 1 << 16, 0, 0, 0, 0, 2, 0)
    pixels = bytes((width + 31) // 32 * 4 * height)
    size = 62 + len(pixels)
    return b"".join(
        (
            *(b"BM", size.to_bytes(4, "little"), bytes(4), (62).to_bytes(4, "little")),
            *(one.to_bytes(4, "little") for one in head),
            *(b"\0\0\0\0\xff\xff\xff\0", pixels),
        )
    )


@pytest.mark.parametrize(
    "content",
    [
        pytest.param(png_of(16_000, 16_000, 16_000), id="png"),
        pytest.param(FOUND, id="png-of-no-kind"),
        pytest.param(bmp_of(20_000, 20_000), id="bmp"),
    ],
)
def test_a_small_file_of_a_large_picture_takes_no_memory(content: bytes) -> None:
    # In a process of its own, because OpenCV reads its limit when it is loaded.
    reported = subprocess.run(
        [sys.executable, "-c", REPORT],
        cwd=REPOSITORY,
        env={name: value for name, value in os.environ.items() if not name.startswith("OPENCV_")},
        input=content,
        capture_output=True,
        check=True,
    )
    # Decoded they take 770 MB or more; macOS counts bytes, Linux kB.
    assert int(reported.stdout) / (1024 if sys.platform == "darwin" else 1) < 250_000


def without_huffman_tables(jpeg: bytes) -> bytes:
    """The JPEG as USB cameras send it: an AVI1 segment, and no tables."""
    kept, at = AVI1, 2
    while jpeg[at + 1] != 0xDA:
        end = at + 2 + int.from_bytes(jpeg[at + 2 : at + 4], "big")
        kept += b"" if jpeg[at + 1] in (0xC4, 0xE0) else jpeg[at:end]
        at = end
    return jpeg[:2] + kept + jpeg[at:]


def without_scan_parameters(jpeg: bytes) -> bytes:
    at = jpeg.index(b"\x00\x3f\x00", jpeg.index(b"\xff\xda"))
    return jpeg[:at] + bytes(3) + jpeg[at + 3 :]


@pytest.mark.parametrize(
    "content",
    [
        pytest.param(JPEG, id="4:2:0"),
        pytest.param(jpeg_of(cv2.IMWRITE_JPEG_SAMPLING_FACTOR, 0x211111), id="4:2:2"),
        pytest.param(jpeg_of(cv2.IMWRITE_JPEG_RST_INTERVAL, 10), id="restart-markers"),
        pytest.param(jpeg_of(cv2.IMWRITE_JPEG_PROGRESSIVE, 1), id="progressive"),
        pytest.param(without_huffman_tables(JPEG), id="no-huffman-tables"),
        pytest.param(JPEG + bytes(3000), id="padded"),
        pytest.param(without_scan_parameters(JPEG), id="no-scan-parameters"),
        pytest.param(JPEG + JPEG[:5000], id="followed-by-another"),
    ],
)
def test_an_intact_jpeg_has_the_pixels_of_opencv(content: bytes) -> None:
    packet = np.frombuffer(content, np.uint8)
    for grey, flag in ((False, cv2.IMREAD_COLOR), (True, cv2.IMREAD_GRAYSCALE)):
        image = decode_jpeg(content, grey=grey)
        assert not isinstance(image, DamagedJpeg)
        np.testing.assert_array_equal(image, cv2.imdecode(packet, flag))


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        pytest.param(WITH_GAP, "premature end", id="gap"),
        pytest.param(JPEG[:-2], "Premature end", id="no-end"),
        pytest.param(without_scan_parameters(WITH_GAP), "premature end", id="no-scan-parameters"),
        pytest.param(JPEG[:9000] + bytes(512) + JPEG[9512:], "Corrupt", id="zeros"),
        pytest.param(JPEG[:9000] + jpeg_of(cv2.IMWRITE_JPEG_QUALITY, 90)[9000:], "Corrupt", id="two-images"),
        pytest.param(b"", "Could not determine", id="empty"),
        pytest.param(JPEG.replace(b"\x01\x22\0", b"\x01\x14\0", 1), "subsampling", id="subsampling"),
        pytest.param(JPEG.replace(b"\x01\xe0\x02\x80", b"\xff\xdc\xff\xdc"), "allowed", id="too-large"),
    ],
)
def test_a_damaged_jpeg_is_rejected_with_the_reason(content: bytes, reason: str) -> None:
    image = decode_jpeg(content)
    assert isinstance(image, DamagedJpeg)
    assert reason in image.reason
