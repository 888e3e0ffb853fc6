"""Pictures are decoded up to a size that fits into memory, whatever their header states."""

import os
import subprocess
import sys
import zlib
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[2]
# Found by `make fuzz`: a height of 606 million, a kind of pixels that there is not, and a cut chunk.
FOUND = bytes.fromhex(
    "89504e470d0a1a0a"
    "0000000d4948445200002424" + "24" * 9 + "b23388ba"
    "2400006e4944415438118dc1310100000cc2b0d6bf6826008e253284264368328426436832842643683284264368328426436832842643683284264368328426436832842643683284264368861fc3a72de867"
)
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
