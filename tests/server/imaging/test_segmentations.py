"""Segmentations of vertebrae: what is taken in, what it becomes on the CT, and what is rejected."""

import contextlib
import dataclasses
import functools
import gzip
import io
import tracemalloc
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import pytest
import scipy
from pydicom import Dataset
from pydicom.sequence import Sequence as DicomSequence
from pydicom.uid import DeflatedExplicitVRLittleEndian

from server.imaging.labels.label_file import label_file_bytes, load_label_file
from server.imaging.labels.names import names_from_text
from server.imaging.labels.placement import PlacedLabels, labels_on_ct
from server.imaging.labels.reader import read_label_images
from tests.server.imaging.made_ct import file_of
from tests.server.imaging.made_labels import (
    label_nifti,
    mask_of,
    mask_zip,
    segmentation_file,
    segmentation_of,
)
from tests.tracker.plan.label_phantoms import labelled_spine, three_levels
from tracker.errors import InvalidInput, NavigationError
from tracker.geometry import rotation_from_vector
from tracker.plan.labels import CLASS_OF_LEVEL, LabelVolume

Change: TypeAlias = Callable[[npt.NDArray[Any]], npt.NDArray[Any]]
LEVELS = ["L3", "L4", "L5"]


def true() -> LabelVolume:
    return three_levels()[1]


def numbered(change: Change, dtype: str = "u1") -> bytes:
    """The true labels with other numbers, as one file."""
    labels = change(true().labels.astype(np.int32))
    return label_nifti(dataclasses.replace(true(), labels=labels), dtype=dtype)


def valued(number: int, other: int) -> Change:
    """Give voxels of one number another one."""
    return lambda labels: np.where(labels == number, other, labels)


def moved(*shift_mm: float) -> LabelVolume:
    affine = true().lps_from_ijk.copy()
    affine[:3, 3] += shift_mm
    return dataclasses.replace(true(), lps_from_ijk=affine)


def taken(tmp_path: Path, content: bytes, *, names: str = "", name: str = "upload") -> PlacedLabels:
    path = tmp_path / name
    path.write_bytes(content)
    return labels_on_ct(read_label_images(path, names=names_from_text(names)), three_levels()[0])


def is_true(placed: PlacedLabels) -> bool:
    """Whether the labels are the true ones to the voxel."""
    whole = np.zeros_like(true().labels)
    start = np.rint(three_levels()[0].index_from_lps(placed.volume.lps_from_ijk[:3, 3])).astype(int)[::-1]
    whole[tuple(slice(a, a + n) for a, n in zip(start, placed.volume.labels.shape, strict=True))] = (
        placed.volume.labels
    )
    return bool((whole == true().labels).all())


@pytest.mark.parametrize(
    ("content", "names", "name"),
    [
        pytest.param(lambda: label_nifti(true()), "", "upload", id="one-file-of-totalsegmentator"),
        pytest.param(
            lambda: label_nifti(true(), dtype="f4"), "", "upload", id="whole-numbers-stored-as-float"
        ),
        pytest.param(lambda: mask_zip(true()), "", "upload", id="one-file-a-vertebra"),
        pytest.param(
            lambda: segmentation_file(segmentation_of(true())), "", "upload", id="dicom-seg-by-codes"
        ),
        pytest.param(
            lambda: segmentation_file(segmentation_of(true(), coded=False)),
            "",
            "upload",
            id="dicom-seg-by-labels",
        ),
        pytest.param(
            lambda: label_nifti(
                dataclasses.replace(true(), labels=np.where(true().labels > 0, true().labels - 26, 0)),
                names={1: "vertebrae_L5", 2: "vertebrae_L4", 3: "vertebrae_L3"},
            ),
            "",
            "upload",
            id="names-in-the-file",
        ),
        pytest.param(
            lambda: numbered(lambda one: np.where(one > 0, one + 300, 0), "i2"),
            "329:L3, 328:LWK 4, 327:vertebrae_L5",
            "upload",
            id="names-in-the-request",
        ),
    ],
)
def test_labels_are_taken_in_to_the_voxel(
    tmp_path: Path, content: Callable[[], bytes], names: str, name: str
) -> None:
    placed = taken(tmp_path, content(), names=names, name=name)
    assert [one.level for one in placed.vertebrae] == LEVELS
    assert is_true(placed)
    for one in placed.vertebrae:
        assert one.volume_ml == pytest.approx(62.0, abs=2.0)
        assert not one.is_cut
    assert [one.centroid_lps_mm[2] for one in placed.vertebrae] == pytest.approx(
        [-0.4, -38.5, -76.7], abs=0.5
    )


