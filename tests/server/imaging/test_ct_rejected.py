"""Every rejected CT with its error code: the whole table."""

import struct
from pathlib import Path

import numpy as np
import pytest
from pydicom import uid

from server.imaging.ct_reader import list_series, read_ct
from tests.server.imaging.made_ct import BORN, NAME, NUMBER, enhanced_of, file_of, made_ct, nifti_of
from tests.server.imaging.spoilt_ct import (
    HU,
    Case,
    beside,
    contradicting,
    cut_zip,
    damaged,
    every,
    lone_file,
    mirrored,
    nifti,
    not_a_number,
    one,
    scattered,
    shifted,
    spoilt,
    steep,
    text_file,
    truncated,
    two_patients,
    two_series,
    without,
    zip_changed,
    zip_damaged,
    zipped,
)
from tracker.errors import InvalidInput

TABLE: dict[str, tuple[str, Case]] = {
    "nothing-there": ("CT_NOT_THERE", lambda folder: folder / "nowhere"),
    "empty-folder": ("CT_EMPTY", lambda folder: folder),
    "empty-file": ("CT_NO_DICOM", lone_file(b"")),
    "text-named-dcm": ("CT_NO_DICOM", text_file),
    "a-picture": ("CT_NO_DICOM", lone_file(b"\x89PNG\r\n\x1a\n" + bytes(500))),
    "random-bytes": ("CT_NO_DICOM", lone_file(np.random.default_rng(1).bytes(5000))),
    "mark-of-dicom-and-nothing-else": ("CT_FILE_DAMAGED", lone_file(bytes(128) + b"DICM")),
    "mark-of-dicom-and-rubbish": ("CT_FILE_DAMAGED", lone_file(bytes(128) + b"DICM" + b"\xff" * 900)),
    "header-cut-off": ("CT_FILE_DAMAGED", truncated(0.3)),
    **{f"cut-off-at-{at}": ("CT_FILE_DAMAGED", truncated(at / 100)) for at in (18, 25, 40)},
    "pixels-cut-off": ("CT_SLICE_TRUNCATED", truncated(0.9)),
    "jpeg-2000-cut-off": ("CT_SLICE_TRUNCATED", truncated(0.85, uid.JPEG2000Lossless)),
    "jpeg-ls-cut-off": ("CT_SLICE_TRUNCATED", truncated(0.85, uid.JPEGLSLossless)),
    "jpeg-ls-damaged": ("CT_SLICE_DAMAGED", damaged(uid.JPEGLSLossless)),
    "jpeg-lossless-damaged": ("CT_SLICE_DAMAGED", damaged(uid.JPEGLosslessSV1)),
    "jpeg-2000-damaged": ("CT_SLICE_DAMAGED", damaged(uid.JPEG2000Lossless)),
    "rle-damaged": ("CT_SLICE_DAMAGED", damaged(uid.RLELossless)),
    "without-pixels": ("CT_SLICE_TRUNCATED", spoilt(without("PixelData"))),
    "one-slice": ("CT_TOO_FEW_SLICES", spoilt(lambda _: None, count=1)),
    "all-at-one-place": ("CT_TOO_FEW_SLICES", spoilt(every("ImagePositionPatient", [0, 0, 0]))),
    "a-slice-missing": ("CT_SLICES_MISSING", spoilt(lambda made: made.slices.pop(3))),
    "uneven-spacing": ("CT_SPACING_UNEVEN", spoilt(scattered)),
    "one-slice-off": ("CT_SPACING_UNEVEN", spoilt(one("ImagePositionPatient", [-10, 20, 304.3]))),
    "shifted-in-their-planes": ("CT_SLICES_SHIFTED", spoilt(shifted)),
    "two-beside-each-other": ("CT_SLICES_SHIFTED", spoilt(beside)),
    "sheared-too-far": ("CT_TILT_TOO_LARGE", spoilt(steep)),
    "turned-slice": (
        "CT_DIRECTIONS_DIFFER",
        spoilt(one("ImageOrientationPatient", [1, 0, 0, 0, 0.98, 0.199])),
    ),
    "no-right-angle": (
        "CT_DIRECTIONS_INVALID",
        spoilt(every("ImageOrientationPatient", [1, 0, 0, 0.5, 0.8, 0])),
    ),
    "no-direction-at-all": ("CT_DIRECTIONS_INVALID", spoilt(every("ImageOrientationPatient", [0] * 6))),
    "another-pixel-size": ("CT_PIXELS_DIFFER", spoilt(one("PixelSpacing", [0.6, 0.75]))),
    "no-pixel-size": ("CT_PIXELS_INVALID", spoilt(every("PixelSpacing", [0, 0]))),
    "pixels-of-a-metre": ("CT_PIXELS_INVALID", spoilt(every("PixelSpacing", [1000, 1000]))),
    "another-size": ("CT_SIZES_DIFFER", spoilt(one("Rows", 11))),
    "huge-declared-size": ("CT_PIXELS_INVALID", spoilt(lambda made: [every("Rows", 65535)(made)])),
    "position-missing": ("CT_GEOMETRY_MISSING", spoilt(without("ImagePositionPatient"))),
    "direction-missing": ("CT_GEOMETRY_MISSING", spoilt(without("ImageOrientationPatient"))),
    "pixel-size-missing": ("CT_GEOMETRY_MISSING", spoilt(without("PixelSpacing"))),
    "two-frames-of-reference": ("CT_SPACES_DIFFER", spoilt(one("FrameOfReferenceUID", "1.2.3"))),
    "twice-with-other-pixels": ("CT_SLICES_CONTRADICT", spoilt(contradicting, count=4)),
    "two-patient-ids": ("CT_PATIENTS_MIXED", spoilt(one("PatientID", "OTHER-9"))),
    "two-patient-names": ("CT_PATIENTS_MIXED", spoilt(one("PatientName", "Someone^Else"))),
    "two-birth-dates": ("CT_PATIENTS_MIXED", spoilt(one("PatientBirthDate", "20010101"))),
    "two-patients-in-two-series": ("CT_PATIENTS_MIXED", two_patients),
    "two-series": ("CT_SERIES_UNCLEAR", two_series),
    "an-mr": ("CT_NOT_CT", spoilt(every("Modality", "MR"))),
    "a-pet": ("CT_NOT_CT", spoilt(every("Modality", "PT"))),
    "only-scouts": ("CT_NO_DICOM", spoilt(every("ImageType", ["ORIGINAL", "PRIMARY", "LOCALIZER"]))),
    "only-screenshots": ("CT_NO_DICOM", spoilt(every("SOPClassUID", "1.2.840.10008.5.1.4.1.1.7"))),
    "colours": ("CT_NO_DICOM", spoilt(every("SamplesPerPixel", 3))),
    "no-rescale": ("CT_RESCALE_MISSING", spoilt(without("RescaleSlope", "RescaleIntercept"))),
    "slope-of-nothing": ("CT_RESCALE_MISSING", spoilt(one("RescaleSlope", 0))),
    "slope-that-clips-nearly-all": ("CT_VALUES_BEYOND", spoilt(every("RescaleSlope", 1000))),
    "intercept-that-clips-all": ("CT_VALUES_BEYOND", spoilt(every("RescaleIntercept", -(2**20)))),
    "nifti-scaled-beyond-all-hu": ("CT_VALUES_BEYOND", nifti(patch=(112, struct.pack("<ff", 1e6, 0.0)))),
    "iodine-map": ("CT_NOT_HU", spoilt(every("RescaleType", "MGML"))),
    "padding-that-is-no-number": ("CT_FILE_DAMAGED", spoilt(not_a_number)),
    "odd-bits": ("CT_PIXELS_UNKNOWN", spoilt(every("HighBit", 14))),
    "unknown-compression": (
        "CT_COMPRESSION_UNKNOWN",
        lone_file(
            file_of(enhanced_of(made_ct())).replace(b"1.2.840.10008.1.2.1\0", b"1.2.840.10008.9.9.9\0")
        ),
    ),
    "frames-without-a-place": (
        "CT_NO_DICOM",
        lone_file(file_of(enhanced_of(made_ct())).replace(b"\x00\x52\x30\x92SQ", b"\x00\x52\x31\x92SQ")),
    ),
    "zip-leading-out": ("CT_ARCHIVE_UNSAFE", zipped("../../evil.dcm")),
    "zip-with-absolute-names": ("CT_ARCHIVE_UNSAFE", zipped("/etc/evil.dcm")),
    "zip-with-drive-letters": ("CT_ARCHIVE_UNSAFE", zipped("C:\\evil.dcm")),
    "zip-in-zip": ("CT_EMPTY", zipped("inner.zip")),
    "empty-zip": ("CT_EMPTY", zipped()),
    "encrypted-zip": ("CT_ARCHIVE_ENCRYPTED", zip_changed(8, b"\x01\x00")),
    "zip-bomb": ("CT_ARCHIVE_TOO_LARGE", zip_changed(24, b"\xf0\xff\xff\xff")),
    "zip-damaged-inside": ("CT_FILE_DAMAGED", zip_damaged),
    "zip-packed-in-an-unknown-way": ("CT_FILE_DAMAGED", zip_changed(10, b"\x63\x00")),
    "zip-cut-off": ("CT_ARCHIVE_BROKEN", cut_zip),
    "nifti-without-affine": ("CT_AFFINE_MISSING", nifti(patch=(252, struct.pack("<hh", 0, 0)))),
    "nifti-of-an-atlas": ("CT_ATLAS_SPACE", nifti(patch=(252, struct.pack("<hh", 0, 4)))),
    "nifti-mirrored-by-one-affine": ("CT_AFFINES_CONTRADICT", nifti(change=mirrored)),
    "nifti-flat": (
        "CT_AFFINE_INVALID",
        nifti(patch=(252, struct.pack("<hh", 0, 1)), also=(280, struct.pack("<12f", *[2, 2, 0, 0] * 3))),
    ),
    "nifti-in-metres-without-saying-so": (
        "CT_VOXEL_SIZE_ODD",
        nifti(affine=np.diag([0.001, 0.001, 0.001, 1.0])),
    ),
    "nifti-over-time": ("CT_NOT_ONE_VOLUME", nifti(np.zeros((4, 4, 4, 3), np.int16))),
    "nifti-of-one-slice": ("CT_NOT_ONE_VOLUME", nifti(np.zeros((4, 4, 1), np.int16))),
    "nifti-of-complex-numbers": ("CT_PIXELS_UNKNOWN", nifti(HU.astype(np.complex64))),
    "nifti-of-nothing": ("CT_VALUES_MISSING", nifti(np.full((4, 4, 4), np.nan, np.float32))),
    "nifti-cut-off": ("CT_FILE_DAMAGED", nifti(keep=600)),
    "nifti-header-cut-off": ("CT_NO_DICOM", nifti(keep=200)),
    "nifti-huge": ("CT_TOO_LARGE", nifti(patch=(42, struct.pack("<hhh", 32000, 32000, 32000)))),
    "nifti-of-minus-sizes": ("CT_NOT_ONE_VOLUME", nifti(patch=(42, struct.pack("<hhh", -5, 7, 8)))),
    "nifti-pair": ("CT_NIFTI_PAIR", nifti(patch=(344, b"ni1\0"))),
    "nifti-of-unknown-numbers": ("CT_FILE_DAMAGED", nifti(patch=(70, struct.pack("<h", 77)))),
}


