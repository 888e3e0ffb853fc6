"""Job function that reads a segmentation, places its labels on the CT, and writes them to a file.

The DICOM packages are imported by the job only, because they take three quarters of a second of a start.
"""

from pathlib import Path
from typing import TYPE_CHECKING

from server.imaging.labels.names import names_from_text
from server.jobs import Report
from server.planning.volume import load_volume
from tracker.plan.document import plain

if TYPE_CHECKING:
    from server.imaging.labels.placement import PlacedLabels

UPLOAD, LABELS = "upload", "labels.nii.gz"


def read_labels(
    report: Report, *, folder: str, ct_path: str, lps_from_ijk: list[list[float]], names: str
) -> dict[str, object]:
    """Job: read the upload in `folder`, write its labels beside it, return the content of the document."""
    from server.imaging.labels.label_file import label_file_bytes  # noqa: PLC0415  see above
    from server.imaging.labels.placement import labels_on_ct  # noqa: PLC0415  see above
    from server.imaging.labels.reader import read_label_images  # noqa: PLC0415  see above

    report(0.0, "reading the segmentation")

    def files_read(done: int, of: int) -> None:
        report(0.8 * done / of, f"{done} of {of} files read")

    images = read_label_images(Path(folder) / UPLOAD, names=names_from_text(names), progress=files_read)
    placed = labels_on_ct(images, load_volume(ct_path, lps_from_ijk))
    report(0.9, "storing the labels")
    (Path(folder) / LABELS).write_bytes(label_file_bytes(placed.volume))
    return labels_content(placed)


def labels_content(placed: "PlacedLabels") -> dict[str, object]:
    """Return the content of the document of labels."""
    return {
        "source": placed.source,
        "source_voxel_mm": list(placed.source_voxel_mm),
        "voxel_mm": placed.volume.voxel_mm,
        "contrast_hu": placed.contrast_hu,
        "vertebrae": [plain(one) for one in placed.vertebrae],
        "warnings": [plain(one) for one in placed.warnings],
    }
