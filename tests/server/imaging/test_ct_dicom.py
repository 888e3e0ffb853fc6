"""Slices are read to the voxel, however they are stored, named, ordered and tilted."""

import zipfile
from pathlib import Path

import numpy as np
import pytest
from pydicom import uid

from server.imaging.ct_reader import list_series, read_ct
from tests.server.imaging.made_ct import Made, enhanced_of, file_of, made_ct
from tracker.plan.slices import Slice

LOSSLESS = [
    uid.ImplicitVRLittleEndian,
    uid.ExplicitVRLittleEndian,
    uid.ExplicitVRBigEndian,
    uid.DeflatedExplicitVRLittleEndian,
    uid.RLELossless,
    uid.JPEGLosslessSV1,
    uid.JPEGLSLossless,
    uid.JPEG2000Lossless,
]


def assert_whole(made: Made, path: Path) -> None:
    """Every voxel and every slice's position are as created."""
    ct = read_ct(path)
    assert np.array_equal(ct.volume.hu, made.hu)
    for k, one in enumerate(made.slices):
        across = np.array(one.ImageOrientationPatient[:3], float) * float(one.PixelSpacing[1])
        down = np.array(one.ImageOrientationPatient[3:], float) * float(one.PixelSpacing[0])
        place = np.array(one.ImagePositionPatient, float)
        assert ct.volume.lps_from_index([0, 0, k]) == pytest.approx(place, abs=1e-4)
        assert ct.volume.lps_from_index([7, 5, k]) == pytest.approx(place + 7 * across + 5 * down, abs=1e-4)


@pytest.mark.parametrize("syntax", LOSSLESS, ids=lambda syntax: syntax.name)
def test_every_lossless_compression_gives_every_voxel(tmp_path: Path, syntax: uid.UID) -> None:
    made = made_ct()
    assert_whole(made, made.write(tmp_path, syntax=syntax))


@pytest.mark.parametrize(
    "syntax",
    [
        uid.ExplicitVRLittleEndian,
        uid.JPEG2000Lossless,
        uid.JPEGLSLossless,
        uid.JPEGLosslessSV1,
        uid.RLELossless,
    ],
    ids=lambda syntax: syntax.name,
)
def test_signed_pixels_keep_their_sign(tmp_path: Path, syntax: uid.UID) -> None:
    made = made_ct()
    for k, one in enumerate(made.slices):
        one.PixelRepresentation, one.BitsStored, one.HighBit, one.RescaleIntercept = 1, 16, 15, 0
        one.PixelData = made.hu[k].astype(np.int16).tobytes()
    assert_whole(made, made.write(tmp_path, syntax=syntax))


TURN = np.radians(20.0)
STACKS = {
    "tilted-gantry": {"directions": (1, 0, 0, 0, np.cos(TURN), -np.sin(TURN)), "step_lps": (0, 0, 2.0)},
    "oblique": {"directions": (np.cos(TURN), np.sin(TURN), 0, -np.sin(TURN), np.cos(TURN), 0)},
    "sagittal": {"directions": (0, 1, 0, 0, 0, -1)},
    "coronal": {"directions": (1, 0, 0, 0, 0, -1)},
    "feet-first": {"directions": (-1, 0, 0, 0, 1, 0)},
    "half-a-millimetre": {"spacing_mm": 0.5},
}


@pytest.mark.parametrize("stack", STACKS.values(), ids=STACKS.keys())
def test_slices_lie_where_their_files_say(tmp_path: Path, stack: dict) -> None:  # pyrefly: ignore[implicit-any-type-argument]  # keywords
    made = made_ct(**stack)
    assert_whole(made, made.write(tmp_path))


def test_a_tilted_gantry_is_reported(tmp_path: Path) -> None:
    ct = read_ct(made_ct(**STACKS["tilted-gantry"]).write(tmp_path))
    assert any("tilted by 20.0 deg" in said.message for said in ct.warnings)


def test_slices_come_in_any_order_and_any_folder_among_other_files(tmp_path: Path) -> None:
    made = made_ct()
    for index, place in enumerate((3, 0, 4, 1, 2)):
        folder = tmp_path / "disc" / f"S{index % 2}"
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"{index}.dcm").write_bytes(file_of(made.slices[place]))
    (tmp_path / "disc" / "notes.dcm").write_text("not an image")
    (tmp_path / "disc" / "empty.dcm").write_bytes(b"")
    (tmp_path / "DICOMDIR").write_bytes(b"index")
    (tmp_path / ".DS_Store").write_bytes(b"hidden")
    assert_whole(made, tmp_path)
    left_out = {one.reason: one.count for one in read_ct(tmp_path).left_out}
    assert left_out == {"files that are not DICOM": 1, "empty files": 1}


