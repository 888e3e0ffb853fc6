"""Reading of vertebra labels from a file, a zip or a folder."""

from collections.abc import Iterator, Mapping
from pathlib import Path

from server.imaging.container import BAD_ARCHIVE, Container, Entry, open_container
from server.imaging.ct import Progress, no_progress
from server.imaging.labels.label_image import LabelImage
from server.imaging.labels.names import is_named_vertebra
from server.imaging.labels.nifti_labels import read_nifti_labels
from server.imaging.labels.segmentation import is_segmentation, read_segmentation
from server.imaging.nifti import is_nifti
from tracker.errors import InvalidInput

GIVE = (
    "Give one NIfTI file with all labels, the files vertebrae_L3.nii.gz and so on of TotalSegmentator, or a "
    "DICOM SEG."
)
# No segmentation has more files of vertebrae.
MAX_USED = 60


def read_label_images(
    path: Path, *, names: Mapping[int, int], progress: Progress = no_progress
) -> Iterator[LabelImage]:
    """Yield the images of labels in a NIfTI file, a DICOM SEG, or a zip or folder of them.

    Files that are neither, or that are named after no vertebra among several, are ignored.

    Args:
        path: file, zip or folder.
        names: class numbers of levels by the number of a label; empty for those that the file names.
        progress: called with the number of files read and their total.

    Raises:
        InvalidInput: LABELS_MISSING, or what the readers and `open_container` raise.
    """
    with open_container(path) as container:
        used = _used(container)
        for done, (entry, is_dicom) in enumerate(used):
            progress(done, len(used))
            yield read_segmentation(entry, names) if is_dicom else read_nifti_labels(entry, names)


def _used(container: Container) -> list[tuple[Entry, bool]]:
    """Return the files that have labels of vertebrae, and whether each is DICOM."""
    nifti, dicom = [], []
    for entry in container.entries:
        try:
            if is_nifti(entry.head()):
                nifti.append(entry)
            elif is_segmentation(entry):
                dicom.append(entry)
        except BAD_ARCHIVE:
            continue  # A damaged file is no label.
    if len(nifti) > 1:
        nifti = [entry for entry in nifti if is_named_vertebra(entry)]
    used = [*((entry, False) for entry in nifti), *((entry, True) for entry in dicom)]
    if not used or len(used) > MAX_USED:
        raise InvalidInput(
            "LABELS_MISSING",
            f"{len(used)} of {len(container.entries)} files are segmentations of vertebrae, expected 1 to "
            f"{MAX_USED}",
            GIVE,
            {"used": len(used), "files": len(container.entries), "max_used": MAX_USED},
        )
    return used
