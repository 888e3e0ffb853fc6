"""Images in a recording: the JPEG of the source if it has one, otherwise losslessly compressed pixels.

Measured for 1280x720 on one core with camera noise: PNG at its fastest takes 47 ms for 1.1 MB, Zstandard at
level 1 4.4 ms for 2.1 MB, at level 3 19 ms for 1.8 MB. At 30 Hz only level 1 takes about a tenth of a core.
Of grey images, whose three channels are equal, one channel is stored. `make benchmark ARGS=recording`
measures it.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import zstandard

from server.image_file import decoded

Image: TypeAlias = npt.NDArray[np.uint8]

LEVEL = 1
MAX_IMAGE_BYTES = 7680 * 4320 * 3


class Packing(StrEnum):
    """Encoding of an image."""

    JPEG = "jpeg"  # JPEG of the source
    ZSTD_BGR = "zstd-bgr8"  # rows of blue, green, red
    ZSTD_GREY = "zstd-grey8"  # one of three equal channels


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
        self._compressor = zstandard.ZstdCompressor(level=LEVEL)

    def pack(self, image: Image, jpeg: bytes = b"") -> PackedImage:
        """Pack an image (h, w, 3), BGR; `jpeg` is the JPEG from which it was decoded, if any."""
        height, width = image.shape[:2]
        if jpeg:
            return PackedImage(packing=Packing.JPEG, size_wh_px=(width, height), content=jpeg)
        is_grey = _has_equal_channels(image)
        pixels = np.ascontiguousarray(image[:, :, 0] if is_grey else image)
        return PackedImage(
            packing=Packing.ZSTD_GREY if is_grey else Packing.ZSTD_BGR,
            size_wh_px=(width, height),
            content=self._compressor.compress(pixels.data),
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
    pixels = np.frombuffer(flat, dtype=np.uint8).reshape(height, width, channels)
    return np.ascontiguousarray(np.broadcast_to(pixels, (height, width, 3)))


def _has_equal_channels(image: Image) -> bool:
    # A few pixels are compared first, because they differ in nearly every colour image.
    few = image[::16, ::16]
    return all(np.array_equal(part[:, :, 0], part[:, :, other]) for part in (few, image) for other in (1, 2))
