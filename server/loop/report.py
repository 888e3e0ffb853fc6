"""Reports of the tracking process, and their serialisation.

The setup (camera, tools, plan) is the same for thousands of images: it is pickled once, and unpickled to the
same object as long as it does not change.
"""

import io
import pickle
import struct
from dataclasses import dataclass

from server.capture.rehearsal import PlayedScene
from server.live import Problem, SourceStatus
from tracker.navigation import NavigationSnapshot, Setup

LENGTH = struct.Struct("<I")
SETUP_MARK = "setup"


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """One message of the tracking process.

    Attributes:
        source: status of the source of images.
        snapshot: Result of the image sent with it; None without an image.
        problem: Why it cannot track although it runs; None otherwise.
        tracked_images: number of images that this process has reported.
        played_scene: scene of the rehearsal; None for every other source.
        state: Number of the tracking state before this image in the ring; 0 if none was stored, -1 if storing
            failed.
        is_predicted: Whether the image was decoded from video with predicted images.
    """

    source: SourceStatus
    snapshot: NavigationSnapshot | None = None
    problem: Problem | None = None
    tracked_images: int = 0
    played_scene: PlayedScene | None = None
    state: int = 0
    is_predicted: bool = False


class ReportPacker:
    """Serialises reports."""

    def __init__(self) -> None:
        self._setup: Setup | None = None
        self._setup_bytes = b""

    def pack(self, report: Report) -> bytes:
        """Return the report as bytes."""
        setup = None if report.snapshot is None else report.snapshot.setup
        if setup is not None and setup is not self._setup:
            self._setup, self._setup_bytes = setup, pickle.dumps(setup, protocol=5)
        body = io.BytesIO()
        _Pickler(body, setup).dump(report)
        return LENGTH.pack(len(self._setup_bytes)) + self._setup_bytes + body.getvalue()


class ReportUnpacker:
    """Deserialises reports of a process that this server started."""

    def __init__(self) -> None:
        self._setup: Setup | None = None
        self._setup_bytes = b""

    def unpack(self, content: bytes) -> Report:
        """Return the report; an unchanged setup is the same object as before."""
        (length,) = LENGTH.unpack_from(content)
        setup_bytes = content[LENGTH.size : LENGTH.size + length]
        if setup_bytes and setup_bytes != self._setup_bytes:
            self._setup, self._setup_bytes = pickle.loads(setup_bytes), setup_bytes  # noqa: S301  own child
        unpickler = _Unpickler(io.BytesIO(content[LENGTH.size + length :]), self._setup)
        report: Report = unpickler.load()
        return report


class _Pickler(pickle.Pickler):
    def __init__(self, file: io.BytesIO, setup: Setup | None) -> None:
        super().__init__(file, protocol=5)
        self._setup = setup

    def persistent_id(self, obj: object) -> str | None:
        """Leave the setup out."""
        return SETUP_MARK if self._setup is not None and obj is self._setup else None


class _Unpickler(pickle.Unpickler):
    def __init__(self, file: io.BytesIO, setup: Setup | None) -> None:
        super().__init__(file)
        self._setup = setup

    def persistent_load(self, pid: object) -> Setup:
        """Put the setup in."""
        if pid != SETUP_MARK or self._setup is None:
            raise pickle.UnpicklingError(f"unknown part {pid!r}")
        return self._setup
