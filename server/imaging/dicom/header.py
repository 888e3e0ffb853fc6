"""Robust reading of DICOM attributes, without pixel data."""

import logging
import math
import struct
import warnings
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import BinaryIO

import pydicom
from pydicom.dataset import Dataset
from pydicom.errors import BytesLengthException, InvalidDicomError

from server.imaging.container import BAD_ARCHIVE, MAX_BYTES, Entry
from server.imaging.nifti import is_nifti

# Messages of pydicom may quote the content of a file, which may be the patient's name.
logging.getLogger("pydicom").setLevel(logging.CRITICAL + 1)
pydicom.config.settings.reading_validation_mode = pydicom.config.IGNORE

IMAGE = [
    "SpecificCharacterSet",
    "ImageType",
    "SOPClassUID",
    "SOPInstanceUID",
    "Modality",
    "SeriesDescription",
    "PatientName",
    "PatientID",
    "PatientBirthDate",
    "SliceThickness",
    "ConvolutionKernel",
    "GantryDetectorTilt",
    "SeriesInstanceUID",
    "SeriesNumber",
    "InstanceNumber",
    "ImagePositionPatient",
    "ImageOrientationPatient",
    "FrameOfReferenceUID",
    "SamplesPerPixel",
    "PhotometricInterpretation",
    "NumberOfFrames",
    "Rows",
    "Columns",
    "PixelSpacing",
    "BitsAllocated",
    "BitsStored",
    "HighBit",
    "PixelRepresentation",
    "PixelPaddingValue",
    "PixelPaddingRangeLimit",
    "RescaleIntercept",
    "RescaleSlope",
    "RescaleType",
    "ModalityLUTSequence",
    "LossyImageCompression",
    "SharedFunctionalGroupsSequence",
    "PerFrameFunctionalGroupsSequence",
]
# Exceptions of pydicom for invalid values and files.
BAD_DICOM = (
    InvalidDicomError,
    BytesLengthException,
    struct.error,
    LookupError,
    ArithmeticError,
    AssertionError,
    ValueError,
    TypeError,
    AttributeError,
    *BAD_ARCHIVE,
    MemoryError,
    RecursionError,
)
CT_CLASSES = {
    "1.2.840.10008.5.1.4.1.1.2",
    "1.2.840.10008.5.1.4.1.1.2.1",
    "1.2.840.10008.5.1.4.1.1.2.2",
}
DEFLATED = b"1.2.840.10008.1.2.1.99"


@dataclass(frozen=True, slots=True, kw_only=True)
class UnusedFile:
    """A file that is not a slice, with its kind."""

    reason: str


@contextmanager
def without_warnings() -> Iterator[None]:
    """Context manager that suppresses pydicom's warnings; problems are detected from the values."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def read_header(entry: Entry) -> Dataset | UnusedFile:
    """Return the required attributes of a slice, or why the file is not a slice."""
    try:
        head = entry.head()
        if not _is_dicom(head):
            return UnusedFile(reason="NIfTI files" if is_nifti(head) else "files that are not DICOM")
        with entry.open() as file:
            if DEFLATED in head and not _inflates(file):
                return UnusedFile(reason="files that exceed the maximum size when unpacked")
            file.seek(0)
            header = pydicom.dcmread(file, stop_before_pixels=True, specific_tags=IMAGE, force=True)
            return header if _is_complete(header) else UnusedFile(reason=BROKEN)
    except BAD_DICOM:
        return UnusedFile(reason=BROKEN)


BROKEN = "truncated or damaged DICOM files"


def _is_dicom(head: bytes) -> bool:
    """Return whether a file starts with the DICOM prefix, or, as before 1993, with a plausible attribute."""
    if head[128:132] == b"DICM":
        return True
    group, element = int.from_bytes(head[:2], "little"), int.from_bytes(head[2:4], "little")
    return len(head) > 64 and group in {0x0002, 0x0008} and element <= 0x0070


def _is_complete(header: Dataset) -> bool:
    """Return whether the header is complete; a CT slice without its size is truncated."""
    if "Rows" in header and "Columns" in header:
        return True
    kind = text(header, "SOPClassUID") or text(header.file_meta, "MediaStorageSOPClassUID")
    return kind != "" and kind not in CT_CLASSES


def _inflates(file: BinaryIO) -> bool:
    """Return whether a deflated file stays within the limit; pydicom would unpack all of it."""
    file.seek(128 + 4)
    group_length = file.read(12)
    file.seek(128 + 4 + 12 + int.from_bytes(group_length[8:12], "little"))
    unpack = zlib.decompressobj(-zlib.MAX_WBITS)
    unpacked = 0
    while block := file.read(2**20):
        while block:
            unpacked += len(unpack.decompress(block, 2**24))
            block = unpack.unconsumed_tail
            if unpacked > MAX_BYTES // 8:
                return False
    return True


def text(dataset: Dataset, keyword: str) -> str:
    """Return an attribute as text; empty if it is missing or unreadable."""
    try:
        value = dataset.get(keyword)
        return "" if value is None else str(value).strip().strip("\0")
    except BAD_DICOM:
        return ""


def numbers(dataset: Dataset, keyword: str, count: int) -> tuple[float, ...]:
    """Return an attribute of `count` numbers; empty if it is missing, unreadable, or has another count."""
    try:
        value = dataset.get(keyword)
        if value is None or value == "":
            return ()
        several = tuple(float(one) for one in ([value] if count == 1 and not _is_several(value) else value))
    except BAD_DICOM:
        return ()
    return several if len(several) == count else ()


def _is_several(value: object) -> bool:
    return hasattr(value, "__len__") and not isinstance(value, str | bytes)


def number(dataset: Dataset, keyword: str, otherwise: float) -> float:
    """Return an attribute that is a number; `otherwise` if it is missing or unreadable."""
    found = numbers(dataset, keyword, 1)
    return found[0] if found and math.isfinite(found[0]) else otherwise


def words(dataset: Dataset, keyword: str) -> tuple[str, ...]:
    """Return an attribute of several texts."""
    try:
        value = dataset.get(keyword)
        if value is None:
            return ()
        several = [value] if isinstance(value, str) else list(value)
        return tuple(str(one).strip() for one in several)
    except BAD_DICOM:
        return ()
