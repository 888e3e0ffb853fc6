"""Images in a recording: the JPEG of the source if it has one, otherwise losslessly compressed pixels.

Each row is stored as its difference from the row above (modulo 256), which leaves small values, and these are
entropy-coded by Zstandard. Camera noise has no repetitions worth searching for, so the search is reduced to
the minimum: that takes half the time of level 1 and less space. `make benchmark ARGS=recording` compares it
with level 1 and with PNG. Of grey images, whose three channels are equal, one channel is stored.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

import cv2
import numpy as np
import numpy.typing as npt
import zstandard

from server.image_file import decoded

Image: TypeAlias = npt.NDArray[np.uint8]

# Level 1 with the smallest hash table and the longest minimum of a match. Negative levels, which also search
# less, do not entropy-code what has no match.
COMPRESSION = zstandard.ZstdCompressionParameters.from_level(1, hash_log=6, min_match=7)
MAX_IMAGE_BYTES = 7680 * 4320 * 3


class Packing(StrEnum):
    """Encoding of an image."""

    JPEG = "jpeg"  # JPEG of the source
    ZSTD_BGR = "zstd-row-differences-bgr8"  # blue, green, red
    ZSTD_GREY = "zstd-row-differences-grey8"  # one of three equal channels


@dataclass(frozen=True, slots=True, kw_only=True)
class PackedImage:
    """One image.

    Attributes:
        packing: Encoding.
        size_wh_px: Width and height.
        content: Encoded bytes.
    """

    packing: Packing
    size_wh_px: tuple[int, int]
    content: bytes

    @property
    def is_jpeg(self) -> bool:
        """Whether the content is a JPEG."""
        return self.packing is Packing.JPEG


class ImagePacker:
    """Packs images, one after another; not thread-safe."""

    def __init__(self) -> None:
        self._compressor = zstandard.ZstdCompressor(compression_params=COMPRESSION)

    def pack(self, image: Image, jpeg: bytes = b"") -> PackedImage:
        """Pack an image (h, w, 3), BGR; `jpeg` is the JPEG from which it was decoded, if any."""
        height, width = image.shape[:2]
        if jpeg:
            return PackedImage(packing=Packing.JPEG, size_wh_px=(width, height), content=jpeg)
        grey = _grey_channel(image)
        differences = _row_differences(image if grey is None else grey)
        return PackedImage(
            packing=Packing.ZSTD_BGR if grey is None else Packing.ZSTD_GREY,
            size_wh_px=(width, height),
            content=self._compressor.compress(differences.data),
        )


def unpacked(packed: PackedImage) -> Image | None:
    """Return the image (h, w, 3), BGR; None if its bytes are damaged."""
    width, height = packed.size_wh_px
    if packed.packing is Packing.JPEG:
        image = decoded(packed.content)
        return image if image is not None and image.shape[:2] == (height, width) else None
    channels = 1 if packed.packing is Packing.ZSTD_GREY else 3
    size = width * height * channels
    if not 0 < size <= MAX_IMAGE_BYTES:
        return None
    try:
        flat = zstandard.ZstdDecompressor().decompress(packed.content, max_output_size=size)
    except zstandard.ZstdError:
        return None
    if len(flat) != size:
        return None
    differences = np.frombuffer(flat, dtype=np.uint8).reshape(height, width, channels)
    pixels = np.add.accumulate(differences, axis=0, dtype=np.uint8)
    return np.ascontiguousarray(np.broadcast_to(pixels, (height, width, 3)))


def _row_differences(pixels: Image) -> Image:
    differences = np.empty(pixels.shape, np.uint8)
    differences[:1] = pixels[:1]
    np.subtract(pixels[1:], pixels[:-1], out=differences[1:])
    return differences


def _grey_channel(image: Image) -> Image | None:
    """Return the channel (h, w) of an image whose three channels are equal; None if they differ."""
    # A few pixels are compared first, because they differ in nearly every colour image.
    few = image[::16, ::16]
    if not (np.array_equal(few[:, :, 0], few[:, :, 1]) and np.array_equal(few[:, :, 0], few[:, :, 2])):
        return None
    channel = np.asarray(cv2.extractChannel(image, 0), np.uint8)
    return channel if np.array_equal(cv2.cvtColor(channel, cv2.COLOR_GRAY2BGR), image) else None
