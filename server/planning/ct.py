"""What reads an upload, in a process of its own: a first slice to look at, then the voxels in a file."""

import dataclasses
from collections.abc import Mapping
from pathlib import Path

import cv2

from server.imaging import Ct, SeriesDescription, list_series, read_ct
from server.jobs import Report
from tracker.errors import InvalidInput
from tracker.plan.slices import WINDOWS, Slice, shown

VOXELS, PREVIEW = "voxels.npy", "preview.png"
# The least that a series is told by; its identifier is in no document.
TOLD_OF_SERIES = tuple(
    field.name for field in dataclasses.fields(SeriesDescription) if field.name not in {"series", "patient"}
)


def read_upload(report: Report, *, path: str, folder: str, series: str | None) -> dict[str, object]:
    """Read what was sent; gives the CT's content, or the series to choose from where there are several.

    Args:
        report: told how far it is.
        path: of the upload.
        folder: takes the voxels, and the first slice as a picture.
        series: the one that was chosen, if one was.
    """
    report(0.0, "looking at what was sent")

    def slices_read(done: int, of: int) -> None:
        report(done / of, f"{done} of {of} slices are read")

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
    """A CT as its document says it, without its voxels and without anything that names the patient."""
    told: Mapping[str, object] = dataclasses.asdict(ct.series)
    return {
        "shape_ijk": list(ct.volume.shape_ijk),
        "lps_from_ijk": ct.volume.lps_from_ijk.tolist(),
        "description": {name: told[name] for name in TOLD_OF_SERIES},
        "warnings": list(ct.warnings),
        "left_out": [dataclasses.asdict(one) for one in ct.left_out],
    }


def _show(one: Slice, folder: Path) -> None:
    """Write the slice as a picture that is there whole or not at all."""
    part = folder / f"part-{PREVIEW}"  # its ending tells the format
    if cv2.imwrite(str(part), shown(one.hu, WINDOWS["bone"])):
        part.replace(folder / PREVIEW)
