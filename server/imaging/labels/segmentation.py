"""Reading of labels from a DICOM Segmentation (PS3.3, A.51): one binary frame for each segment and slice."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import pydicom
from pydicom.dataset import Dataset
from pydicom.pixels.utils import iter_pixels
from pydicom.uid import UID, RLELossless

from server.imaging.container import Entry
from server.imaging.dicom.frame import MAX_FRAMES
from server.imaging.dicom.header import BAD_DICOM, DEFLATED, number, numbers, text, without_warnings
from server.imaging.labels.label_image import LabelImage
from server.imaging.labels.names import LEVEL_OF_SNOMED
from server.imaging.nifti.affine import MAX_VOXEL_MM, MIN_VOXEL_MM
from server.imaging.voxels import check_voxels
from tracker.errors import InvalidInput
from tracker.geometry import Array
from tracker.plan.labels import CLASS_OF_LEVEL, level_from_name

SEGMENTATION = "1.2.840.10008.5.1.4.1.1.66.4"
# DICOM writes positions as decimal text.
MAX_OFF_PLANE_RATIO = 0.05
EXPORT_AGAIN = "Export the segmentation again as binary, uncompressed DICOM SEG, or as NIfTI."
# The unpacked size of a compressed file is bounded by that of its frames; a larger file has other content.
MAX_FILE_BYTES = 2**30


@dataclass(frozen=True, slots=True, kw_only=True)
class _SegmentFrame:
    """One frame: its place in the file, the class number of its segment, and its first pixel in LPS mm."""

    index: int
    class_number: int
    position_mm: Array


def is_segmentation(entry: Entry) -> bool:
    """Return whether a file is a DICOM Segmentation."""
    try:
        if _is_deflated(entry):
            return SEGMENTATION.encode() in entry.head()
        with without_warnings(), entry.open() as file:
            meta = pydicom.dcmread(file, specific_tags=["SOPClassUID"], stop_before_pixels=True)
    except BAD_DICOM:
        return False
    return text(meta, "SOPClassUID") == SEGMENTATION


def _is_deflated(entry: Entry) -> bool:
    """Return whether a file is compressed as a whole; pydicom would unpack all of it, whatever its size."""
    return DEFLATED in entry.head()


def read_segmentation(entry: Entry, names: Mapping[int, int]) -> LabelImage:
    """Read a DICOM Segmentation.

    The level of a segment is that of its number in `names`, else that of its SNOMED CT code, else that of its
    label (`L3`, `vertebrae_L3`).

    Raises:
        InvalidInput: SEGMENTATION_UNREADABLE, SEGMENTATION_GEOMETRY, CT_TOO_LARGE.
    """
    if entry.size > MAX_FILE_BYTES:
        raise _unreadable(f"its {entry.size / 2**20:.0f} MiB exceed {MAX_FILE_BYTES / 2**20:.0f} MiB")
    try:
        if _is_deflated(entry):
            raise _unreadable("it is deflated")
        with without_warnings(), entry.open() as file:
            dataset = pydicom.dcmread(file)
            _check_readable(dataset)
            return _read(dataset, names)
    except InvalidInput:
        raise
    except BAD_DICOM:
        raise _unreadable("it is truncated or damaged") from None


def _check_readable(dataset: Dataset) -> None:
    syntax = UID(text(dataset.file_meta, "TransferSyntaxUID"))
    if syntax.is_encapsulated and syntax != RLELossless:
        raise _unreadable(f"it is compressed as {syntax.name}")
    kind = text(dataset, "SegmentationType").upper()
    if kind != "BINARY" or int(number(dataset, "BitsAllocated", 0)) != 1:
        raise _unreadable(f"its type is {kind[:16] or 'unknown'}, not BINARY with one bit a pixel")
    frames = int(number(dataset, "NumberOfFrames", 0))
    groups = dataset.get("PerFrameFunctionalGroupsSequence")
    if not 0 < frames <= MAX_FRAMES or groups is None or len(groups) != frames:
        raise _unreadable(f"it states {frames} frames, allowed are 1 to {MAX_FRAMES} with a position each")
    rows, columns = int(number(dataset, "Rows", 0)), int(number(dataset, "Columns", 0))
    if rows < 2 or columns < 2 or "PixelData" not in dataset:
        raise _unreadable("it has no pixels")
    if not syntax.is_encapsulated and len(dataset.PixelData) < (rows * columns * frames + 7) // 8:
        raise _unreadable("it lacks a part of its pixels")


def _read(dataset: Dataset, names: Mapping[int, int]) -> LabelImage:
    classes = _classes(dataset, names)
    frames = _frames(dataset, classes)
    rows, columns = int(dataset.Rows), int(dataset.Columns)
    shared = dataset.get("SharedFunctionalGroupsSequence")
    groups = [*(shared or []), dataset.PerFrameFunctionalGroupsSequence[0]]
    across = _across(groups)
    normal = np.cross(across[:, 0], across[:, 1])
    normal /= np.linalg.norm(normal)
    heights = np.array([one.position_mm @ normal for one in frames])
    step_mm = _step_mm(groups, heights)
    places = (heights - heights.min()) / step_mm
    off = float(np.abs(places - np.rint(places)).max())
    lowest = frames[int(heights.argmin())].position_mm
    drift = [
        one.position_mm - lowest - (h - heights.min()) * normal
        for one, h in zip(frames, heights, strict=True)
    ]
    off_mm = float(np.linalg.norm(drift, axis=1).max())
    if (
        off > MAX_OFF_PLANE_RATIO
        or off_mm > MAX_OFF_PLANE_RATIO * np.linalg.norm(across, axis=0).min() * 10.0
    ):
        raise InvalidInput(
            "SEGMENTATION_GEOMETRY",
            f"the frames of the segmentation do not lie on one grid: {off:.2f} of a slice beside it, "
            f"{off_mm:.2f} mm within a slice",
            EXPORT_AGAIN,
            {"off": off, "off_mm": off_mm},
        )
    shape = (int(np.rint(places).max()) + 1, rows, columns)
    check_voxels(shape)
    labels = np.zeros(shape, dtype=np.uint8)
    _fill(labels, dataset, frames, np.rint(places).astype(int))
    affine = np.eye(4)
    affine[:3] = np.column_stack([across, step_mm * normal, lowest])
    return LabelImage(
        labels=labels,
        lps_from_ijk=affine,
        source="dicom",
        is_named=True,
        others=sum(not one for one in classes.values()),
    )


def _classes(dataset: Dataset, names: Mapping[int, int]) -> dict[int, int]:
    """Return the class number of each segment; 0 if it is no vertebra."""
    found = {}
    for segment in dataset.get("SegmentSequence") or []:
        segment_number = int(number(segment, "SegmentNumber", 0))
        found[segment_number] = names.get(segment_number, 0) if names else _class_of(segment)
    if not any(found.values()):
        raise InvalidInput(
            "LABELS_MISSING",
            f"none of the {len(found)} segments is named after a vertebra by its code or label",
            "State the level of each segment as number:level, for example 1:L3,2:L4.",
            {"segments": len(found)},
        )
    return found


def _class_of(segment: Dataset) -> int:
    for keyword in ("SegmentedPropertyTypeCodeSequence", "AnatomicRegionSequence"):
        for code in segment.get(keyword) or []:
            level = LEVEL_OF_SNOMED.get(text(code, "CodeValue"))
            if level is not None:
                return CLASS_OF_LEVEL[level]
    level = level_from_name(text(segment, "SegmentLabel"))
    return 0 if level is None else CLASS_OF_LEVEL[level]


def _frames(dataset: Dataset, classes: Mapping[int, int]) -> list[_SegmentFrame]:
    """Return the frames of vertebrae."""
    found = []
    shared = [*(dataset.get("SharedFunctionalGroupsSequence") or [])]
    for index, group in enumerate(dataset.PerFrameFunctionalGroupsSequence):
        # What all frames have in common, such as their only segment, may be stated once.
        groups = [group, *shared]
        segment_number = int(
            (_first(groups, "SegmentIdentificationSequence", "ReferencedSegmentNumber", 1) or (0,))[0]
        )
        class_number = classes.get(segment_number, 0)
        if class_number == 0:
            continue
        position = _first(groups, "PlanePositionSequence", "ImagePositionPatient", 3)
        if not position or np.abs(position).max() > 1e5:
            raise _unreadable("a frame has no position")
        found.append(_SegmentFrame(index=index, class_number=class_number, position_mm=np.array(position)))
    if not found:
        raise _unreadable("no frame belongs to a vertebra")
    return found


def _across(groups: list[Dataset]) -> Array:
    """Return the steps (3, 2) to the next column and to the next row, in mm."""
    directions = _first(groups, "PlaneOrientationSequence", "ImageOrientationPatient", 6)
    pixel = _first(groups, "PixelMeasuresSequence", "PixelSpacing", 2)
    if not directions or not pixel:
        raise _unreadable("it does not state direction and size of its pixels")
    row, column = np.array(directions[:3]), np.array(directions[3:])
    is_plane = np.abs([row @ row - 1.0, column @ column - 1.0, row @ column]).max() < 1e-3
    if not is_plane or not MIN_VOXEL_MM <= min(pixel) <= max(pixel) <= MAX_VOXEL_MM:
        raise _unreadable("direction or size of its pixels is not valid")
    # DICOM states the distance between rows first.
    return np.column_stack([row * pixel[1], column * pixel[0]])


def _step_mm(groups: list[Dataset], heights: Array) -> float:
    """Return the distance between slices; the smallest between frames if it is not stated."""
    stated = _first(groups, "PixelMeasuresSequence", "SpacingBetweenSlices", 1)
    apart = np.diff(np.unique(np.round(heights, 3)))
    thickness = _first(groups, "PixelMeasuresSequence", "SliceThickness", 1)
    step_mm = stated[0] if stated else float(apart.min()) if len(apart) else (thickness or (0.0,))[0]
    if not MIN_VOXEL_MM <= step_mm <= MAX_VOXEL_MM:
        raise _unreadable("the distance between its slices is not valid")
    return float(step_mm)


def _first(groups: list[Dataset], sequence: str, keyword: str, count: int) -> tuple[float, ...]:
    for group in groups:
        for one in group.get(sequence) or []:
            found = numbers(one, keyword, count)
            if found and np.isfinite(found).all():
                return found
    return ()


def _fill(
    labels: npt.NDArray[np.uint8],
    dataset: Dataset,
    frames: list[_SegmentFrame],
    places: npt.NDArray[np.int64],
) -> None:
    pixels = iter_pixels(dataset, indices=[one.index for one in frames], raw=True)
    for frame, place, image in zip(frames, places, pixels, strict=True):
        labels[place][image > 0] = frame.class_number


def _unreadable(why: str) -> InvalidInput:
    return InvalidInput(
        "SEGMENTATION_UNREADABLE",
        f"the DICOM segmentation cannot be read: {why}",
        EXPORT_AGAIN,
        {"segmentation_problem": why},
    )
