"""Poses from files: every format gives the same poses, and every mistake is reported with its place."""

import io
import json
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from server.pose_file import Unit, read_poses
from server.pose_file.reader import MAX_BYTES
from tests.tracker.pose.tool.pivoted import Hand, pivoted
from tracker.errors import InvalidInput
from tracker.geometry import vector_from_rotation

MADE = pivoted(Hand(count=12)).poses
MATRICES = np.tile(np.eye(4), (12, 1, 1))
MATRICES[:, :3, :3] = MADE.rotations
MATRICES[:, :3, 3] = MADE.translations_mm


def rows(matrix: np.ndarray, separator: str = " ") -> str:
    return (
        "\n".join(separator.join(f"{number:.9f}" for number in row) for row in np.atleast_2d(matrix)) + "\n"
    )


def quaternion(rotation: np.ndarray) -> list[float]:
    vector = vector_from_rotation(rotation)
    angle = float(np.linalg.norm(vector))
    return [float(np.cos(angle / 2.0)), *(np.sin(angle / 2.0) * vector / angle)]


def folder_of_text(folder: Path) -> Path:
    # Not in alphabetical order: numerically, 10 comes after 2.
    for number, matrix in enumerate(MATRICES):
        (folder / f"pose{number}.txt").write_text(rows(matrix))
    (folder / "LICENSE").write_text("words\n")
    (folder / "notes.txt").write_text("taken on a Tuesday\n")
    return folder


def stacked(folder: Path) -> Path:
    (folder / "p.txt").write_text("# poses\n" + "\n".join(rows(matrix, ", ") for matrix in MATRICES))
    return folder / "p.txt"


def three_rows_each(folder: Path) -> Path:
    (folder / "p.txt").write_text("\n".join(rows(matrix[:3], "\t") for matrix in MATRICES))
    return folder / "p.txt"


def printed_by_numpy(folder: Path) -> Path:
    (folder / "p.dat").write_text(np.array2string(MATRICES, threshold=10**6, precision=12, separator=", "))
    return folder / "p.dat"


def flat_rows_with_time(folder: Path) -> Path:
    flat = np.hstack([np.arange(12)[:, None] / 30.0, MATRICES.reshape(12, 16)])
    (folder / "p.csv").write_text(
        "\ufefftime," + ",".join(f"m{n}" for n in range(16)) + "\n" + rows(flat, ";")
    )
    return folder / "p.csv"


def quaternions(folder: Path) -> Path:
    lines = ["timestamp,x,y,z,qx,qy,qz,qw"]
    for number, matrix in enumerate(MATRICES):
        w, x, y, z = quaternion(matrix[:3, :3])
        lines.append(
            ",".join(map(repr, [number, *matrix[:3, 3].tolist(), x, y, z, w])).replace("np.float64", "")
        )
    (folder / "p.csv").write_text("\n".join(lines))
    return folder / "p.csv"


def array(folder: Path) -> Path:
    np.save(folder / "p.npy", MATRICES)
    return folder / "p.npy"


def flat_array_in_npz(folder: Path) -> Path:
    np.savez(folder / "p.npz", poses=MATRICES.reshape(12, 16))
    return folder / "p.npz"


def json_list(folder: Path) -> Path:
    (folder / "p.json").write_text(json.dumps(MATRICES.tolist()))
    return folder / "p.json"


def json_objects(folder: Path) -> Path:
    poses = [{"rotation": m[:3, :3].tolist(), "translation_mm": m[:3, 3].tolist()} for m in MATRICES]
    (folder / "p.json").write_text(json.dumps({"poses": poses}))
    return folder / "p.json"


def tracked_line(matrix: np.ndarray, **more: object) -> str:
    pose = {"rotation": matrix[:3, :3].tolist(), "translation_mm": matrix[:3, 3].tolist()}
    said = {"name": "drill", "seen": True, "camera_from_marker": pose, "pose_covariance": np.eye(6).tolist()}
    return json.dumps({**said, **more}) + "\n"


