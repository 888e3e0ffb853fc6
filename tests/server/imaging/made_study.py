"""A CT series with its study, labels of two vertebrae in it, and a reader of segmentations."""

import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pydicom
from pydicom.dataset import Dataset

from server.imaging.dicom_objects import SourceSeries, plan_objects, read_source
from tests.server.imaging.made_ct import Made, enhanced_of, file_of, made_ct
from tests.tracker.plan.label_phantoms import labelled_spine
from tracker.geometry import Array
from tracker.plan import PlanDocument, Volume
from tracker.plan.labels import CLASS_OF_LEVEL, LabelVolume

STUDY = "1.2.826.0.1.3680043.8.498.3003"
# In ISO 8859-1, which is no UTF-8.
PATIENT = "Quibblé^Hörtensia"


def made_study(*, count: int = 12, size_wh: tuple[int, int] = (24, 20), **kinds: Any) -> Made:  # noqa: ANN401  keywords of `made_ct`
    """A series of 12 slices with patient and study as a scanner writes them."""
    made = made_ct(count=count, size_wh=size_wh, **kinds)
    for one in made.slices:
        one.SpecificCharacterSet, one.PatientName, one.PatientSex = "ISO_IR 100", PATIENT, "F"
        one.StudyInstanceUID, one.StudyDate, one.StudyTime = STUDY, "20260102", "101112"
        one.StudyID, one.AccessionNumber, one.ReferringPhysicianName = "7", "A-9", "Doc^Tor"
    return made


def enhanced_study(folder: Path) -> Path:
    """The same series as one file of many frames."""
    folder.mkdir()
    (folder / "one").write_bytes(file_of(enhanced_of(made_study())))
    return folder


def labels_of(source: SourceSeries) -> LabelVolume:
    """Boxes named L3 and L4 in a part of the CT, in the order of the patient's axes."""
    columns, rows = source.size_wh_px
    volume = Volume(
        hu=np.zeros((len(source.frames), rows, columns), np.int16), lps_from_ijk=source.stack.lps_from_ijk
    ).in_patient_order()
    labels = np.zeros(volume.hu.shape, dtype=np.uint8)
    k, j, i = (size // 2 for size in labels.shape)
    labels[1:k, 2:j, 3:i] = CLASS_OF_LEVEL["L4"]
    labels[k : k + 3, 4 : j + 1, 2:i] = CLASS_OF_LEVEL["L3"]
    start = np.array([2, 2, 1])
    affine = volume.lps_from_ijk.copy()
    affine[:3, 3] = volume.lps_from_index(start)
    return LabelVolume(labels=labels[1:, 2:, 2:].copy(), lps_from_ijk=affine, voxel_mm=2.0)


def points_of(labels: LabelVolume, level: str) -> Array:
    """Centres (n, 3) of the voxels of a label in LPS mm, sorted."""
    k, j, i = np.nonzero(labels.labels == CLASS_OF_LEVEL[level])
    return _sorted(labels.lps_from_index(np.stack([i, j, k], axis=1)))


def written(folder: Path, source: SourceSeries, plan: PlanDocument, **more: Any) -> dict[str, Dataset]:  # noqa: ANN401  keywords of `plan_objects`
    """The objects of a plan, read from their files by pydicom alone."""
    found: dict[str, Dataset] = {}
    for one in plan_objects(source, plan, version="0.1.0", **more):
        path = folder / one.file_name
        path.write_bytes(one.content)
        found[one.name] = pydicom.dcmread(path)
    return found


@dataclass(frozen=True, slots=True, kw_only=True)
class SegmentFrame:
    """A frame of a segmentation: label, places of its pixels in LPS mm, and the slice that it is of."""

    level: str
    points_mm: Array
    position_mm: Array
    source_uid: str


def frames_of_segmentation(one: Dataset) -> list[SegmentFrame]:
    """The frames by the text of DICOM PS3.3, C.7.6.2.1.1, bit by bit."""
    bits = np.unpackbits(np.frombuffer(one.PixelData, np.uint8), bitorder="little")
    pixels = bits[: one.NumberOfFrames * one.Rows * one.Columns].reshape(-1, one.Rows, one.Columns)
    shared = one.SharedFunctionalGroupsSequence[0]
    direction = np.array(shared.PlaneOrientationSequence[0].ImageOrientationPatient, float).reshape(2, 3)
    between_rows, between_columns = map(float, shared.PixelMeasuresSequence[0].PixelSpacing)
    names = {each.SegmentNumber: each.SegmentLabel for each in one.SegmentSequence}
    frames = []
    for image, group in zip(pixels, one.PerFrameFunctionalGroupsSequence, strict=True):
        position = np.array(group.PlanePositionSequence[0].ImagePositionPatient, float)
        rows, columns = np.nonzero(image)
        points = (
            position
            + columns[:, None] * between_columns * direction[0]
            + rows[:, None] * between_rows * direction[1]
        )
        segment = group if "SegmentIdentificationSequence" in group else shared
        source = group.DerivationImageSequence[0].SourceImageSequence[0]
        frames.append(
            SegmentFrame(
                level=names[segment.SegmentIdentificationSequence[0].ReferencedSegmentNumber],
                points_mm=points,
                position_mm=position,
                source_uid=source.ReferencedSOPInstanceUID,
            )
        )
    return frames


def segmented_points(frames: list[SegmentFrame], level: str) -> Array:
    """Centres (n, 3) of the pixels of a segment in LPS mm, sorted."""
    return _sorted(np.concatenate([one.points_mm for one in frames if one.level == level]))


def stl_corners(content: bytes) -> Array:
    """Corners (n, 3, 3) of the triangles of a binary STL."""
    (count,) = struct.unpack_from("<I", content, 80)
    assert len(content) >= 84 + 50 * count
    rows = np.frombuffer(content, np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]), count, 84)
    return np.array(rows["v"], dtype=np.float64)


def source_of(folder: Path, made: Made) -> SourceSeries:
    """The series, written and read."""
    return read_source(made.write(folder / "ct"))


def _sorted(points: Array) -> Array:
    return points[np.lexsort(np.round(points, 4).T)]


def labelled_study() -> tuple[Made, LabelVolume]:
    """A DICOM series of a vertebra, as coarse as its checks allow, and its labels."""
    volume, labels = labelled_spine(("L3",), spacing_mm=(2.0, 2.0, 2.0))
    slices, rows, columns = volume.hu.shape
    made = made_study(count=slices, size_wh=(columns, rows), pixel_mm=(2.0, 2.0))
    made.stored = (volume.hu + 1024).astype(np.uint16)
    for k, one in enumerate(made.slices):
        one.ImagePositionPatient = volume.lps_from_index([0, 0, k]).tolist()
        one.PixelData = made.stored[k].tobytes()
    return made, labels
