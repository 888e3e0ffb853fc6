"""Reading of poses from a path: selection of the parser, and order of the files in a folder."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.lib.npyio import NpzFile

from server.numpy_file import BAD_NUMPY_FILE
from server.pose_file.record import FORMATS_REMEDY, PoseRecord, unreadable
from server.pose_file.structured import PoseFileContent, poses_from_array, poses_from_json
from server.pose_file.text import contains_numbers, poses_from_text
from server.pose_file.unit import Unit
from tracker.errors import InvalidInput
from tracker.pose.temporal_calibration import PoseSeries
from tracker.pose.tool import Poses

TEXT = {".txt", ".csv", ".tsv", ".dat", ".mat", ".asc", ".pose"}
JSON = {".json", ".jsonl", ".ndjson"}
ARRAY = {".npy", ".npz"}
MAX_BYTES = 200_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseFiles:
    """The poses read from a path.

    Attributes:
        records: in the order of file names and lines.
        ignored: files of a folder that contain no pose.
        unseen: number of images without the marker.
    """

    records: tuple[PoseRecord, ...]
    ignored: tuple[str, ...] = ()
    unseen: int = 0

    @property
    def poses(self) -> Poses:
        """Return the poses for a calibration, with covariances if all records have one.

        Raises:
            InvalidInput: POSE_UNIT_SUSPECT or POSE_COVARIANCE_INVALID.
        """
        covariances = [record.covariance for record in self.records]
        stated = [one for one in covariances if one is not None]
        return Poses.from_rigids(
            [record.pose for record in self.records],
            stated if stated and len(stated) == len(covariances) else None,
        )

    def series(self, name: str) -> PoseSeries:
        """Return the poses with times on the source's clock, for a temporal calibration.

        Raises:
            InvalidInput: POSE_TIMES_MISSING or TIME_SERIES_INVALID.
        """
        untimed = next((record.place for record in self.records if record.time_s is None), None)
        if untimed is not None:
            raise InvalidInput(
                "POSE_TIMES_MISSING",
                f"{untimed}: the pose has no time",
                "Give the output of 'coaxial track --json', or a CSV with a header and a column time_s.",
                {"place": untimed},
            )
        return PoseSeries(
            name=name,
            times_s=np.array([record.time_s for record in self.records], dtype=np.float64),
            translations_mm=np.array([record.pose.translation_mm for record in self.records]),
            rotations=np.array([record.pose.rotation for record in self.records]),
        )


def read_poses(path: Path, *, unit: Unit = Unit.MM, marker: str | None = None) -> PoseFiles:
    """Read the poses of one marker from a folder or a file.

    Raises:
        InvalidInput: POSES_NOT_FOUND, POSES_UNREADABLE, POSES_NOT_CALIBRATED, POSES_OF_SEVERAL_MARKERS, or
            POSE_MATRIX_INVALID; each with file and line.
    """
    if not path.exists():
        raise InvalidInput("POSES_NOT_FOUND", f"{path} does not exist", FORMATS_REMEDY, {"path": str(path)})
    records: list[PoseRecord] = []
    ignored: list[str] = []
    unseen = 0
    for file in _files(path):
        content = _read_file(file, unit, in_folder=path.is_dir())
        if content is None:
            ignored.append(file.name)
            continue
        records += content.poses
        unseen += content.unseen
    chosen = _of_one_marker(records, marker)
    if not chosen:
        what = f"{unseen} images do not show the marker" if unseen else f"{len(ignored)} other files"
        raise InvalidInput(
            "POSES_NOT_FOUND", f"{path} contains no pose ({what})", FORMATS_REMEDY, {"path": str(path)}
        )
    return PoseFiles(records=tuple(chosen), ignored=tuple(ignored), unseen=unseen)


def _files(path: Path) -> list[Path]:
    if not path.is_dir():
        return [path]
    files = [file for file in path.iterdir() if file.is_file() and not file.name.startswith(".")]
    # Natural sort order: pose2 before pose10.
    return sorted(files, key=lambda file: [_counted(part) for part in re.split(r"(\d+)", file.name)])


def _counted(part: str) -> tuple[int, int, str]:
    return (0, int(part), "") if part.isdecimal() and part.isascii() else (1, 0, part)


def _read_file(file: Path, unit: Unit, *, in_folder: bool) -> PoseFileContent | None:
    """Read one file; return None for a file of a folder that contains no poses (a licence, an image)."""
    kind = file.suffix.lower()
    if in_folder and kind not in TEXT | JSON | ARRAY:
        return None
    try:
        size = file.stat().st_size
        if size > MAX_BYTES:
            raise unreadable(
                str(file), f"it has {size / 1e6:.0f} MB, the maximum is {MAX_BYTES / 1e6:.0f} MB"
            )
        if kind in ARRAY:
            return PoseFileContent(poses=poses_from_array(_array(file), name=file.name, unit=unit))
        text = file.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise unreadable(str(file), f"it cannot be read: {(error.strerror or str(error)).lower()}") from error
    except UnicodeDecodeError as error:
        raise unreadable(str(file), "it is not a text file") from error
    if kind in JSON or (kind not in TEXT and text.lstrip()[:1] == "{"):
        return poses_from_json(text, name=file.name, unit=unit)
    if in_folder and not contains_numbers(text) and text.strip():
        return None
    return poses_from_text(text, name=file.name, unit=unit)


def _array(file: Path) -> np.ndarray:
    try:
        # Opened here, because NumPy leaves a damaged archive open.
        with file.open("rb") as opened:
            loaded = np.load(opened, allow_pickle=False)
            return loaded if isinstance(loaded, np.ndarray) else _only_array(loaded, file)
    except BAD_NUMPY_FILE as error:
        raise unreadable(str(file), "it is not a complete NumPy file of numbers") from error


def _only_array(archive: NpzFile, file: Path) -> np.ndarray:
    names = list(archive)
    if len(names) != 1:
        raise unreadable(str(file), f"it contains {len(names)} arrays, expected one")
    # A small archive may unpack to an array that fills the memory.
    parts = [] if archive.zip is None else archive.zip.infolist()
    unpacked_bytes = sum(part.file_size for part in parts)
    if unpacked_bytes > MAX_BYTES:
        raise unreadable(
            str(file),
            f"it unpacks to {unpacked_bytes / 1e6:.0f} MB, the maximum is {MAX_BYTES / 1e6:.0f} MB",
        )
    return np.asarray(archive[names[0]])


def _of_one_marker(records: list[PoseRecord], marker: str | None) -> list[PoseRecord]:
    names = sorted({record.marker for record in records if record.marker is not None})
    if marker is None and len(names) > 1:
        raise InvalidInput(
            "POSES_OF_SEVERAL_MARKERS",
            f"the file contains poses of {len(names)} markers: {', '.join(names)}",
            "Give the marker of the tool with --marker.",
            {"markers": names},
        )
    if marker is not None and names and marker not in names:
        raise InvalidInput(
            "POSES_NOT_FOUND",
            f"the file contains no poses of '{marker}', only of {', '.join(names)}",
            "Give the marker of the tool with --marker.",
            {"markers": names},
        )
    return [record for record in records if marker is None or record.marker in {None, marker}]