def tracked(folder: Path) -> Path:
    unseen = json.dumps(
        {"name": "drill", "seen": False, "reason": "NO_CANDIDATE", "camera_from_marker": None}
    )
    (folder / "t.jsonl").write_text(unseen + "\n" + "".join(tracked_line(matrix) for matrix in MATRICES))
    return folder / "t.jsonl"


@pytest.mark.parametrize(
    "write",
    [
        folder_of_text,
        stacked,
        three_rows_each,
        printed_by_numpy,
        flat_rows_with_time,
        quaternions,
        array,
        flat_array_in_npz,
        json_list,
        json_objects,
        tracked,
    ],
    ids=lambda write: write.__name__,
)
def test_every_form_gives_the_same_poses(tmp_path: Path, write: Callable[[Path], Path]) -> None:
    poses = read_poses(write(tmp_path)).poses
    assert len(poses) == 12
    np.testing.assert_allclose(poses.rotations, MADE.rotations, atol=1e-7)
    np.testing.assert_allclose(poses.translations_mm, MADE.translations_mm, atol=1e-6)


def tracked_with_time(folder: Path) -> Path:
    lines = [tracked_line(matrix, time_s=number / 30.0) for number, matrix in enumerate(MATRICES)]
    (folder / "t.jsonl").write_text("".join(lines))
    return folder / "t.jsonl"


@pytest.mark.parametrize(
    ("write", "rate_hz"),
    [
        pytest.param(tracked_with_time, 30.0, id="tracked"),
        pytest.param(flat_rows_with_time, 30.0, id="flat-rows"),
        pytest.param(quaternions, 1.0, id="quaternions"),
    ],
)
def test_poses_with_times_are_a_series(tmp_path: Path, write: Callable[[Path], Path], rate_hz: float) -> None:
    series = read_poses(write(tmp_path)).series("camera")
    np.testing.assert_allclose(series.times_s, np.arange(12) / rate_hz, atol=1e-6)
    np.testing.assert_allclose(series.translations_mm, MADE.translations_mm, atol=1e-6)
    assert series.rotations is not None
    np.testing.assert_allclose(series.rotations, MADE.rotations, atol=1e-7)


def numbered(folder: Path) -> Path:
    text = quaternions(folder).read_text().replace("timestamp", "image_number")
    (folder / "p.csv").write_text(text)
    return folder / "p.csv"


def flat_rows_with_number(folder: Path) -> Path:
    text = flat_rows_with_time(folder).read_text().replace("time", "index")
    (folder / "p.csv").write_text(text)
    return folder / "p.csv"


@pytest.mark.parametrize(
    "write", [tracked, array, numbered, flat_rows_with_number], ids=lambda write: write.__name__
)
def test_poses_without_times_are_no_series(tmp_path: Path, write: Callable[[Path], Path]) -> None:
    with pytest.raises(InvalidInput) as caught:
        read_poses(write(tmp_path)).series("camera")
    assert caught.value.code == "POSE_TIMES_MISSING"


def test_what_a_folder_holds_beside_poses_is_named(tmp_path: Path) -> None:
    assert set(read_poses(folder_of_text(tmp_path)).ignored) == {"LICENSE", "notes.txt"}


def test_tracked_lines_bring_their_covariance_and_leave_out_what_was_not_seen(tmp_path: Path) -> None:
    read = read_poses(tracked(tmp_path))
    assert read.unseen == 1
    assert read.poses.covariances is not None
    assert {record.marker for record in read.records} == {"drill"}


def test_one_of_several_markers_must_be_named(tmp_path: Path) -> None:
    file = tmp_path / "t.jsonl"
    file.write_text(tracked_line(MATRICES[0]) + tracked_line(MATRICES[1], name="awl"))
    assert rejected(file).code == "POSES_OF_SEVERAL_MARKERS"
    assert len(read_poses(file, marker="awl").records) == 1
    with pytest.raises(InvalidInput, match="only of awl, drill"):
        read_poses(file, marker="saw")


