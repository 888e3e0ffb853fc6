"""The door: a CT out of whatever was handed in."""

from pathlib import Path

from server.imaging.container import BAD_ARCHIVE, Container, opened
from server.imaging.ct import Ct, FirstSlice, Progress, SeriesDescription, unheard, unseen
from server.imaging.dicom import list_dicom, read_dicom
from server.imaging.nifti import describe_nifti, is_nifti, read_nifti


def list_series(path: Path, *, progress: Progress = unheard) -> tuple[SeriesDescription, ...]:
    """Every series in a folder, zip or file, without anything that names the patient.

    Raises:
        InvalidInput: a code beginning with CT_; the table of all of them is in the tests.
    """
    with opened(path) as container:
        nifti = _nifti_of(container)
        if nifti:
            return (describe_nifti(container.entries[0]),)
        return list_dicom(container, progress)


def read_ct(
    path: Path,
    *,
    series: str | None = None,
    progress: Progress = unheard,
    first: FirstSlice = unseen,
    into: Path | None = None,
) -> Ct:
    """A CT as Hounsfield units, with the place of each voxel in LPS mm.

    Args:
        path: a folder or zip of DICOM slices, a DICOM file of many frames, or NIfTI.
        series: the identifier of one of `list_series`; needed only where there are several CTs.
        progress: called with how many slices were read, and of how many.
        first: called with a slice of the middle as soon as it is read; a compressed CT takes seconds.
        into: a `.npy` that is written whole or not at all, and from which the voxels are then mapped; in
            memory if left out.

    Raises:
        InvalidInput: a code beginning with CT_; the table of all of them is in the tests.
    """
    with opened(path) as container:
        if _nifti_of(container):
            return read_nifti(container.entries[0], progress=progress, first=first, into=into)
        return read_dicom(container, series=series, progress=progress, first=first, into=into)


def _nifti_of(container: Container) -> bool:
    """Whether this is one NIfTI file, and nothing else."""
    try:
        return len(container.entries) == 1 and is_nifti(container.entries[0].head())
    except BAD_ARCHIVE:
        return False  # Whoever reads it as slices will say that it is damaged.
