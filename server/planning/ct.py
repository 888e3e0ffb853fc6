"""Job function that reads an uploaded CT: a preview slice first, then the voxels into a file.

The DICOM packages are imported by the job only, because they take three quarters of a second of a start.
"""

import dataclasses
from collections.abc import Mapping
from pathlib import Path

import cv2

from server.imaging import Ct, SeriesDescription
from server.jobs import Report
from tracker.errors import InvalidInput
from tracker.plan.document import plain
from tracker.plan.slices import WINDOWS, Slice, shown

VOXELS, PREVIEW = "voxels.npy", "preview.png"
# Fields of a series in the document of a CT; its UID is omitted.
SERIES_FIELDS = tuple(
    field.name for field in dataclasses.fields(SeriesDescription) if field.name not in {"series", "patient"}
)


def read_upload(report: Report, *, path: str, folder: str, series: str | None) -> dict[str, object]:
    """Read an upload; return the content of the CT, or the list of series if there are several.

    Args:
        report: progress callback.
        path: path of the upload.
        folder: output folder for the voxels and the preview.
        series: the chosen series, if any.
    """
    from server.imaging.ct_reader import list_series, read_ct  # noqa: PLC0415  see above

    report(0.0, "reading the upload")

    def slices_read(done: int, of: int) -> None:
        report(done / of, f"{done} of {of} slices read")

    try:
        ct = read_ct(
            Path(path),
            series=series,
            progress=slices_read,
            first=lambda one: _show(one, Path(folder)),
            into=Path(folder) / VOXELS,
        )
    except InvalidInput as error:
        if series is not None or error.code != "CT_SERIES_UNCLEAR":
            raise
        return {"series": [dataclasses.asdict(one) for one in list_series(Path(path))]}
    return {"ct": ct_content(ct)}


def ct_content(ct: Ct) -> dict[str, object]:
    """Return the content of a CT document, without voxels and patient data."""
    description: Mapping[str, object] = dataclasses.asdict(ct.series)
    return {
        "shape_ijk": list(ct.volume.shape_ijk),
        "lps_from_ijk": ct.volume.lps_from_ijk.tolist(),
        "description": {name: description[name] for name in SERIES_FIELDS},
        "warnings": [plain(one) for one in ct.warnings],
        "left_out": [dataclasses.asdict(one) for one in ct.left_out],
    }


def _show(one: Slice, folder: Path) -> None:
    """Write the preview image atomically."""
    part = folder / f"part-{PREVIEW}"  # the suffix selects the format
    if cv2.imwrite(str(part), shown(one.hu, WINDOWS["bone"])):
        part.replace(folder / PREVIEW)
