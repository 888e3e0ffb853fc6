"""From stored pixels to Hounsfield units, slice by slice."""

from collections.abc import Iterator
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import pydicom
from pydicom.pixels.decoders.base import get_decoder
from pydicom.pixels.utils import iter_pixels
from pydicom.uid import UID

from server.imaging.dicom.frame import Frame, Shared
from server.imaging.dicom.header import BAD_DICOM, quietly
from server.imaging.voxels import LEAST_HU, MOST_HU, NOTHING_HU
from tracker.errors import InvalidInput

# Whole numbers of any size, with or without sign, as the file holds them.
Stored: TypeAlias = npt.NDArray[np.integer[Any]]
END_OF_IMAGE = b"\xff\xd9"
SEND_AGAIN = "Copy or export the series again; a slice that breaks off cannot be repaired."
UNCOMPRESSED = "Export the series again uncompressed, or with lossless JPEG 2000, JPEG-LS, JPEG or RLE."


def check_readable(shared: Shared) -> None:
    """Refuses pixels of a kind that cannot be read, before any is read.

    Raises:
        InvalidInput: CT_COMPRESSION_UNKNOWN, CT_PIXELS_UNKNOWN.
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
            {"transfer_syntax": shared.compression, "bits": stored},
        )
    if allocated not in {8, 16, 32} or not 1 <= stored <= allocated or high != stored - 1:
        raise InvalidInput(
            "CT_PIXELS_UNKNOWN",
            f"the slices store {stored} of {allocated} bits with {high} as the highest, which is no CT",
            UNCOMPRESSED,
            {"bits_allocated": allocated, "bits_stored": stored, "high_bit": high},
        )


def stored_pixels(shared: Shared, indexes: list[int]) -> Iterator[Stored]:
    """The stored numbers (rows, columns) of these images of one file, one after the other.

    Raises:
        InvalidInput: CT_SLICE_TRUNCATED, CT_SLICE_DAMAGED.
    """
    native = not UID(shared.compression).is_encapsulated
    options: dict[str, Any] = {"correct_unused_bits": False} if _keeps_unused_bits(shared) else {}
    try:
        with quietly(), shared.entry.open() as file:
            if shared.frames > 1:
                for pixels in iter_pixels(file, indices=indexes, raw=True, **options):
                    yield _sized(pixels, shared)
                return
            dataset = pydicom.dcmread(file, force=True)
            if "TransferSyntaxUID" not in dataset.file_meta:
                dataset.file_meta.TransferSyntaxUID = UID(shared.compression)
            _check_length(dataset, shared, native=native)
            decoder = get_decoder(UID(shared.compression))
            pixels, _ = decoder.as_array(dataset, index=0, raw=True, **options)
            yield _sized(pixels, shared)
    except EOFError:
        raise _truncated(shared) from None
    except BAD_DICOM:
        raise InvalidInput(
            "CT_SLICE_DAMAGED",
            f"a slice of {shared.entry.size} bytes cannot be decoded ({UID(shared.compression).name})",
            SEND_AGAIN,
            {"bytes": shared.entry.size},
        ) from None


def _sized(pixels: Stored, shared: Shared) -> Stored:
    columns, rows = shared.size_wh_px
    if pixels.shape != (rows, columns) or pixels.dtype.kind not in "iu":
        raise _truncated(shared)
    return pixels


def _check_length(dataset: pydicom.Dataset, shared: Shared, *, native: bool) -> None:
    """Refuses a slice of which a part is missing; some decoders would fill it in."""
    content = dataset.get("PixelData")
    if content is None:
        raise _truncated(shared)
    columns, rows = shared.size_wh_px
    if native and len(content) < columns * rows * shared.bits[0] // 8:
        raise _truncated(shared, len(content), columns * rows * shared.bits[0] // 8)
    ends_itself = UID(shared.compression) in (
        *pydicom.uid.JPEGTransferSyntaxes,
        *pydicom.uid.JPEGLSTransferSyntaxes,
        *pydicom.uid.JPEG2000TransferSyntaxes,
    )
    if ends_itself and END_OF_IMAGE not in content[-64:]:
        raise _truncated(shared, len(content))


def _truncated(shared: Shared, found: int = 0, needed: int = 0) -> InvalidInput:
    columns, rows = shared.size_wh_px
    numbers = f" ({found} bytes of pixels" + (f" of {needed})" if needed else ")") if found else ""
    return InvalidInput(
        "CT_SLICE_TRUNCATED",
        f"a slice breaks off: its file of {shared.entry.size} bytes does not hold the {columns} x {rows} "
        f"pixels that it declares{numbers}",
        SEND_AGAIN,
        {"bytes": shared.entry.size, "columns": columns, "rows": rows, "pixel_bytes": found},
    )


def hounsfield(stored: Stored, frame: Frame) -> tuple[npt.NDArray[np.int16], int]:
    """HU (rows, columns) int16 of the stored numbers, and how many lay beyond what int16 holds."""
    shared = frame.shared
    padded = None
    if shared.padding is not None:
        low, high = shared.padding
        padded = (stored >= low) & (stored <= high)
    values = _without_unused_bits(stored, shared)
    slope, intercept = frame.slope[0], frame.intercept[0]
    if slope == 1.0 and intercept == int(intercept) and abs(intercept) < 2**30 and shared.bits[1] <= 16:
        hu: npt.NDArray[np.int32 | np.float64] = values.astype(np.int32) + np.int32(intercept)
    else:
        hu = np.rint(values.astype(np.float64) * slope + intercept)
    if padded is not None:
        hu = np.where(padded, np.asarray(NOTHING_HU, dtype=hu.dtype), hu)
    beyond = int(np.count_nonzero((hu < LEAST_HU) | (hu > MOST_HU)))
    return np.clip(hu, LEAST_HU, MOST_HU).astype(np.int16), beyond


def _without_unused_bits(stored: Stored, shared: Shared) -> Stored:
    """The bits above those stored may hold anything: overlays, or nothing."""
    unused = stored.dtype.itemsize * 8 - shared.bits[1]
    if unused <= 0 or not _keeps_unused_bits(shared):
        return stored
    return np.asarray(np.right_shift(np.left_shift(stored, unused), unused))


def _keeps_unused_bits(shared: Shared) -> bool:
    """Whether the bits above those stored come along; pydicom would clear some padding with them."""
    syntax = UID(shared.compression)
    return not syntax.is_encapsulated or syntax == pydicom.uid.RLELossless