def test_a_mask_named_after_its_vertebra_is_taken_in(tmp_path: Path) -> None:
    placed = taken(tmp_path, label_nifti(mask_of(true(), "L4")), name="vertebrae_L4.nii.gz")
    assert [one.level for one in placed.vertebrae] == ["L4"]


def test_a_file_without_names_is_read_with_a_warning(tmp_path: Path) -> None:
    placed = taken(tmp_path, numbered(valued(0, 5)))
    assert is_true(placed)
    assert any("TotalSegmentator v2" in one.message for one in placed.warnings)
    assert "1 labels are no vertebra and are not used" in [one.message for one in placed.warnings]


def test_labels_of_a_coarser_and_turned_grid_are_resampled_by_nearest_neighbour(tmp_path: Path) -> None:
    turn = rotation_from_vector(np.array([0.1, -0.05, 0.2]))
    affine = np.eye(4)
    affine[:3, :3] = turn @ np.diag([1.5, 1.5, 1.5])
    middle = three_levels()[0].lps_from_index((np.array(three_levels()[0].shape_ijk) - 1) / 2)
    size = (90, 95, 120)
    affine[:3, 3] = middle - affine[:3, :3] @ ((np.array(size) - 1) / 2)
    k, j, i = np.indices(size[::-1])
    points = np.stack([i, j, k], axis=-1) @ affine[:3, :3].T + affine[:3, 3]
    index = three_levels()[0].index_from_lps(points)[..., ::-1]
    labels = scipy.ndimage.map_coordinates(true().labels, index.reshape(-1, 3).T, order=0).reshape(k.shape)
    coarse = LabelVolume(labels=labels, lps_from_ijk=affine, voxel_mm=1.5)
    placed = taken(tmp_path, label_nifti(coarse))
    assert placed.source_voxel_mm == pytest.approx((1.5, 1.5, 1.5))
    assert placed.volume.voxel_mm == pytest.approx(1.5)
    for found, expected in zip(placed.vertebrae, [62.0, 61.6, 62.0], strict=True):
        assert found.volume_ml == pytest.approx(expected, abs=1.5)
        assert set(np.unique(placed.volume.labels)) == {0, 27, 28, 29}
    start = np.rint(three_levels()[0].index_from_lps(placed.volume.lps_from_ijk[:3, 3])).astype(int)[::-1]
    box = tuple(slice(a, a + n) for a, n in zip(start, placed.volume.labels.shape, strict=True))
    assert (placed.volume.labels == true().labels[box]).mean() > 0.97


def test_a_vertebra_that_the_ct_cuts_is_marked_and_a_sliver_is_left_out(tmp_path: Path) -> None:
    volume, labels = labelled_spine(("L3", "L4"), spacing_mm=(1.5, 1.5, 1.5))

    # L4 from its upper third down, and L3 whole.
    def below(k: int) -> list[str]:
        path = tmp_path / f"{k}"
        path.write_bytes(label_nifti(labels))
        lps = volume.lps_from_ijk.copy()
        lps[:3, 3] = volume.lps_from_index([0, 0, k])
        part = dataclasses.replace(volume, hu=volume.hu[k:], lps_from_ijk=lps)
        placed = labels_on_ct(read_label_images(path, names={}), part)
        return [f"{one.level} cut" if one.is_cut else one.level for one in placed.vertebrae]

    assert below(0) == ["L3", "L4"]
    assert below(22) == ["L3", "L4 cut"]
    assert below(44) == ["L3 cut"]