def test_metres_are_scaled_when_they_are_named_and_only_then(tmp_path: Path) -> None:
    small = MATRICES.copy()
    small[:, :3, 3] /= 1000.0
    np.save(tmp_path / "m.npy", small)
    np.testing.assert_allclose(
        read_poses(tmp_path / "m.npy", unit=Unit.M).poses.translations_mm, MADE.translations_mm
    )
    with pytest.raises(InvalidInput, match="--unit m"):
        _ = read_poses(tmp_path / "m.npy").poses


def rejected(path: Path) -> InvalidInput:
    with pytest.raises(InvalidInput) as caught:
        read_poses(path)
    assert caught.value.remedy
    return caught.value


def changed(index: tuple[int, int], value: float) -> str:
    matrix = MATRICES[0].copy()
    matrix[index] = value
    return rows(matrix)


SCALED = MATRICES[0] @ np.diag([2.0, 2.0, 2.0, 1.0])
MIRRORED = MATRICES[0] @ np.diag([1.0, 1.0, -1.0, 1.0])


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        pytest.param("p.txt", "", "it is empty", id="empty"),
        pytest.param("p.txt", changed((0, 1), np.nan), "not finite", id="not-a-number"),
        pytest.param("p.txt", rows(SCALED), "scales by 2", id="scaled"),
        pytest.param("p.txt", rows(MIRRORED), "reflection", id="mirrored"),
        pytest.param("p.txt", changed((0, 1), 0.9), "orthonormal", id="no-rotation"),
        pytest.param("p.txt", rows(MATRICES[0].T), "transposed", id="transposed"),
        pytest.param("p.txt", rows(MATRICES[0])[:-40], "different lengths", id="cut"),
        pytest.param("p.txt", rows(MATRICES.reshape(-1, 4)[:5]), "not a multiple", id="a-row-too-many"),
        pytest.param("p.txt", "1 2 3 0 0 0 1\n", "quaternion", id="seven-numbers-without-header"),
        pytest.param(
            "p.csv", "x,y,z,qx,qy,qz,qw\n1,2,3,0,0,0,2\n", "length of its quaternion", id="long-turn"
        ),
        pytest.param("p.csv", "x,z,qx,qy,qz,qw\n1,3,0,0,0,1\n", "no column for y", id="column-missing"),
        pytest.param("p.txt", rows(MATRICES[0]) + "and so on\n", "line 5", id="words-after-numbers"),
        pytest.param("p.json", "{", "not valid JSON", id="broken-json"),
        pytest.param("p.json", "[" * 100_000, "JSON|deep", id="nested-json"),
        pytest.param("p.json", "[" + "9" * 5000 + "]", "number is too long", id="a-number-without-end"),
        pytest.param(
            "p.json", '{"poses": [{"rotation": 1}]}', "pose 1: it has no rotation", id="no-rotation-in-json"
        ),
        pytest.param("p.json", '[["a"]]', "array of numbers", id="words-in-json"),
        pytest.param("p.json", "[[1, 2], [3]]", "array of numbers", id="ragged-json"),
        pytest.param(
            "p.jsonl", '{"seen": true, "camera_from_marker": null}\n', "--camera", id="tracked-uncalibrated"
        ),
        pytest.param("p.jsonl", '{"seen": false}\n', "do not show the marker", id="never-seen"),
    ],
)
def test_a_mistake_is_reported_with_its_place(tmp_path: Path, name: str, content: str, words: str) -> None:
    (tmp_path / name).write_text(content)
    error = rejected(tmp_path / name)
    assert any(word in f"{error.message} {error.remedy}" for word in words.split("|"))
    assert name in f"{error.message}"


