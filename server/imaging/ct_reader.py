"""Reading of a CT from a folder, a zip, or a file of DICOM or NIfTI."""

from pathlib import Path

from server.imaging.container import BAD_ARCHIVE, Container, open_container
from server.imaging.ct import Ct, FirstSlice, Progress, SeriesDescription, no_preview, no_progress
from server.imaging.dicom import list_dicom, read_dicom
from server.imaging.nifti import describe_nifti, is_nifti, read_nifti


def list_series(path: Path, *, progress: Progress = no_progress) -> tuple[SeriesDescription, ...]:
    """List the series in a folder, zip or file, without patient data.

    Raises:
        InvalidInput: a code beginning with CT_; the table of all of them is in the tests.
    """
    with open_container(path) as container:
        nifti = _nifti_of(container)
        if nifti:
            return (describe_nifti(container.entries[0]),)
        return list_dicom(container, progress)


def read_ct(
    path: Path,
    *,
    series: str | None = None,
    progress: Progress = no_progress,
    first: FirstSlice = no_preview,
    into: Path | None = None,
) -> Ct:
    """Read a CT in Hounsfield units, with its affine in LPS mm.

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
    with open_container(path) as container:
        if _nifti_of(container):
            return read_nifti(container.entries[0], progress=progress, first=first, into=into)
        return read_dicom(container, series=series, progress=progress, first=first, into=into)


def _nifti_of(container: Container) -> bool:
    """Whether this is one NIfTI file, and nothing else."""
    try:
        return len(container.entries) == 1 and is_nifti(container.entries[0].head())
    except BAD_ARCHIVE:
        return False  # The DICOM reader reports the damage.
