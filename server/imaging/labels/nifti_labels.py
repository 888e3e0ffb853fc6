"""Reading of labels from NIfTI, a few slices at a time."""

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt
from nibabel.arrayproxy import ArrayProxy

from server.imaging.container import Entry
from server.imaging.labels.label_image import LabelImage
from server.imaging.labels.names import (
    HOW,
    MAX_EXTENSION_BYTES,
    MAX_NUMBER,
    class_of_file_name,
    classes_of_totalsegmentator,
    names_in_extension,
)
from server.imaging.nifti.header import BAD_NIFTI, NiftiHeader, damaged, decompressed, read_nifti_header
from tracker.errors import InvalidInput

SLICES_PER_READ = 8
MAX_OFF_INTEGER = 1e-3
MAX_LISTED = 8


def read_nifti_labels(entry: Entry, names: Mapping[int, int]) -> LabelImage:
    """Read one NIfTI file of labels.

    Args:
        entry: one file with the labels of all vertebrae, or the binary mask of the vertebra that its name
            states (`vertebrae_L3.nii.gz`).
        names: class numbers of levels by the number of a label; empty for those that the file names, or else
            the class numbers of TotalSegmentator v2.

    Raises:
        InvalidInput: LABELS_NOT_INTEGER, LABEL_UNKNOWN, CT_FILE_DAMAGED, or what `read_nifti_header` raises.
    """
    header = read_nifti_header(entry)
    only = class_of_file_name(entry.name)
    columns, rows, slices = header.shape_ijk
    try:
        with decompressed(entry) as file:
            start = file.read(min(header.offset, MAX_EXTENSION_BYTES))
        known = _known(start, names, only)
        # Of an array of zeros, only those pages take memory that are written.
        labels = np.zeros((slices, rows, columns), dtype=np.uint8)
        with decompressed(entry) as file:
            found = _fill(labels, header, file, known, is_mask=only is not None and not names)
            file.read(1)  # Reads the checksum at the end of a gzip file.
    except BAD_NIFTI as error:
        if isinstance(error, InvalidInput):
            raise
        raise damaged(entry, f"it lacks a part of its {columns} x {rows} x {slices} voxels") from None
    return LabelImage(
        labels=labels,
        lps_from_ijk=header.place.lps_from_ijk,
        source="nifti",
        is_named=known is not _TOTALSEGMENTATOR,
        others=len([number for number in found if not known.get(number)]),
    )


_TOTALSEGMENTATOR = classes_of_totalsegmentator()


def _known(start: bytes, names: Mapping[int, int], only: int | None) -> Mapping[int, int]:
    """Return class numbers by the number of a label; 0 for a known structure that is no vertebra."""
    if names:
        return names
    if only is not None:
        return {1: only}
    return names_in_extension(start) or _TOTALSEGMENTATOR


def _fill(
    labels: npt.NDArray[np.uint8],
    header: NiftiHeader,
    file: object,
    known: Mapping[int, int],
    *,
    is_mask: bool,
) -> set[int]:
    """Write the class numbers of vertebrae; return the numbers of all labels in the file."""
    table = np.zeros(MAX_NUMBER + 1, dtype=np.uint8)
    for number, class_number in known.items():
        table[number] = class_number
    stored = ArrayProxy(file, (header.shape_ijk, header.stored, header.offset, 1.0, 0.0), mmap=False)
    found: set[int] = set()
    for start in range(0, len(labels), SLICES_PER_READ):
        some = np.asarray(stored[:, :, start : start + SLICES_PER_READ]).transpose(2, 1, 0)
        numbers = _integers(some, header)
        if is_mask:
            numbers = (numbers > 0).astype(np.int64)
        here = set(np.unique(numbers).tolist()) - {0}
        found |= here
        if any(known.get(number) for number in here):
            for k, one in enumerate(table[numbers], start=start):
                if one.any():
                    labels[k] = one
    _reject_unknown(found, known, is_default=known is _TOTALSEGMENTATOR)
    return found


def _integers(stored: npt.NDArray[np.generic], header: NiftiHeader) -> npt.NDArray[np.int64]:
    """Return stored values as numbers of labels; NaN is no label."""
    if stored.dtype.kind in "iu" and header.slope == 1.0 and header.intercept == 0.0:
        values = stored.astype(np.int64)
        numbers = values
    else:
        real = np.nan_to_num(
            stored.astype(np.float64) * header.slope + header.intercept, posinf=1e9, neginf=-1
        )
        numbers = np.rint(np.clip(real, -1.0, 1e9)).astype(np.int64)
        off = float(np.abs(real - numbers).max(initial=0.0))
        if off > MAX_OFF_INTEGER:
            raise InvalidInput(
                "LABELS_NOT_INTEGER",
                f"the labels are not whole numbers (up to {off:.3f} beside one), as if this were an image or "
                "had been interpolated",
                "Give the segmentation as labels, resampled by nearest neighbour if at all.",
                {"off": off},
            )
    low, high = int(numbers.min(initial=0)), int(numbers.max(initial=0))
    if low < 0 or high > MAX_NUMBER:
        raise InvalidInput(
            "LABELS_NOT_INTEGER",
            f"the values lie between {low} and {high}, labels between 0 and {MAX_NUMBER}; this looks like an "
            "image",
            "Give the segmentation, not the CT.",
            {"low": low, "high": high, "max_number": MAX_NUMBER},
        )
    return numbers


def _reject_unknown(found: set[int], known: Mapping[int, int], *, is_default: bool) -> None:
    unknown = sorted(found - known.keys())
    if unknown and is_default:
        listed = ", ".join(map(str, unknown[:MAX_LISTED]))
        raise InvalidInput(
            "LABEL_UNKNOWN",
            f"the file does not name its labels, and {len(unknown)} of {len(found)} are not in the table of "
            f"TotalSegmentator v2: {listed}",
            HOW,
            {"unknown": len(unknown), "labels": len(found), "listed": listed},
        )