def header_of(shape: str) -> bytes:
    """The header of an array of NumPy, without numbers."""
    text = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n".encode()
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text


def zipped(content: bytes, method: int = zipfile.ZIP_DEFLATED) -> bytes:
    """An archive of NumPy with this member."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", method) as archive:
        archive.writestr("poses.npy", content)
    return file.getvalue()


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        pytest.param("p.npy", header_of("(3, 4, 2147483648)"), "complete", id="more-than-memory"),
        pytest.param("p.npy", header_of("(3, 4, 1" + "0" * 30 + ")"), "complete", id="no-index"),
        pytest.param("p.npy", header_of("(3, (4, 4)"), "complete", id="no-literal"),
        pytest.param("p.npz", zipped(header_of("(1, 4, 4)"))[:-9], "complete", id="cut-archive"),
        pytest.param(
            "p.npz",
            zipped(header_of("(1, 4, 4)")).replace(b"PK\x03\x04", b"PK\x03\x05"),
            "complete",
            id="no-member",
        ),
        pytest.param("p.npz", zipped(bytes(MAX_BYTES + 1)), "unpacks to 200 MB", id="bomb"),
    ],
)
def test_an_array_that_no_memory_holds_is_rejected(
    tmp_path: Path, name: str, content: bytes, words: str
) -> None:
    (tmp_path / name).write_bytes(content)
    error = rejected(tmp_path / name)
    assert error.code == "POSES_UNREADABLE"
    assert words in error.message


def test_covariances_of_different_shapes_are_rejected(tmp_path: Path) -> None:
    lines = tracked_line(MATRICES[0]) + tracked_line(MATRICES[1], pose_covariance=[[1.0]])
    (tmp_path / "t.jsonl").write_text(lines)
    with pytest.raises(InvalidInput, match=r"shape \(1, 1\)"):
        _ = read_poses(tmp_path / "t.jsonl").poses


@pytest.mark.parametrize("kind", ["nowhere", "empty-folder", "binary", "cut-npy", "objects-npy"])
def test_what_is_no_file_of_poses_is_rejected(tmp_path: Path, kind: str) -> None:
    path = tmp_path / {"binary": "p.txt", "cut-npy": "p.npy", "objects-npy": "p.npy"}.get(kind, kind)
    if kind == "empty-folder":
        path.mkdir()
    if kind == "binary":
        path.write_bytes(bytes(range(128, 256)))
    if kind == "cut-npy":
        np.save(path, MATRICES)
        path.write_bytes(path.read_bytes()[:300])
    if kind == "objects-npy":
        np.save(path, np.array([{"a": 1}], dtype=object), allow_pickle=True)
    assert rejected(path).code in {"POSES_NOT_FOUND", "POSES_UNREADABLE"}


def test_rounded_rotations_are_made_whole(tmp_path: Path) -> None:
    (tmp_path / "p.txt").write_text("\n".join(rows(np.round(matrix, 3)) for matrix in MATRICES))
    rotations = read_poses(tmp_path / "p.txt").poses.rotations
    np.testing.assert_allclose(
        rotations @ rotations.transpose(0, 2, 1), np.tile(np.eye(3), (12, 1, 1)), atol=1e-12
    )
    np.testing.assert_allclose(rotations, MADE.rotations, atol=2e-3)


def test_decimal_commas_and_rows_of_an_unseen_marker_are_read(tmp_path: Path) -> None:
    flat = np.hstack([np.arange(12)[:, None] / 30.0, MATRICES.reshape(12, 16)])
    flat[3, 1:] = np.nan
    (tmp_path / "p.csv").write_text(rows(flat, ";").replace(".", ","))
    reported = read_poses(tmp_path / "p.csv")
    assert reported.unseen == 1
    assert len(reported.records) == 11
    np.testing.assert_allclose(reported.records[3].pose.matrix, MATRICES[4], atol=1e-7)
