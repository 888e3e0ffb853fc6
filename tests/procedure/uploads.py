"""Uploads for tests: a phantom's CT as a zip of DICOM slices, and as NIfTI."""

import copy
import dataclasses
import functools
import io
import zipfile
from pathlib import Path

import numpy as np
from pydicom import Dataset
from pydicom.uid import ExplicitVRLittleEndian, generate_uid

from tests.server.imaging.made_ct import file_of, made_ct, nifti_of
from tracker.plan import Volume
from tracker.rehearsal.ct import ScanGrid, VertebraPhantom, scan
from tracker.rehearsal.ct.phantom import pedicle_tube, usual_bones


@functools.cache
def phantom() -> VertebraPhantom:
    """A vertebra with pedicles 9 mm and 8 mm wide."""
    return VertebraPhantom(
        pedicles={
            side: pedicle_tube(
                side,
                width_mm=width_mm,
                height_mm=13.0,
                transverse_deg=15.0,
                sagittal_deg=3.0,
                waist_mm=(15.0, -1.0, 3.0),
                widening_per_mm2=0.003,
            )
            for side, width_mm in (("left", 9.0), ("right", 8.0))
        },
        bones=usual_bones(),
    )


@functools.cache
def scanned() -> Volume:
    """CT of the phantom."""
    grid = ScanGrid.around(
        (0.0, -6.0, 0.0), size_mm=(72.0, 96.0, 40.0), spacing_mm=(0.8, 0.8, 1.0), blur_mm=0.3, noise_hu=15.0
    )
    # Few samples per voxel and a blur instead, to save time.
    return scan(phantom().hu_at, dataclasses.replace(grid, samples=(2, 2, 2)))


def dicom_slices(
    volume: Volume, *, series: str = "1.2.826.0.1.3680043.8.498.7", number: int = 1
) -> list[Dataset]:
    """The volume's slices as a scanner would store them."""
    columns, rows, slices = volume.shape_ijk
    template = made_ct(count=1, size_wh=(columns, rows), series=series, number=number).slices[0]
    axes = volume.lps_from_ijk[:3, :3] / volume.spacing_mm
    template.ImageOrientationPatient = [f"{share:.10g}" for share in (*axes[:, 0], *axes[:, 1])]
    template.PixelSpacing = [float(volume.spacing_mm[1]), float(volume.spacing_mm[0])]
    template.SliceThickness = float(volume.spacing_mm[2])
    made = []
    for k in range(slices):
        one = copy.deepcopy(template)
        one.SOPInstanceUID, one.InstanceNumber = generate_uid(), k + 1
        one.ImagePositionPatient = [f"{mm:.8g}" for mm in volume.lps_from_index([0, 0, k])]
        one.PixelData = (np.clip(volume.hu[k], -1024, 3071) + 1024).astype(np.uint16).tobytes()
        made.append(one)
    return made


def zip_of(*series: list[Dataset], syntax: str = ExplicitVRLittleEndian) -> bytes:
    """These series in one zip, in folders whose name must not be disclosed."""
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        for n, slices in enumerate(series):
            for k, one in enumerate(slices):
                archive.writestr(f"QUIBBLE_HORTENSIA/{n}/IM{k:04d}", file_of(one, syntax))
    return content.getvalue()


@functools.cache
def dicom_zip() -> bytes:
    """The phantom's CT as a zip of DICOM slices."""
    return zip_of(dicom_slices(scanned()))


def nifti(volume: Volume) -> bytes:
    """The volume as NIfTI, with permuted axes: left-right is the last."""
    ras = np.diag([-1.0, -1.0, 1.0, 1.0]) @ volume.lps_from_ijk
    # hu is (k, j, i): the file's first axis is k, its last is i.
    return nifti_of(np.ascontiguousarray(volume.hu), ras[:, [2, 1, 0, 3]])


def zip_of_folder(folder: Path) -> bytes:
    """A folder as one zip, or a single file unchanged."""
    if folder.is_file():
        return folder.read_bytes()
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        for path in sorted(folder.rglob("*")):
            if path.is_file():
                archive.write(path, path.relative_to(folder))
    return content.getvalue()