@pytest.mark.parametrize(("code", "make"), TABLE.values(), ids=TABLE.keys())
def test_a_ct_that_cannot_be_trusted_is_rejected(code: str, make: Case, tmp_path: Path) -> None:
    given, into = tmp_path / "given", tmp_path / "stored"
    given.mkdir()
    into.mkdir()
    with pytest.raises(InvalidInput) as caught:
        read_ct(make(given), into=into / "voxels.npy")
    error = caught.value
    assert error.code == code
    # Nothing is stored, nobody is named, and there is a remedy.
    assert list(into.iterdir()) == []
    reported = f"{error} {error.context}".casefold()
    for secret in (
        *NAME.casefold().split("^"),
        BORN,
        NUMBER.casefold(),
        "someone",
        "else",
        "other-9",
        str(tmp_path),
    ):
        assert secret not in reported
    assert len(error.remedy) > 10
    assert not error.message[0].isupper()


def test_a_series_that_is_not_there_is_rejected(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput) as caught:
        read_ct(made_ct().write(tmp_path), series="1.2.3")
    assert caught.value.code == "CT_SERIES_UNKNOWN"
    known = caught.value.context["series"]
    assert isinstance(known, list)
    assert known
    assert all(series in caught.value.remedy for series in known)


def test_a_missing_slice_is_reported_in_numbers(tmp_path: Path) -> None:
    with pytest.raises(
        InvalidInput, match=r"1 of 6 slices are missing: after slice 3 of 5.* 4\.000 mm.* 2\.000 mm"
    ):
        read_ct(TABLE["a-slice-missing"][1](tmp_path))


def test_what_cannot_be_planned_on_can_still_be_listed(tmp_path: Path) -> None:
    assert [series.patient for series in list_series(two_patients(tmp_path))] == [1, 2]


@pytest.mark.parametrize("kind", ["slice", "enhanced", "nifti"])
def test_wrong_bytes_in_a_header_never_end_in_a_traceback(kind: str, tmp_path: Path) -> None:
    made = made_ct(count=3)
    whole = {
        "slice": file_of(made.slices[1]),
        "enhanced": file_of(enhanced_of(made)),
        "nifti": nifti_of(HU, np.eye(4)),
    }[kind]
    folder = made.write(tmp_path) if kind == "slice" else tmp_path
    path = folder / "IM0001"
    outcomes = set()
    for seed in range(60):
        rng = np.random.default_rng(seed)
        content = bytearray(whole)
        for at in rng.integers(0, min(len(content), 1500 if kind != "nifti" else 400), 3):
            content[at] = rng.integers(256)
        path.write_bytes(bytes(content))
        try:
            read_ct(folder if kind == "slice" else path)
            outcomes.add("read")
        except InvalidInput as error:
            outcomes.add(error.code)
    assert "read" in outcomes
    assert len(outcomes) > 3
