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
        path: A folder or zip of DICOM slices, a multi-frame DICOM file, or NIfTI.
        series: Identifier of a series of `list_series`; required only if there are several CTs.
        progress: Called with the number of slices read and their total.
        first: Called with a middle slice as soon as it is read, because a compressed CT takes seconds.
        into: A `.npy` file that is written atomically and from which the voxels are then memory-mapped; None
            keeps them in memory.

    Raises:
        InvalidInput: a code beginning with CT_; the table of all of them is in the tests.
    """
    with open_container(path) as container:
        if _nifti_of(container):
            return read_nifti(container.entries[0], progress=progress, first=first, into=into)
        return read_dicom(container, series=series, progress=progress, first=first, into=into)


def _nifti_of(container: Container) -> bool:
    """Return whether the container is a single NIfTI file."""
    try:
        return len(container.entries) == 1 and is_nifti(container.entries[0].head())
    except BAD_ARCHIVE:
        return False  # The DICOM reader reports the damage.
