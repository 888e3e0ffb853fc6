"""NIfTI header: shape, affine, and scaling of the stored values."""

import gzip
import logging
import struct
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import IO, cast

import nibabel as nib
import numpy as np
import numpy.typing as npt
from nibabel.spatialimages import HeaderDataError
from nibabel.wrapstruct import WrapStructError

from server.imaging.container import BAD_ARCHIVE, Entry
from server.imaging.nifti.affine import NiftiPlacement, placement_from_header
from server.imaging.voxels import check_voxels
from tracker.errors import InvalidInput

# Messages of nibabel may quote the content of a file.
logging.getLogger("nibabel.global").setLevel(logging.CRITICAL + 1)
BAD_NIFTI = (
    HeaderDataError,
    WrapStructError,
    nib.filebasedimages.ImageFileError,
    ValueError,
    TypeError,
    LookupError,
    ArithmeticError,
    struct.error,
    *BAD_ARCHIVE,
    MemoryError,
)
CONVERT_AGAIN = "Convert or export the CT again as NIfTI, or give its DICOM slices."


@dataclass(frozen=True, slots=True, kw_only=True)
class NiftiHeader:
    """Header of a readable NIfTI file.

    Attributes:
        shape_ijk: Number of voxels along its three axes.
        stored: Type of its values, with byte order.
        offset: Offset of the first value in bytes.
        slope, intercept: Conversion of stored values to HU.
        place: Geometry of its voxels, with warnings.
    """

    shape_ijk: tuple[int, int, int]
    stored: np.dtype[np.generic]
    offset: int
    slope: float
    intercept: float
    place: NiftiPlacement


def is_nifti(head: bytes) -> bool:
    """Return whether a file that starts with these bytes is NIfTI, with or without gzip."""
    if head[:2] == b"\x1f\x8b":
        try:
            head = zlib.decompressobj(16 + zlib.MAX_WBITS).decompress(head, 1024)
        except zlib.error:
            return False
    return head[344:348] in {b"n+1\0", b"ni1\0"} or head[4:8] in {b"n+2\0", b"ni2\0"}


@contextmanager
def decompressed(entry: Entry) -> Iterator[IO[bytes]]:
    """Context manager for the decompressed content of the file."""
    is_packed = entry.head()[:2] == b"\x1f\x8b"
    with entry.open() as file:
        if not is_packed:
            yield file
            return
        with gzip.GzipFile(fileobj=file) as inside:
            yield cast("IO[bytes]", inside)


def read_nifti_header(entry: Entry) -> NiftiHeader:
    """Read and validate the header.

    Raises:
        InvalidInput: CT_FILE_DAMAGED, CT_NIFTI_PAIR, CT_NOT_ONE_VOLUME, CT_PIXELS_UNKNOWN, CT_TOO_LARGE, or
            as `placement_from_header`.
    """
    try:
        with decompressed(entry) as file:
            start = file.read(540)
        header = (
            nib.Nifti2Header(start[:540]) if start[4:7] in {b"n+2", b"ni2"} else nib.Nifti1Header(start[:348])
        )
        pair = header.get("magic", b"").item()[:3] in {b"ni1", b"ni2"}
        shape = tuple(int(size) for size in header.get_data_shape())
        stored = header.get_data_dtype()
        slope, intercept = header.get_slope_inter()
        offset = int(header.get_data_offset())
    except BAD_NIFTI:
        raise damaged(entry, "its header cannot be read") from None
    if pair:
        raise InvalidInput(
            "CT_NIFTI_PAIR",
            "this is the header of a NIfTI pair, its voxels are in a second file",
            "Convert it into a single .nii or .nii.gz.",
        )
    _check_shape(shape)
    _check_kind(stored)
    place = placement_from_header(header, shape[:3])
    return NiftiHeader(
        shape_ijk=(shape[0], shape[1], shape[2]),
        stored=stored,
        offset=offset,
        slope=1.0 if slope is None else float(slope),
        intercept=0.0 if intercept is None else float(intercept),
        place=place,
    )


def _check_shape(shape: tuple[int, ...]) -> None:
    if len(shape) < 3 or any(size != 1 for size in shape[3:]) or min(shape[:3]) < 2:
        voxels = " x ".join(str(size) for size in shape) or "no"
        raise InvalidInput(
            "CT_NOT_ONE_VOLUME",
            f"the NIfTI has {voxels} voxels, expected one volume of three axes with at least 2 each",
            "Export one volume of the CT; a time series contains several.",
            {"shape": list(shape), "voxels": voxels},
        )
    check_voxels((shape[2], shape[1], shape[0]))


def _check_kind(stored: npt.DTypeLike) -> None:
    kind = np.dtype(stored)
    if kind.names or kind.kind not in "iuf":
        raise InvalidInput(
            "CT_PIXELS_UNKNOWN",
            f"the NIfTI stores {'colours' if kind.names else kind.name}, which are not Hounsfield units",
            CONVERT_AGAIN,
            {"stored": "colours" if kind.names else kind.name},
        )


def damaged(entry: Entry, why: str) -> InvalidInput:
    """Return the error for a truncated or damaged NIfTI file."""
    return InvalidInput(
        "CT_FILE_DAMAGED",
        f"the NIfTI file of {entry.size} bytes is truncated or damaged: {why}",
        "Copy or convert the file again.",
        {"bytes": entry.size, "nifti_problem": why},
    )
