"""Stored pixels of slices; compressed ones are decoded in a separate process."""

from collections.abc import Iterator
from typing import Any

import pydicom
from pydicom.encaps import encapsulate, generate_frames
from pydicom.pixels.decoders.base import get_decoder
from pydicom.pixels.utils import iter_pixels
from pydicom.uid import UID

from server.imaging.dicom.decoding import Encoded, StoredPixels, decode_images
from server.imaging.dicom.frame import FileAttributes, Frame
from server.imaging.dicom.header import BAD_DICOM, without_warnings
from tracker.errors import InvalidInput

# Maximum size of the file of one slice, which is read into memory at once.
MAX_SLICE_BYTES = 2**29
END_OF_IMAGE = b"\xff\xd9"
SEND_AGAIN = "Copy or export the series again; a truncated slice cannot be repaired."
UNCOMPRESSED = "Export the series again uncompressed, or with lossless JPEG 2000, JPEG-LS, JPEG or RLE."


def check_readable(shared: FileAttributes) -> None:
    """Reject pixel formats that cannot be decoded, before any pixel is read.

    Raises:
        InvalidInput: CT_COMPRESSION_UNKNOWN, CT_SLICE_TOO_LARGE, CT_PIXELS_UNKNOWN.
    """
    syntax = UID(shared.compression)
    try:
        is_readable = get_decoder(syntax).is_available
    except NotImplementedError:
        is_readable = False
    allocated, stored, high = shared.bits
    if not is_readable or (syntax == pydicom.uid.JPEGExtended12Bit and stored > 8):
        raise InvalidInput(
            "CT_COMPRESSION_UNKNOWN",
            f"the slices are compressed as {syntax.name} with {stored} bits, which cannot be read here",
            UNCOMPRESSED,
            {"transfer_syntax": shared.compression, "bits": stored, "syntax": syntax.name},
        )
    if shared.frames == 1 and shared.entry.size > MAX_SLICE_BYTES:
        raise InvalidInput(
            "CT_SLICE_TOO_LARGE",
            f"the file of a slice has {shared.entry.size / 2**20:.0f} MiB, the maximum is "
            f"{MAX_SLICE_BYTES / 2**20:.0f} MiB",
            UNCOMPRESSED,
            {
                "bytes": shared.entry.size,
                "max_bytes": MAX_SLICE_BYTES,
                "size_mib": shared.entry.size / 2**20,
                "max_mib": MAX_SLICE_BYTES / 2**20,
            },
        )
    if allocated not in {8, 16, 32} or not 1 <= stored <= allocated or high != stored - 1:
        raise InvalidInput(
            "CT_PIXELS_UNKNOWN",
            f"the slices store {stored} of {allocated} bits with {high} as the highest, which is not a CT",
            UNCOMPRESSED,
            {"bits_allocated": allocated, "bits_stored": stored, "high_bit": high},
        )


def stored_images(frames: list[Frame]) -> Iterator[tuple[int, StoredPixels]]:
    """Yield index and stored values (rows, columns) of each slice; compressed slices last.

    Raises:
        InvalidInput: CT_SLICE_TRUNCATED, CT_SLICE_DAMAGED.
    """
    by_file: dict[int, list[int]] = {}
    for index, frame in enumerate(frames):
        by_file.setdefault(id(frame.shared), []).append(index)
    files = [(frames[members[0]].shared, members) for members in by_file.values()]
    for shared, members in files:
        if not is_encoded(shared):
            images = _plain(shared, [frames[index].index for index in members])
            yield from ((index, _sized(image, shared)) for index, image in zip(members, images, strict=True))
    encoded = (
        one
        for shared, members in files
        if is_encoded(shared)
        for one in _encoded(shared, members, [frames[index].index for index in members])
    )
    for index, image in decode_images(encoded):
        if image is None:
            raise _damaged(frames[index].shared)
        yield index, _sized(image, frames[index].shared)


def is_encoded(shared: FileAttributes) -> bool:
    """Return whether its pixels are decoded by compiled code, which runs in another process."""
    syntax = UID(shared.compression)
    return syntax.is_encapsulated and syntax != pydicom.uid.RLELossless