def test_the_file_in_the_case_gives_the_labels_back(tmp_path: Path) -> None:
    placed = taken(tmp_path, label_nifti(true()))
    content = label_file_bytes(placed.volume)
    assert len(content) < 50_000
    path = tmp_path / "labels.nii.gz"
    path.write_bytes(content)
    again = load_label_file(path, voxel_mm=placed.volume.voxel_mm)
    assert (again.labels == placed.volume.labels).all()
    assert again.lps_from_ijk == pytest.approx(placed.volume.lps_from_ijk, abs=1e-4)
    path.write_bytes(content[:-200])
    with pytest.raises(InvalidInput) as reported:
        load_label_file(path, voxel_mm=1.0)
    assert reported.value.code == "LABELS_DAMAGED"


@pytest.mark.parametrize("scale", [0.0, np.nan], ids=["without-extent", "not-a-number"])
def test_a_file_in_the_case_without_geometry_is_rejected(tmp_path: Path, scale: float) -> None:
    """Otherwise the labels would be taken for absent, or stop the evaluation of all steps."""
    content = bytearray(gzip.decompress(label_file_bytes(true())))
    rows = np.frombuffer(content, "<f4", count=12, offset=280)
    content[280:328] = (rows * scale).astype("<f4").tobytes()
    path = tmp_path / "labels.nii.gz"
    path.write_bytes(gzip.compress(bytes(content)))
    with pytest.raises(InvalidInput) as reported:
        load_label_file(path, voxel_mm=1.0)
    assert reported.value.code == "LABELS_DAMAGED"


def test_a_number_beyond_those_of_labels_in_the_table_is_ignored(tmp_path: Path) -> None:
    named = {29: "L3", 28: "L4", 27: "L5", 99_999: "L2"}
    assert is_true(taken(tmp_path, label_nifti(true(), names=named)))


def test_a_deflated_segmentation_is_rejected_before_it_is_unpacked(tmp_path: Path) -> None:
    dataset = segmentation_of(true())
    dataset.EncapsulatedDocument = bytes(2**26)
    content = file_of(dataset, DeflatedExplicitVRLittleEndian)
    assert len(content) < 2**20
    del dataset
    tracemalloc.start()
    try:
        with pytest.raises(InvalidInput) as reported:
            taken(tmp_path, content)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert reported.value.code == "SEGMENTATION_UNREADABLE"
    assert peak < 2**25


@functools.cache
def whole_file() -> bytes:
    return label_nifti(true())


def mirrored() -> LabelVolume:
    """Left and right swapped in the patient's coordinates, as if RAS were read as LPS."""
    return dataclasses.replace(true(), lps_from_ijk=np.diag([-1.0, -1.0, 1.0, 1.0]) @ true().lps_from_ijk)


def bomb() -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        archive.writestr("../vertebrae_L3.nii.gz", b"x")
    return content.getvalue()


def zipped(**files: bytes) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        for name, one in files.items():
            archive.writestr(f"{name}.nii.gz", one)
    return content.getvalue()


def seg(change: Callable[[Dataset], object]) -> Callable[[], bytes]:
    def made() -> bytes:
        dataset = segmentation_of(true())
        change(dataset)
        return segmentation_file(dataset)

    return made


def without_frame(dataset: Dataset) -> None:
    del dataset.PerFrameFunctionalGroupsSequence[0]


def given(keyword: str, value: object) -> Callable[[Dataset], object]:
    return lambda dataset: setattr(dataset, keyword, value)


def cut_segmentation() -> bytes:
    return segmentation_file(segmentation_of(true()))[:-3000]


def misplaced(dataset: Dataset) -> None:
    frame = dataset.PerFrameFunctionalGroupsSequence[3]
    frame.PlanePositionSequence[0].ImagePositionPatient = [0, 0, 0.5]


