"""Reading of the voxels of a NIfTI file as Hounsfield units, a few slices at a time."""

from pathlib import Path
from typing import IO

import numpy as np
import numpy.typing as npt
from nibabel.arrayproxy import ArrayProxy

from server.imaging.container import Entry
from server.imaging.ct import Ct, FirstSlice, Progress, SeriesDescription, slice_as_scanned
from server.imaging.nifti.header import (
    BAD_NIFTI,
    CONVERT_AGAIN,
    NiftiHeader,
    damaged,
    decompressed,
    read_nifti_header,
)
from server.imaging.plausibility import OF_THIS_PATIENT, clipped_warning, reject_beyond, value_warnings
from server.imaging.voxels import MAX_HU, MIN_HU, PADDING_HU, Voxels, voxels_to_fill
from tracker.errors import InvalidInput, Remark
from tracker.plan import Volume

# Number of slices read at once; few, so that their values need little memory compared with the volume.
SLICES_PER_READ = 8
MAX_NAN_RATIO = 0.5


def describe_nifti(entry: Entry) -> SeriesDescription:
    """Return the description of a NIfTI file."""
    return _described(read_nifti_header(entry), entry)


def _described(header: NiftiHeader, entry: Entry) -> SeriesDescription:
    sizes = np.linalg.norm(header.place.lps_from_ijk[:3, :3], axis=0)
    columns, rows, slices = header.shape_ijk
    return SeriesDescription(
        series="nifti",
        kind="nifti",
        modality="",
        words="",
        number=0,
        patient=1,
        images=slices,
        size_wh_px=(columns, rows),
        pixel_mm=(float(sizes[0]), float(sizes[1])),
        thickness_mm=float(sizes[2]),
        kernel="",
        compression="gzip" if entry.head()[:2] == b"\x1f\x8b" else "none",
    )


def read_nifti(entry: Entry, *, progress: Progress, first: FirstSlice, into: Path | None) -> Ct:
    """Read a NIfTI file as Hounsfield units in LPS mm; its axes are kept, with directions in the affine.

    Raises:
        InvalidInput: CT_VALUES_MISSING, CT_VALUES_BEYOND, CT_FILE_DAMAGED, or what `read_nifti_header`
            raises.
    """
    header = read_nifti_header(entry)
    columns, rows, slices = header.shape_ijk
    with voxels_to_fill((slices, rows, columns), into) as voxels:
        try:
            with decompressed(entry) as file:
                missing, beyond = _fill(voxels, header, file, progress, first)
                file.read(1)  # Reads the checksum at the end of a gzip file.
        except BAD_NIFTI:
            raise damaged(entry, f"it lacks a part of its {columns} x {rows} x {slices} voxels") from None
        _check_missing(missing, voxels.hu.size)
        reject_beyond(beyond, voxels.hu.size)
    warnings = [*header.place.warnings, *value_warnings(voxels.hu)]
    if missing:
        warnings.append(
            Remark(
                code="CT_VALUES_NAN",
                message=f"{missing} voxels are NaN and were set to {PADDING_HU} HU",
                context={"missing": missing, "padding_hu": PADDING_HU},
            )
        )
    if beyond:
        warnings.append(clipped_warning(beyond))
    warnings.append(
        Remark(
            code="CT_PATIENT_NOT_NAMED",
            message="a NIfTI file does not identify the patient",
            remedy=OF_THIS_PATIENT,
        )
    )
    return Ct(
        volume=Volume(hu=voxels.hu, lps_from_ijk=header.place.lps_from_ijk),
        series=_described(header, entry),
        warnings=tuple(warnings),
        left_out=(),
    )


def _fill(
    voxels: Voxels, header: NiftiHeader, file: IO[bytes], progress: Progress, first: FirstSlice
) -> tuple[int, int]:
    """Read all slices in order; return the number of NaN voxels and of voxels outside the range."""
    slices = header.shape_ijk[2]
    stored = ArrayProxy(file, (header.shape_ijk, header.stored, header.offset, 1.0, 0.0), mmap=False)
    missing = beyond = 0
    for start in range(0, slices, SLICES_PER_READ):
        some = np.asarray(stored[:, :, start : start + SLICES_PER_READ]).transpose(2, 1, 0)
        hu, lacking, lost = _hounsfield(some, header)
        voxels.hu[start : start + SLICES_PER_READ] = hu
        if start <= slices // 2 < start + SLICES_PER_READ:
            first(slice_as_scanned(voxels.hu[slices // 2], header.place.lps_from_ijk, slices // 2))
        missing += lacking
        beyond += lost
        progress(min(start + SLICES_PER_READ, slices), slices)
    return missing, beyond


def _hounsfield(
    stored: npt.NDArray[np.generic], header: NiftiHeader
) -> tuple[npt.NDArray[np.int16], int, int]:
    """Return HU of stored values, the number of NaN values, and the number outside the range."""
    if header.slope == 1.0 and header.intercept == 0.0 and stored.dtype == np.int16:
        return stored.astype(np.int16), 0, 0
    values = stored.astype(np.float64) * header.slope + header.intercept
    lacking = np.isnan(values)
    count = int(np.count_nonzero(lacking))
    if count:
        values[lacking] = PADDING_HU
    np.rint(values, out=values)
    lost = int(np.count_nonzero((values < MIN_HU) | (values > MAX_HU)))
    return np.clip(values, MIN_HU, MAX_HU).astype(np.int16), count, lost


def _check_missing(missing: int, voxels: int) -> None:
    if missing > MAX_NAN_RATIO * voxels:
        raise InvalidInput(
            "CT_VALUES_MISSING",
            f"{missing} of {voxels} voxels are NaN, the maximum is {MAX_NAN_RATIO:.0%}",
            CONVERT_AGAIN,
            {"missing": missing, "voxels": voxels, "max_ratio": MAX_NAN_RATIO},
        )
