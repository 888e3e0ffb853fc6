"""Builders of CT files with one defect each."""

import zipfile
from collections.abc import Callable
from pathlib import Path

import nibabel as nib
import numpy as np
from pydicom import uid

from tests.server.imaging.made_ct import Made, file_of, made_ct, nifti_of

Case = Callable[[Path], Path]
HU = np.random.default_rng(5).integers(-1000, 2000, (6, 7, 8)).astype(np.int16)


def spoilt(
    spoil: Callable[[Made], object], *, syntax: str = uid.ExplicitVRLittleEndian, count: int = 6
) -> Case:
    """A folder of slices with one change."""

    def make(folder: Path) -> Path:
        made = made_ct(count=count)
        spoil(made)
        return made.write(folder / "ct", syntax=syntax)

    return make


def every(keyword: str, value: object) -> Callable[[Made], object]:
    def change(made: Made) -> None:
        for each in made.slices:
            setattr(each, keyword, value)

    return change


def one(keyword: str, value: object) -> Callable[[Made], object]:
    return lambda made: setattr(made.slices[2], keyword, value)


def without(*keywords: str) -> Callable[[Made], object]:
    return lambda made: [made.slices[2].pop(keyword) for keyword in keywords]


def two_series(folder: Path) -> Path:
    made_ct().write(folder / "one")
    made_ct(series="1.2.3.9", number=2).write(folder / "two")
    return folder


def two_patients(folder: Path) -> Path:
    made_ct().write(folder / "one")
    other = made_ct(series="1.2.3.9", number=2)
    every("PatientID", "X-1")(other)
    other.write(folder / "two")
    return folder


def not_a_number(made: Made) -> None:
    made.slices[2].add_new("PixelPaddingValue", "FD", float("nan"))


def contradicting(made: Made) -> None:
    made.slices[3].ImagePositionPatient = made.slices[2].ImagePositionPatient


def scattered(made: Made) -> None:
    for k, each in enumerate(made.slices):
        each.ImagePositionPatient = [-10, 20, 300 + 2.0 * k + 0.3 * k * k]


def shifted(made: Made) -> None:
    for k, each in enumerate(made.slices):
        each.ImagePositionPatient = [-10 + (1.0 if k % 2 else 0.0), 20, 300 + 2.0 * k]


def beside(made: Made) -> None:
    made.slices[2].ImagePositionPatient = [-7, 20, 302]


def steep(made: Made) -> None:
    for k, each in enumerate(made.slices):
        each.ImagePositionPatient = [-10, 20 + 5.0 * k, 300 + 2.0 * k]


def truncated(keep: float, syntax: str = uid.ExplicitVRLittleEndian) -> Case:
    def make(folder: Path) -> Path:
        path = spoilt(lambda _: None, syntax=syntax)(folder)
        content = (path / "IM0002").read_bytes()
        (path / "IM0002").write_bytes(content[: int(len(content) * keep)])
        return path

    return make


def damaged(syntax: str) -> Case:
    """The codestream of one slice is overwritten; its decoder may crash."""

    def make(folder: Path) -> Path:
        path = spoilt(lambda _: None, syntax=syntax)(folder)
        content = bytearray((path / "IM0002").read_bytes())
        start = content.find(b"\xe0\x7f\x10\x00") + 40
        content[start : start + 60] = bytes(range(60))
        (path / "IM0002").write_bytes(bytes(content))
        return path

    return make


def text_file(folder: Path) -> Path:
    (folder / "slice.dcm").write_text("This is a letter, not a slice.\n" * 40)
    return folder


def lone_file(content: bytes, name: str = "ct.dcm") -> Case:
    def make(folder: Path) -> Path:
        (folder / name).write_bytes(content)
        return folder / name

    return make


def zipped(*names: str, content: bytes = b"x" * 400) -> Case:
    def make(folder: Path) -> Path:
        with zipfile.ZipFile(folder / "ct.zip", "w", zipfile.ZIP_DEFLATED) as archive:
            for name in names:
                archive.writestr(name, content)
        return folder / "ct.zip"

    return make


def zip_changed(at: int, value: bytes) -> Case:
    """A zip whose directory has a changed value at one place of each entry."""

    def make(folder: Path) -> Path:
        path = zipped("IM1", "IM2", "IM3", content=file_of(made_ct(count=1).slices[0]))(folder)
        content = bytearray(path.read_bytes())
        place = -1
        while (place := content.find(b"PK\x01\x02", place + 1)) >= 0:
            content[place + at : place + at + len(value)] = value
        path.write_bytes(bytes(content))
        return path

    return make


def zip_damaged(folder: Path) -> Path:
    path = folder / "ct.zip"
    with zipfile.ZipFile(path, "w") as archive:
        for index, each in enumerate(made_ct().slices):
            archive.writestr(f"IM{index}", file_of(each))
    content = bytearray(path.read_bytes())
    content[900] ^= 0xFF
    path.write_bytes(bytes(content))
    return path


def cut_zip(folder: Path) -> Path:
    path = zipped("IM1")(folder)
    path.write_bytes(path.read_bytes()[:70])
    return path


def nifti(
    hu: np.ndarray = HU,
    affine: np.ndarray | None = None,
    *,
    change: Callable[[nib.Nifti1Header], object] = lambda _: None,
    keep: int | None = None,
    patch: tuple[int, bytes] = (0, b""),
    also: tuple[int, bytes] = (0, b""),
) -> Case:
    content = bytearray(
        nifti_of(hu, np.diag([2.0, 2.0, 2.0, 1.0]) if affine is None else affine, change=change)
    )
    for at, value in (patch, also):
        content[at : at + len(value)] = value
    return lone_file(bytes(content[:keep]), "ct.nii")


def mirrored(header: nib.Nifti1Header) -> None:
    header.set_qform(np.diag([-2.0, 2.0, 2.0, 1.0]), code=1)
