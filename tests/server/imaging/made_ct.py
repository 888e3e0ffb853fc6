"""Builders of CT files with known voxels and positions."""

import copy
import io
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import cast

import gdcm
import nibabel as nib
import numpy as np
import numpy.typing as npt
from pydicom import Dataset
from pydicom.dataset import FileMetaDataset
from pydicom.encaps import encapsulate, get_frame
from pydicom.uid import (
    UID,
    CTImageStorage,
    EnhancedCTImageStorage,
    ExplicitVRBigEndian,
    ExplicitVRLittleEndian,
    RLELossless,
    generate_uid,
)

NAME, BORN, NUMBER = "Quibble^Hortensia", "19610203", "HQ-77135"
SERIES = "1.2.826.0.1.3680043.8.498.1001"
SPACE = "1.2.826.0.1.3680043.8.498.2002"


@dataclass(kw_only=True)
class Made:
    """A series of slices in memory, which a test may change and then write."""

    stored: npt.NDArray[np.integer]
    slices: list[Dataset] = field(default_factory=list)

    @property
    def hu(self) -> npt.NDArray[np.int32]:
        return self.stored.astype(np.int32) - 1024

    def write(self, folder: Path, *, syntax: str = ExplicitVRLittleEndian) -> Path:
        folder.mkdir(parents=True, exist_ok=True)
        for index, one in enumerate(self.slices):
            (folder / f"IM{index:04d}").write_bytes(file_of(one, syntax))
        return folder


def made_ct(
    *,
    count: int = 5,
    size_wh: tuple[int, int] = (16, 12),
    spacing_mm: float = 2.0,
    step_lps: tuple[float, float, float] | None = None,
    directions: tuple[float, ...] = (1, 0, 0, 0, 1, 0),
    pixel_mm: tuple[float, float] = (0.5, 0.75),
    series: str = SERIES,
    number: int = 1,
) -> Made:
    """Slices of noise between -1000 and 2000 HU, stored as 12 bits; rows 0.5, columns 0.75 mm apart."""
    columns, rows = size_wh
    stored = np.random.default_rng(number).integers(24, 3024, (count, rows, columns)).astype(np.uint16)
    normal = np.cross(directions[:3], directions[3:])
    step = spacing_mm * normal if step_lps is None else np.array(step_lps)
    made = Made(stored=stored)
    for k in range(count):
        one = Dataset()
        one.SOPClassUID, one.SOPInstanceUID = CTImageStorage, generate_uid()
        one.Modality, one.ImageType = "CT", ["ORIGINAL", "PRIMARY", "AXIAL"]
        one.PatientName, one.PatientID, one.PatientBirthDate = NAME, NUMBER, BORN
        one.SeriesInstanceUID, one.FrameOfReferenceUID = series, SPACE
        one.SeriesNumber, one.InstanceNumber = number, count - k
        one.SeriesDescription = "Spine 2.0 bone"
        one.ImagePositionPatient = [f"{mm:.6g}" for mm in np.array([-10.0, 20.0, 300.0]) + step * k]
        one.ImageOrientationPatient = [f"{share:.10g}" for share in directions]
        one.PixelSpacing, one.SliceThickness = list(pixel_mm), spacing_mm
        one.Rows, one.Columns, one.SamplesPerPixel = rows, columns, 1
        one.PhotometricInterpretation = "MONOCHROME2"
        one.BitsAllocated, one.BitsStored, one.HighBit, one.PixelRepresentation = 16, 12, 11, 0
        one.RescaleSlope, one.RescaleIntercept, one.RescaleType = 1, -1024, "HU"
        one.PixelData = stored[k].tobytes()
        one["PixelData"].VR = "OW"
        made.slices.append(one)
    return made


def file_of(slice_: Dataset, syntax: str = ExplicitVRLittleEndian, *, content: bytes = b"") -> bytes:
    """The bytes of this slice's file, with precompressed pixels if given."""
    one = copy.deepcopy(slice_)
    one.file_meta = FileMetaDataset()
    one.file_meta.MediaStorageSOPClassUID = one.get("SOPClassUID", CTImageStorage)
    one.file_meta.MediaStorageSOPInstanceUID = one.get("SOPInstanceUID", generate_uid())
    one.file_meta.TransferSyntaxUID = UID(syntax)
    if one.file_meta.TransferSyntaxUID.is_encapsulated:
        one.PixelData = encapsulate([content or compressed(one, syntax)])
        one["PixelData"].VR = "OB"
    elif content:
        one.PixelData = content
    elif syntax == ExplicitVRBigEndian:
        one.PixelData = np.frombuffer(one.PixelData, "<u2").astype(">u2").tobytes()
    file = io.BytesIO()
    one.save_as(file, enforce_file_format=True)
    return file.getvalue()