def test_a_zip_is_read_like_its_folder(tmp_path: Path) -> None:
    made = made_ct()
    with zipfile.ZipFile(tmp_path / "ct.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        for index, one in enumerate(made.slices):
            archive.writestr(f"QUIBBLE HORTENSIA/{index}", file_of(one))
        archive.writestr("inner.zip", b"PK")
    assert_whole(made, tmp_path / "ct.zip")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["ct.zip"]


@pytest.mark.parametrize("how", ["file", "zip"])
def test_an_enhanced_file_holds_all_its_slices(tmp_path: Path, how: str) -> None:
    made = made_ct()
    path = tmp_path / "many.dcm"
    path.write_bytes(file_of(enhanced_of(made)))
    if how == "zip":
        with zipfile.ZipFile(tmp_path / "many.zip", "w", zipfile.ZIP_DEFLATED) as archive:
            archive.write(path, "many.dcm")
        path = tmp_path / "many.zip"
    assert_whole(made, path)


def test_each_slice_has_its_own_rescale(tmp_path: Path) -> None:
    made = made_ct()
    made.slices[2].RescaleSlope, made.slices[2].RescaleIntercept = 0.5, -500.25
    hu = read_ct(made.write(tmp_path)).volume.hu
    assert np.array_equal(hu[2], np.rint(made.stored[2] * 0.5 - 500.25))
    assert np.array_equal(hu[3], made.hu[3])


def test_what_the_scanner_did_not_measure_is_air(tmp_path: Path) -> None:
    made = made_ct()
    stored = made.stored[1].copy()
    stored[:3] = 63536
    made.slices[1].PixelData = stored.tobytes()
    for one in made.slices:
        one.add_new("PixelPaddingValue", "US", 63536)
    hu = read_ct(made.write(tmp_path)).volume.hu
    assert (hu[1, :3] == -1024).all()
    assert np.array_equal(hu[1, 3:], made.hu[1, 3:])


def test_bits_above_those_stored_are_not_hounsfield_units(tmp_path: Path) -> None:
    made = made_ct()
    for k, one in enumerate(made.slices):
        one.PixelData = (made.stored[k] | 0xF000).tobytes()
    assert_whole(made, made.write(tmp_path))


def test_one_name_written_in_two_ways_is_one_patient(tmp_path: Path) -> None:
    made = made_ct()
    made.slices[1].PatientName = "QUIBBLE^HORTENSIA^^"
    made.slices[2].PatientName = "Quibble^Hortensia=\u7530\u4e2d"
    for one in made.slices:
        one.SpecificCharacterSet = "ISO_IR 192"
    assert_whole(made, made.write(tmp_path))


def test_slices_that_are_there_twice_are_used_once(tmp_path: Path) -> None:
    made = made_ct()
    folder = made.write(tmp_path)
    (folder / "copy").write_bytes(file_of(made.slices[1]))
    assert_whole(made, folder)
    assert any("1 slices are duplicates" in said.message for said in read_ct(folder).warnings)


def test_a_small_jitter_is_tolerated_and_reported(tmp_path: Path) -> None:
    made = made_ct()
    made.slices[2].ImagePositionPatient = [-10, 20, 304.05]
    ct = read_ct(made.write(tmp_path))
    assert any("0.05 mm from even spacing" in said.message for said in ct.warnings)


def test_a_scout_takes_no_part(tmp_path: Path) -> None:
    made, scout = made_ct(), made_ct(count=1, directions=(1, 0, 0, 0, 0, -1))
    scout.slices[0].ImageType = ["ORIGINAL", "PRIMARY", "LOCALIZER"]
    scout.write(tmp_path / "scout")
    made.write(tmp_path / "slices")
    assert_whole(made, tmp_path)


def test_the_only_ct_among_other_series_is_taken(tmp_path: Path) -> None:
    made = made_ct()
    made.write(tmp_path / "ct")
    other = made_ct(series="1.2.3.9", number=2)
    for one in other.slices:
        one.Modality = "MR"
    other.write(tmp_path / "mr")
    made_ct(series="1.2.3.10", number=3, count=2).write(tmp_path / "few")
    assert_whole(made, tmp_path)
    reported = {one.series: (one.modality, one.images, one.problem) for one in list_series(tmp_path)}
    assert reported["1.2.3.9"] == ("MR", 5, "it is MR, not CT")


def test_the_series_that_is_asked_for_is_read(tmp_path: Path) -> None:
    made_ct().write(tmp_path / "one")
    second = made_ct(series="1.2.3.9", number=2)
    second.write(tmp_path / "two")
    ct = read_ct(tmp_path, series="1.2.3.9")
    assert np.array_equal(ct.volume.hu, second.hu)
    assert ct.series.series == "1.2.3.9"


def test_progress_ends_with_all_slices(tmp_path: Path) -> None:
    heard: list[tuple[int, int]] = []
    read_ct(made_ct().write(tmp_path), progress=lambda done, of: heard.append((done, of)))
    assert heard == [(done, 5) for done in range(1, 6)]


@pytest.mark.parametrize("syntax", [uid.ExplicitVRLittleEndian, uid.JPEGLSLossless], ids=lambda one: one.name)
def test_a_slice_of_the_middle_is_seen_before_the_others_are_read(tmp_path: Path, syntax: uid.UID) -> None:
    made, seen, heard = made_ct(), list[Slice](), list[int]()

    def first(one: Slice) -> None:
        seen.append(one)
        heard.append(0)

    folder = made.write(tmp_path, syntax=syntax)
    read_ct(folder, first=first, progress=lambda done, _of: heard.append(done))
    assert heard == [0, 1, 2, 3, 4, 5]
    assert np.array_equal(seen[0].hu, made.hu[2])
    assert seen[0].lps_from_pixel([7, 5]) == pytest.approx([-10 + 7 * 0.75, 20 + 5 * 0.5, 304])


def test_a_series_named_after_the_patient_loses_its_words(tmp_path: Path) -> None:
    made = made_ct()
    for one in made.slices:
        one.SeriesDescription = "Mrs Quibble spine"
    ct = read_ct(made.write(tmp_path))
    assert "quibble" not in repr(ct).casefold()
    assert "HQ-77135" not in repr(ct)


def test_the_voxels_are_mapped_from_their_file(tmp_path: Path) -> None:
    made = made_ct()
    folder = made.write(tmp_path / "ct")
    ct = read_ct(folder, into=tmp_path / "voxels.npy")
    assert isinstance(ct.volume.hu, np.memmap)
    assert np.array_equal(np.load(tmp_path / "voxels.npy"), made.hu)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["ct", "voxels.npy"]
