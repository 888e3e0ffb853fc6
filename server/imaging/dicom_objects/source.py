"""The CT series that objects refer to: geometry and identifiers of its slices, and its study."""

import copy
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pydicom
from pydicom.dataset import Dataset

from server.imaging.container import Entry, open_container
from server.imaging.dicom.frame import Frame
from server.imaging.dicom.header import BAD_DICOM, text, without_warnings
from server.imaging.dicom.reader import checked_series
from server.imaging.dicom.series import group_frames_by_series
from tracker.errors import InvalidInput
from tracker.geometry import Array
from tracker.plan.stack import Stack

# Attributes of patient and study that each object of a study repeats (PS3.3, C.7.1.1, C.7.2.1, C.7.2.2).
IDENTITY = (
    "SpecificCharacterSet",
    "PatientName",
    "PatientID",
    "IssuerOfPatientID",
    "PatientBirthDate",
    "PatientSex",
    "PatientAge",
    "PatientSize",
    "PatientWeight",
    "StudyDate",
    "StudyTime",
    "StudyID",
    "StudyDescription",
    "AccessionNumber",
    "ReferringPhysicianName",
)
REFERENCE = (
    "SOPClassUID",
    "SOPInstanceUID",
    "StudyInstanceUID",
    "SeriesInstanceUID",
    "FrameOfReferenceUID",
    "Modality",
    "Rows",
    "Columns",
    "NumberOfFrames",
    "ImagePositionPatient",
    "ImageOrientationPatient",
    "PixelSpacing",
    "SliceThickness",
    "SharedFunctionalGroupsSequence",
    "PerFrameFunctionalGroupsSequence",
)
EXPORT_AGAIN = "Export the CT from the archive again, without anonymising or converting it."


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferencedFrame:
    """One slice of the volume: its file, as an index into `SourceSeries.images`, and its frame, from 1."""

    image: int
    frame_number: int
    is_multi_frame: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class SourceSeries:
    """A CT series as other objects refer to it.

    Attributes:
        images: headers of its files without patient and study, for highdicom.
        frames: for each slice of the volume.
        stack: geometry of the slices.
        size_wh_px: columns and rows.
        thickness_mm: as stated by the scanner; the spacing if it states none.
    """

    images: tuple[Dataset, ...]
    frames: tuple[ReferencedFrame, ...]
    stack: Stack
    size_wh_px: tuple[int, int]
    thickness_mm: float
    _identity: Dataset

    @property
    def series_uid(self) -> str:
        """Return the UID of the series."""
        return str(self.images[0].SeriesInstanceUID)

    @property
    def frame_of_reference_uid(self) -> str:
        """Return the UID of the patient's coordinates."""
        return str(self.images[0].FrameOfReferenceUID)

    def position_lps_mm(self, k: int) -> Array:
        """Return the centre (3,) of the first pixel of slice k, by the common affine."""
        return np.asarray(self.stack.lps_from_ijk[:3, 3] + k * self.stack.lps_from_ijk[:3, 2])

    def nearest_slice(self, point_lps_mm: npt.ArrayLike) -> int:
        """Return the index of the slice that is nearest to a point (3,)."""
        offset = np.asarray(point_lps_mm, dtype=np.float64) - self.stack.lps_from_ijk[:3, 3]
        k = float(np.linalg.solve(self.stack.lps_from_ijk[:3, :3], offset)[2])
        return int(np.clip(np.rint(k), 0, len(self.frames) - 1))

    def add_identity(self, dataset: Dataset) -> None:
        """Add patient and study to a finished object."""
        for element in self._identity:
            dataset.add(copy.deepcopy(element))


def read_source(path: Path, *, series: str | None = None) -> SourceSeries:
    """Read the headers of a CT series in a folder or zip of DICOM files.

    Raises:
        InvalidInput: DICOM_SOURCE_INCOMPLETE, DICOM_STUDIES_MIXED, or a code beginning with CT_.
    """
    with open_container(path) as container:
        frames, stack = checked_series(group_frames_by_series(container, lambda _done, _of: None), series)
        used = [frames[members[0]] for members in stack.slices]
        entries = list({id(frame.shared.entry): frame.shared.entry for frame in used}.values())
        headers = [_header(entry) for entry in entries]
    _check(headers)
    return SourceSeries(
        images=tuple(_part(header, REFERENCE) for header in headers),
        frames=tuple(_referenced(frame, entries) for frame in used),
        stack=stack,
        size_wh_px=used[0].shared.size_wh_px,
        thickness_mm=used[0].shared.thickness_mm or stack.spacing_mm,
        _identity=_part(headers[0], IDENTITY),
    )


def _header(entry: Entry) -> Dataset:
    try:
        with without_warnings(), entry.open() as file:
            header = pydicom.dcmread(
                file, stop_before_pixels=True, specific_tags=[*IDENTITY, *REFERENCE], force=True
            )
            header.decode()
    except BAD_DICOM:
        raise InvalidInput(
            "DICOM_SOURCE_INCOMPLETE",
            "the header of a slice has an attribute that cannot be read",
            EXPORT_AGAIN,
            {"attribute": "?"},
        ) from None
    return header


def _referenced(frame: Frame, entries: list[Entry]) -> ReferencedFrame:
    image = next(n for n, entry in enumerate(entries) if entry is frame.shared.entry)
    return ReferencedFrame(image=image, frame_number=frame.index + 1, is_multi_frame=frame.shared.frames > 1)


def _part(header: Dataset, keywords: tuple[str, ...]) -> Dataset:
    part = Dataset()
    for keyword in keywords:
        if keyword in header:
            part.add(copy.deepcopy(header[keyword]))
    return part


def _check(headers: list[Dataset]) -> None:
    for keyword in ("SOPClassUID", "SOPInstanceUID", "StudyInstanceUID", "FrameOfReferenceUID"):
        missing = sum(not text(header, keyword) for header in headers)
        if missing:
            raise InvalidInput(
                "DICOM_SOURCE_INCOMPLETE",
                f"{missing} of {len(headers)} files of the CT do not state their {keyword}, which objects of "
                "the same study refer to",
                EXPORT_AGAIN,
                {"missing": missing, "files": len(headers), "attribute": keyword},
            )
    studies = {text(header, "StudyInstanceUID") for header in headers}
    if len(studies) > 1:
        raise InvalidInput(
            "DICOM_STUDIES_MIXED",
            f"the files of the CT belong to {len(studies)} studies, expected 1",
            EXPORT_AGAIN,
            {"studies": len(studies)},
        )