def compressed(slice_: Dataset, syntax: str) -> bytes:
    """The pixels of a slice as one compressed image."""
    if syntax == RLELossless:
        one = copy.deepcopy(slice_)
        one.file_meta = FileMetaDataset()
        one.file_meta.TransferSyntaxUID = ExplicitVRLittleEndian
        one.compress(RLELossless, encoding_plugin="pydicom")
        return get_frame(one.PixelData, 0, number_of_frames=1)
    writer = gdcm.ImageWriter()
    image = writer.GetImage()
    image.SetNumberOfDimensions(2)
    image.SetDimensions((slice_.Columns, slice_.Rows, 1))
    image.SetPhotometricInterpretation(
        gdcm.PhotometricInterpretation(gdcm.PhotometricInterpretation.MONOCHROME2)
    )
    image.SetTransferSyntax(gdcm.TransferSyntax(gdcm.TransferSyntax.ImplicitVRLittleEndian))
    image.SetPixelFormat(
        gdcm.PixelFormat(1, 16, slice_.BitsStored, slice_.BitsStored - 1, slice_.PixelRepresentation)
    )
    element = gdcm.DataElement(gdcm.Tag(0x7FE0, 0x0010))
    element.SetByteStringValue(slice_.PixelData)
    image.SetDataElement(element)
    change = gdcm.ImageChangeTransferSyntax()
    change.SetTransferSyntax(gdcm.TransferSyntax(gdcm.TransferSyntax.GetTSType(str(syntax))))
    change.SetInput(image)
    assert change.Change()
    # Each refers to the previous one, which must outlive it.
    output = change.GetOutput()
    encoded = output.GetDataElement()
    fragments = encoded.GetSequenceOfFragments()
    assert fragments.GetNumberOfFragments() == 1
    fragment = fragments.GetFragment(0)
    value = fragment.GetByteValue()
    return cast("bytes", value.GetBuffer().encode("utf-8", "surrogateescape"))


def enhanced_of(made: Made) -> Dataset:
    """The same slices as one enhanced file of many frames, last frame first."""
    one = copy.deepcopy(made.slices[0])
    for keyword in (
        "ImagePositionPatient",
        "ImageOrientationPatient",
        "PixelSpacing",
        "RescaleSlope",
        "RescaleIntercept",
        "RescaleType",
        "SliceThickness",
    ):
        del one[keyword]
    one.SOPClassUID = EnhancedCTImageStorage
    one.NumberOfFrames = len(made.slices)
    shared, measures, directions, values = Dataset(), Dataset(), Dataset(), Dataset()
    measures.PixelSpacing = made.slices[0].PixelSpacing
    measures.SliceThickness = made.slices[0].SliceThickness
    directions.ImageOrientationPatient = made.slices[0].ImageOrientationPatient
    values.RescaleSlope, values.RescaleIntercept, values.RescaleType = 1, -1024, "HU"
    shared.PixelMeasuresSequence, shared.PlaneOrientationSequence = [measures], [directions]
    shared.PixelValueTransformationSequence = [values]
    one.SharedFunctionalGroupsSequence = [shared]
    groups = []
    for each in reversed(made.slices):
        group, place = Dataset(), Dataset()
        place.ImagePositionPatient = each.ImagePositionPatient
        group.PlanePositionSequence = [place]
        groups.append(group)
    one.PerFrameFunctionalGroupsSequence = groups
    one.PixelData = b"".join(each.PixelData for each in reversed(made.slices))
    one["PixelData"].VR = "OW"
    return one


def nifti_of(
    hu_ijk: npt.NDArray[np.generic],
    affine: npt.NDArray[np.float64],
    *,
    change: Callable[[nib.Nifti1Header], object] = lambda _: None,
) -> bytes:
    """The bytes of a NIfTI file; `change` may corrupt its header."""
    image = nib.Nifti1Image(hu_ijk, affine)
    image.header.set_xyzt_units("mm")
    change(image.header)
    return image.to_bytes()