REJECTED: dict[str, tuple[str, Callable[[], bytes], str]] = {
    "no-file-at-all": ("LABELS_MISSING", lambda: b"hello", ""),
    "the-ct-itself": ("LABELS_NOT_INTEGER", lambda: numbered(lambda one: one - 1000, "i2"), ""),
    "interpolated": ("LABELS_NOT_INTEGER", lambda: numbered(lambda one: one * 0.55, "f4"), ""),
    "unknown-numbers": ("LABEL_UNKNOWN", lambda: numbered(valued(28, 200)), ""),
    "names-of-nothing": ("LABEL_NAMES_INVALID", whole_file, "29:liver"),
    "one-name-for-two": ("LABEL_NAMES_INVALID", whole_file, "29:L3,28:L3"),
    "no-vertebra": ("LABELS_EMPTY", lambda: numbered(lambda one: np.where(one > 0, 5, 0)), ""),
    "far-away": ("LABELS_OUTSIDE_CT", lambda: label_nifti(moved(300.0, 0.0, 0.0)), ""),
    "beside-the-bone": ("LABELS_NOT_ON_BONE", lambda: label_nifti(moved(6.0, 0.0, 0.0)), ""),
    "half-a-level-up": ("LABELS_NOT_ON_BONE", lambda: label_nifti(moved(0.0, 0.0, 19.0)), ""),
    "left-and-right-swapped": ("LABELS_NOT_ON_BONE", lambda: label_nifti(mirrored()), ""),
    "a-vertebra-too-large": ("LABEL_VOLUME_ODD", lambda: numbered(valued(0, 30)), ""),
    "out-of-order": ("LEVEL_DOUBTFUL", whole_file, "29:L3,28:L5,27:L4"),
    "upside-down": ("LEVEL_DOUBTFUL", whole_file, "29:L5,28:L4,27:L3"),
    "a-level-left-out": ("LEVEL_DOUBTFUL", whole_file, "29:L2,28:L3,27:L5"),
    "a-level-of-the-image-left-out": ("LEVEL_DOUBTFUL", whole_file, "29:L3,27:L4"),
    "two-vertebrae-at-one-place": (
        "LABELS_OVERLAP",
        lambda: zipped(
            vertebrae_L3=label_nifti(mask_of(true(), "L3")), vertebrae_L2=label_nifti(mask_of(true(), "L3"))
        ),
        "",
    ),
    "cut-off": ("CT_FILE_DAMAGED", lambda: whole_file()[: len(whole_file()) // 2], ""),
    "only-other-organs": ("LABELS_MISSING", lambda: zipped(liver=whole_file(), spleen=whole_file()), ""),
    "a-name-that-leaves-the-zip": ("CT_ARCHIVE_UNSAFE", bomb, ""),
    "seg-without-a-frame": ("SEGMENTATION_UNREADABLE", seg(without_frame), ""),
    "seg-of-other-things": ("LABELS_MISSING", seg(given("SegmentSequence", DicomSequence())), ""),
    "seg-fractional": ("SEGMENTATION_UNREADABLE", seg(given("SegmentationType", "FRACTIONAL")), ""),
    "seg-between-the-slices": ("SEGMENTATION_GEOMETRY", seg(misplaced), ""),
    "seg-cut-off": ("SEGMENTATION_UNREADABLE", cut_segmentation, ""),
    "seg-with-a-huge-count": ("SEGMENTATION_UNREADABLE", seg(given("NumberOfFrames", 2**31 - 1)), ""),
}


@pytest.mark.parametrize("name", REJECTED)
def test_a_wrong_segmentation_is_rejected(tmp_path: Path, name: str) -> None:
    code, content, names = REJECTED[name]
    with pytest.raises(NavigationError) as reported:
        taken(tmp_path, content(), names=names)
    assert reported.value.code == code
    assert reported.value.remedy
    assert "QUIBBLE" not in str(reported.value)


@pytest.mark.parametrize("seed", range(6))
def test_random_damage_never_gives_an_unexpected_error(tmp_path: Path, seed: int) -> None:
    random = np.random.default_rng(seed)
    for original in (whole_file(), segmentation_file(segmentation_of(true()))):
        for _ in range(4):
            spoilt = bytearray(original)
            for at in random.integers(0, min(len(spoilt), 3000), 4):
                spoilt[at] ^= int(random.integers(1, 256))
            with contextlib.suppress(NavigationError):
                taken(tmp_path, bytes(spoilt))


def test_the_classes_are_those_of_totalsegmentator() -> None:
    assert {level: CLASS_OF_LEVEL[level] for level in ("C1", "C7", "T1", "T12", "L1", "L5", "S1")} == {
        "C1": 50,
        "C7": 44,
        "T1": 43,
        "T12": 32,
        "L1": 31,
        "L5": 27,
        "S1": 26,
    }
