"""Received series, which wait in a folder until one is taken for a case or its time is over.

Each series has a folder of files and, as soon as it is complete, a description beside it without data that
identify the patient. Names of folders and files are digests, because identifiers lead to the patient in an
archive. The receiver's process writes; the server lists, takes and discards.
"""

import dataclasses
import hashlib
import json
import os
import shutil
import threading
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from server.disk import sync_path
from server.imaging.ct import SeriesDescription
from tracker.errors import InvalidInput, NavigationError, Remark
from tracker.plan.document import plain

PRIVATE = 0o700
DESCRIPTION, FILE = ".json", ".dcm"
INCOMING = "incoming"
# Between two pieces of a slice; the receiver ends a silent connection earlier.
MAX_ARRIVAL_S = 600.0


class ReceivedUnknown(NavigationError):
    """There is no such received series."""


@dataclass(frozen=True, slots=True, kw_only=True)
class InboxLimits:
    """Limits of all that waits.

    Attributes:
        max_bytes: of all files.
        max_series: number of series.
        max_age_s: since the last slice of a series, after which it is deleted.
    """

    max_bytes: int
    max_series: int
    max_age_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ReceivedSeries:
    """A series that waits.

    Attributes:
        id: for taking and discarding it.
        files: number of files.
        size_bytes: of its files.
        changed_s: Unix time of the last file.
        description: None while it is not complete, or cannot be read.
        problem: why it cannot be read; None if it can, or is not complete.
    """

    id: str
    files: int
    size_bytes: int
    changed_s: float
    description: SeriesDescription | None
    problem: Remark | None


class Inbox:
    """The folder of received series. Each of the two processes has one; thread-safe in each."""

    def __init__(self, folder: Path, limits: InboxLimits) -> None:
        self._folder = folder
        self._limits = limits
        self._lock = threading.Lock()
        self._sizes: dict[str, int] = {}
        folder.mkdir(mode=PRIVATE, parents=True, exist_ok=True)

    @property
    def incoming(self) -> Path:
        """Folder of files that are not complete."""
        return self._folder / INCOMING

    def waiting(self, now_s: float) -> tuple[ReceivedSeries, ...]:
        """Delete what is too old; return the others, the newest first."""
        found = [one for path in self._folders() if (one := _series(path)) is not None]
        old = [one for one in found if now_s - one.changed_s > self._limits.max_age_s]
        for one in old:
            self._delete(one.id)
        return tuple(sorted((one for one in found if one not in old), key=lambda one: -one.changed_s))

    def link_into(self, series_id: str, folder: Path) -> None:
        """Make a folder with the files of a complete series, without copying them.

        Raises:
            ReceivedUnknown: RECEIVED_UNKNOWN.
            InvalidInput: RECEIVED_NOT_COMPLETE.
        """
        path = self._known(series_id)
        if not path.with_suffix(DESCRIPTION).exists():
            files = sum(1 for _ in path.iterdir())
            raise InvalidInput(
                "RECEIVED_NOT_COMPLETE",
                f"the series is not complete: {files} slices have arrived, and the sender has not finished",
                "Wait until the sender has finished, or send the series again.",
                {"files": files},
            )
        folder.mkdir(mode=PRIVATE)
        for file in path.iterdir():
            (folder / file.name).hardlink_to(file)

    def discard(self, series_id: str) -> None:
        """Delete a series.

        Raises:
            ReceivedUnknown: RECEIVED_UNKNOWN.
        """
        self._known(series_id)
        self._delete(series_id)

    def prepare(self, now_s: float) -> None:
        """Delete what is too old, and measure what waits; before series are received."""
        waiting = self.waiting(now_s)
        for path in self.incoming.iterdir():
            # Left by a connection that broke within a slice.
            with suppress(FileNotFoundError):
                if now_s - path.stat().st_mtime > MAX_ARRIVAL_S:
                    path.unlink()
        with self._lock:
            self._sizes = {one.id: one.size_bytes for one in waiting}

    def clear_incoming(self) -> None:
        """Delete incomplete files of a process that ended."""
        shutil.rmtree(self.incoming, ignore_errors=True)
        self.incoming.mkdir(mode=PRIVATE, exist_ok=True)

    def put(self, path: Path, *, series_uid: str, instance_uid: str) -> str:
        """Add a file, which is on the disk afterwards; return the id of its series.

        The file at `path` remains. One that is there already is accepted again. The series counts as
        incomplete until `describe`.

        Raises:
            InvalidInput: RECEIVE_FULL, RECEIVE_MANY_SERIES, RECEIVE_CONTRADICTS.
        """
        series_id, size = digest(series_uid), path.stat().st_size
        folder = self._folder / series_id
        file = folder / f"{digest(instance_uid)}{FILE}"
        with self._lock:
            folder.with_suffix(DESCRIPTION).unlink(missing_ok=True)
            if file.exists():
                _check_equal(file, path)
                os.utime(file)
                return series_id
            self._check_limits(series_id, size)
            folder.mkdir(mode=PRIVATE, exist_ok=True)
            file.hardlink_to(path)
            sync_path(file)
            sync_path(folder)
            self._sizes[series_id] = self._sizes.get(series_id, 0) + size
        return series_id

    def files_of(self, series_id: str) -> Path:
        """Return the folder of a series."""
        return self._folder / series_id

    def describe(self, series_id: str, described: SeriesDescription | Remark) -> None:
        """Store what a series is, or why it cannot be read; it is complete from now on."""
        content = plain(described) if isinstance(described, Remark) else dataclasses.asdict(described)
        path = (self._folder / series_id).with_suffix(DESCRIPTION)
        part = path.with_suffix(".part")
        with self._lock:
            if not path.with_suffix("").is_dir():
                return  # It was discarded meanwhile.
            part.write_text(json.dumps(content), encoding="utf-8")
            part.replace(path)

    def _check_limits(self, series_id: str, size: int) -> None:
        limits, waiting = self._limits, sum(self._sizes.values())
        if series_id not in self._sizes and len(self._sizes) >= limits.max_series:
            raise InvalidInput(
                "RECEIVE_MANY_SERIES",
                f"a series was refused, because {len(self._sizes)} wait already, allowed {limits.max_series}",
                "Take or discard a series that waits, and send again.",
                {"waiting": len(self._sizes), "max_series": limits.max_series},
            )
        if waiting + size > limits.max_bytes:
            raise InvalidInput(
                "RECEIVE_FULL",
                f"a series was refused, because {waiting / 1e9:.1f} GB wait already, allowed "
                f"{limits.max_bytes / 1e9:g} GB",
                "Take or discard a series that waits, and send again.",
                {"waiting_gb": waiting / 1e9, "max_gb": limits.max_bytes / 1e9},
            )

    def _folders(self) -> list[Path]:
        return [path for path in self._folder.iterdir() if path.is_dir() and path.name != INCOMING]

    def _known(self, series_id: str) -> Path:
        for path in self._folders():
            if path.name == series_id:
                return path
        raise ReceivedUnknown(
            "RECEIVED_UNKNOWN",
            f"no received series has the id {series_id[:40]}",
            "Read the list again; it may have been taken, discarded or too old.",
            {"series_id": series_id[:40]},
        )

    def _delete(self, series_id: str) -> None:
        # First the description, without which the series cannot be taken.
        (self._folder / series_id).with_suffix(DESCRIPTION).unlink(missing_ok=True)
        shutil.rmtree(self._folder / series_id, ignore_errors=True)
        with self._lock:
            self._sizes.pop(series_id, None)


