"""Builders of segmentations: NIfTI of TotalSegmentator, one file for each vertebra, and DICOM SEG."""

import gzip
import io
import zipfile
from collections.abc import Mapping, Sequence

import nibabel as nib
import numpy as np
from pydicom import Dataset
from pydicom.sequence import Sequence as DicomSequence
from pydicom.uid import ExplicitVRLittleEndian, generate_uid

from server.imaging.labels.names import LEVEL_OF_SNOMED
from server.imaging.labels.segmentation import SEGMENTATION
from server.imaging.nifti.writer import RAS_FROM_LPS
from tests.server.imaging.made_ct import file_of
from tracker.plan.labels import CLASS_OF_LEVEL, Labels, LabelVolume


def label_nifti(volume: LabelVolume, *, names: Mapping[int, str] | None = None, dtype: str = "u1") -> bytes:
    """All labels in one .nii.gz, with a label table in an extension if it has names."""
    image = nib.Nifti1Image(
        volume.labels.transpose(2, 1, 0).astype(dtype), RAS_FROM_LPS @ volume.lps_from_ijk
    )
    image.set_sform(image.affine, code=1)
    image.set_qform(image.affine, code=1)
    image.header.set_xyzt_units("mm")
    if names is not None:
        rows = "".join(
            f'<Label Key="{key}" Red="1" Green="0" Blue="0" Alpha="1"><![CDATA[{name}]]></Label>'
            for key, name in names.items()
        )
        table = f'<?xml version="1.0"?><CaretExtension><LabelTable>{rows}</LabelTable></CaretExtension>'
        image.header.extensions.append(nib.nifti1.Nifti1Extension(0, table.encode()))
    return gzip.compress(image.to_bytes(), compresslevel=1, mtime=0)


def mask_of(volume: LabelVolume, level: str) -> LabelVolume:
    """The binary mask of one vertebra."""
    mask: Labels = (volume.labels == CLASS_OF_LEVEL[level]).astype(np.uint8)
    return LabelVolume(labels=mask, lps_from_ijk=volume.lps_from_ijk, voxel_mm=volume.voxel_mm)


def mask_zip(volume: LabelVolume, *, others: Sequence[str] = ("liver.nii.gz",)) -> bytes:
    """One file for each vertebra in a zip, named as TotalSegmentator does, and files of other organs."""
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        for level in volume.levels:
            archive.writestr(f"QUIBBLE/vertebrae_{level}.nii.gz", label_nifti(mask_of(volume, level)))
        for other in others:
            archive.writestr(f"QUIBBLE/{other}", label_nifti(volume))
    return content.getvalue()


def item(**values: object) -> Dataset:
    """A dataset with these attributes."""
    dataset = Dataset()
    for keyword, value in values.items():
        setattr(dataset, keyword, value)
    return dataset


def segmentation_of(volume: LabelVolume, *, coded: bool = True) -> Dataset:
    """DICOM SEG of the labels: only slices that have the segment, from the feet up, one bit a pixel."""
    code_of = {level: code for code, level in LEVEL_OF_SNOMED.items()}
    axes = volume.lps_from_ijk[:3, :3] / volume.spacing_mm
    one = item(
        SOPClassUID=SEGMENTATION,
        SOPInstanceUID=generate_uid(),
        Modality="SEG",
        PatientName="Quibble^Hortensia",
        SegmentationType="BINARY",
        Rows=volume.labels.shape[1],
        Columns=volume.labels.shape[2],
        SamplesPerPixel=1,
        PhotometricInterpretation="MONOCHROME2",
        BitsAllocated=1,
        BitsStored=1,
        HighBit=0,
        PixelRepresentation=0,
    )
    one.SegmentSequence = DicomSequence(
        item(
            SegmentNumber=n,
            SegmentLabel="bone" if coded else level,
            SegmentedPropertyTypeCodeSequence=DicomSequence(
                [
                    item(
                        CodeValue=code_of[level] if coded else "51282000",
                        CodingSchemeDesignator="SCT",
                        CodeMeaning="x",
                    )
                ]
            ),
        )
        for n, level in enumerate(volume.levels, start=1)
    )
    one.SharedFunctionalGroupsSequence = DicomSequence(
        [
            item(
                PlaneOrientationSequence=DicomSequence(
                    [item(ImageOrientationPatient=[f"{share:.10g}" for share in (*axes[:, 0], *axes[:, 1])])]
                ),
                PixelMeasuresSequence=DicomSequence(
                    [
                        item(
                            PixelSpacing=[float(volume.spacing_mm[1]), float(volume.spacing_mm[0])],
                            SliceThickness=float(volume.spacing_mm[2]),
                        )
                    ]
                ),
            )
        ]
    )
    groups, bits = [], []
    for n, level in enumerate(volume.levels, start=1):
        is_level = volume.labels == CLASS_OF_LEVEL[level]
        for k in np.flatnonzero(is_level.any(axis=(1, 2))):
            position = [f"{mm:.8g}" for mm in volume.lps_from_index([0, 0, int(k)])]
            groups.append(
                item(
                    SegmentIdentificationSequence=DicomSequence([item(ReferencedSegmentNumber=n)]),
                    PlanePositionSequence=DicomSequence([item(ImagePositionPatient=position)]),
                )
            )
            bits.append(is_level[k].ravel())
    one.PerFrameFunctionalGroupsSequence = DicomSequence(groups)
    one.NumberOfFrames = len(groups)
    packed = np.packbits(np.concatenate(bits), bitorder="little").tobytes()
    one.PixelData = packed + bytes(len(packed) % 2)
    one["PixelData"].VR = "OB"
    return one


def segmentation_file(dataset: Dataset) -> bytes:
    """The bytes of a DICOM SEG."""
    return file_of(dataset, ExplicitVRLittleEndian)
