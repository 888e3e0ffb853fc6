"""Reading of a CT series from DICOM files: selection, checks, sorting, and pixel data."""

from collections import Counter
from pathlib import Path

import numpy as np

from server.imaging.container import Container
from server.imaging.ct import Ct, FirstSlice, Progress, SeriesDescription, slice_as_scanned
from server.imaging.dicom.consistency import check_consistency, series_warnings
from server.imaging.dicom.frame import Frame
from server.imaging.dicom.hounsfield import hounsfield
from server.imaging.dicom.pixels import stored_images
from server.imaging.dicom.series import check_one_patient, choose, describe, group_frames_by_series
from server.imaging.plausibility import reject_beyond, value_warnings
from server.imaging.voxels import Voxels, voxels_to_fill
from tracker.errors import InvalidInput, Remark
from tracker.plan import Volume
from tracker.plan.stack import Stack, stack_slices


def list_dicom(container: Container, progress: Progress) -> tuple[SeriesDescription, ...]:
    """Return all series in these files."""
    return describe(group_frames_by_series(container, progress))


def read_dicom(
    container: Container, *, series: str | None, progress: Progress, first: FirstSlice, into: Path | None
) -> Ct:
    """Return the requested series, or the only CT, as Hounsfield units in LPS mm."""
    found = group_frames_by_series(container, lambda _done, _of: None)
    frames, stack = checked_series(found, series)
    columns, rows = frames[0].shared.size_wh_px
    with voxels_to_fill((len(stack.slices), rows, columns), into) as voxels:
        beyond = _fill(voxels, frames, stack, progress, first)
        reject_beyond(beyond, voxels.hu.size)
    description = next(one for one in describe(found) if one.series == frames[0].shared.series)
    warnings = [*series_warnings(frames, stack, beyond), *value_warnings(voxels.hu)]
    if len(found) > 1:
        others = len(found) - 1
        warnings.append(
            Remark(
                code="CT_OTHER_SERIES",
                message=f"{others} other series were found and are not used",
                context={"others": others},
            )
        )
    warnings += [
        Remark(
            code="CT_FILES_EXCLUDED",
            message=f"excluded: {one.reason} ({one.count})",
            context={"excluded_files": one.reason, "count": one.count},
        )
        for one in container.left_out
    ]
    return Ct(
        volume=Volume(hu=voxels.hu, lps_from_ijk=stack.lps_from_ijk),
        series=description,
        warnings=tuple(warnings),
        left_out=container.left_out,
    )


def checked_series(found: dict[str, list[Frame]], series: str | None) -> tuple[list[Frame], Stack]:
    """Return the slices of the requested series, or of the only CT, with their common geometry."""
    check_one_patient([frame for frames in found.values() for frame in frames], what="the folder")
    frames = choose(found, series)
    check_consistency(frames)
    return frames, stack_slices(
        positions_lps_mm=np.array([frame.position_lps_mm for frame in frames]),
        directions=np.array([frame.directions for frame in frames]).reshape(-1, 2, 3),
        # DICOM states the distance between rows first.
        pixels_mm=np.array([frame.pixel_mm for frame in frames])[:, ::-1],
        size_wh_px=frames[0].shared.size_wh_px,
    )


def _fill(voxels: Voxels, frames: list[Frame], stack: Stack, progress: Progress, first: FirstSlice) -> int:
    """Read every slice to its position; return the number of values outside the range."""
    place = {index: k for k, members in enumerate(stack.slices) for index in members}
    middle = len(stack.slices) // 2
    order = sorted(place, key=lambda index: (place[index] != middle, place[index]))
    written: set[int] = set()
    differing: Counter[int] = Counter()
    beyond = 0
    for done, (at, image) in enumerate(stored_images([frames[index] for index in order]), start=1):
        index = order[at]
        hu, lost = hounsfield(image, frames[index])
        k = place[index]
        if k in written:
            differing[k] += int(not np.array_equal(voxels.hu[k], hu))
        else:
            voxels.hu[k] = hu
            beyond += lost
        if done == 1:
            first(slice_as_scanned(voxels.hu[k], stack.lps_from_ijk, k))
        written.add(k)
        progress(done, len(frames))
    places = sum(count > 0 for count in differing.values())
    if places:
        raise InvalidInput(
            "CT_SLICES_CONTRADICT",
            f"{places} of {len(stack.slices)} positions have several slices with different pixels: the "
            "series contains more than one pass (phase, energy or kernel)",
            "Export one pass as a separate series, and give only that series.",
            {"places": places, "slices": len(frames), "positions": len(stack.slices)},
        )
    return beyond