def _plain(shared: FileAttributes, indexes: list[int]) -> Iterator[StoredPixels]:
    """Yield the images of one file that pydicom decodes in Python: uncompressed or RLE."""
    # Clearing the bits above those stored would destroy the padding value.
    options: dict[str, Any] = {"correct_unused_bits": False}
    try:
        with without_warnings(), shared.entry.open() as file:
            if shared.frames > 1:
                yield from iter_pixels(file, indices=indexes, raw=True, **options)
                return
            dataset = _whole(file, shared)
            content = len(dataset.PixelData)
            needed = shared.size_wh_px[0] * shared.size_wh_px[1] * shared.bits[0] // 8
            if not UID(shared.compression).is_encapsulated and content < needed:
                raise _truncated(shared, content, needed)
            yield get_decoder(UID(shared.compression)).as_array(dataset, index=0, raw=True, **options)[0]
    except EOFError:
        raise _truncated(shared) from None
    except BAD_DICOM:
        raise _damaged(shared) from None


def _encoded(shared: FileAttributes, members: list[int], indexes: list[int]) -> Iterator[Encoded]:
    """Yield the encoded images of one file."""
    options: dict[str, object] = {
        "transfer_syntax_uid": shared.compression,
        "rows": shared.size_wh_px[1],
        "columns": shared.size_wh_px[0],
        "samples_per_pixel": 1,
        "photometric_interpretation": shared.photometric or "MONOCHROME2",
        "number_of_frames": 1,
        "bits_allocated": shared.bits[0],
        "bits_stored": shared.bits[1],
        "pixel_representation": int(shared.is_signed),
    }
    try:
        with without_warnings(), shared.entry.open() as file:
            content = _whole(file, shared).PixelData
        images = list(generate_frames(content, number_of_frames=shared.frames))
    except EOFError:
        raise _truncated(shared) from None
    except BAD_DICOM:
        raise _damaged(shared) from None
    for member, index in zip(members, indexes, strict=True):
        if index >= len(images) or END_OF_IMAGE not in images[index][-64:]:
            # Some decoders would fill in missing pixels.
            raise _truncated(shared, len(content))
        yield Encoded(index=member, options=options, content=encapsulate([images[index]], has_bot=False))


def _whole(file: Any, shared: FileAttributes) -> pydicom.Dataset:  # noqa: ANN401  what pydicom reads from
    dataset = pydicom.dcmread(file, force=True)
    if "PixelData" not in dataset:
        raise _truncated(shared)
    if "TransferSyntaxUID" not in dataset.file_meta:
        dataset.file_meta.TransferSyntaxUID = UID(shared.compression)
    return dataset


def _sized(pixels: StoredPixels, shared: FileAttributes) -> StoredPixels:
    columns, rows = shared.size_wh_px
    if pixels.shape != (rows, columns) or pixels.dtype.kind not in "iu":
        raise _truncated(shared)
    return pixels


def _damaged(shared: FileAttributes) -> InvalidInput:
    return InvalidInput(
        "CT_SLICE_DAMAGED",
        f"a slice of {shared.entry.size} bytes cannot be decoded ({UID(shared.compression).name})",
        SEND_AGAIN,
        {"bytes": shared.entry.size, "compression": UID(shared.compression).name},
    )


def _truncated(shared: FileAttributes, found: int = 0, needed: int = 0) -> InvalidInput:
    columns, rows = shared.size_wh_px
    pixel_count = f" ({found} bytes of pixels" + (f", expected {needed})" if needed else ")") if found else ""
    return InvalidInput(
        "CT_SLICE_TRUNCATED",
        f"a slice is truncated: its file of {shared.entry.size} bytes lacks a part of the declared "
        f"{columns} x {rows} pixels{pixel_count}",
        SEND_AGAIN,
        {
            "bytes": shared.entry.size,
            "columns": columns,
            "rows": rows,
            "pixel_count": pixel_count,
            "pixel_bytes": found,
            "needed_bytes": needed,
        },
    )