def digest(identifier: str) -> str:
    """Return the name of a folder or file for an identifier of DICOM."""
    return hashlib.sha256(identifier.encode()).hexdigest()[:32]


def _series(folder: Path) -> ReceivedSeries | None:
    """Return a series; None if it was deleted meanwhile, or is empty."""
    files, size, changed_s = 0, 0, 0.0
    with suppress(FileNotFoundError):
        for entry in os.scandir(folder):
            status = entry.stat()
            files, size, changed_s = files + 1, size + status.st_size, max(changed_s, status.st_mtime)
    if not files:
        return None
    description, problem = _described(folder.with_suffix(DESCRIPTION))
    return ReceivedSeries(
        id=folder.name,
        files=files,
        size_bytes=size,
        changed_s=changed_s,
        description=description,
        problem=problem,
    )


def _described(path: Path) -> tuple[SeriesDescription | None, Remark | None]:
    try:
        content: Mapping[str, object] = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None, None
    if "code" in content:
        return None, Remark(**content)  # pyrefly: ignore[bad-argument-type]  as `describe` writes it
    across, down = content["pixel_mm"], content["size_wh_px"]
    return (
        SeriesDescription(**{**content, "pixel_mm": tuple(across), "size_wh_px": tuple(down)}),  # pyrefly: ignore[bad-argument-type]  as above
        None,
    )


def _check_equal(file: Path, path: Path) -> None:
    if file.stat().st_size == path.stat().st_size and file.read_bytes() == path.read_bytes():
        return
    raise InvalidInput(
        "RECEIVE_CONTRADICTS",
        "a slice was refused, because another one of the same identifier has arrived before",
        "Discard the series, and send it again.",
    )
