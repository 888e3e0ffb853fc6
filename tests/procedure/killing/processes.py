"""The processes of a server: found by their parents, killed, and checked afterwards."""

import os
import signal
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from server.recording_file.topics import SUFFIX

PROC = Path("/proc")
RING = "memfd:coaxial-ring"
GONE_WITHIN_S = 30.0
LOOK_AGAIN_S = 0.02


@dataclass(frozen=True, slots=True, kw_only=True)
class Family:
    """A server and all of its processes.

    Attributes:
        web: the web process.
        tracking: the tracking process; None if there is none.
        recording: the process that writes a recording; None if there is none.
        others: fork server, resource tracker, jobs.
        shared: names of shared memory that any of them uses.

    """

    web: int
    tracking: int | None
    recording: int | None
    others: tuple[int, ...]
    shared: frozenset[str]

    @property
    def pids(self) -> tuple[int, ...]:
        """All process ids."""
        return (self.web, *(pid for pid in (self.tracking, self.recording) if pid is not None), *self.others)


def family_of(web: int) -> Family:
    """Find the processes of a server."""
    below = tuple(_descendants(web))
    maps = {pid: _maps(pid) for pid in (web, *below)}
    recording = next((pid for pid in below if _writes_recording(pid)), None)
    # The fork server and jobs map no images.
    tracking = next((pid for pid in below if RING in maps[pid] and pid != recording), None)
    shared = {line.split()[-1] for text in maps.values() for line in text.splitlines() if "/dev/shm/" in line}  # noqa: S108  it is looked at, not written
    return Family(
        web=web,
        tracking=tracking,
        recording=recording,
        others=tuple(pid for pid in below if pid not in {tracking, recording}),
        shared=frozenset(shared),
    )


def kill(pids: tuple[int, ...]) -> None:
    """`kill -9`."""
    for pid in pids:
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)


def left_behind(family: Family) -> Iterator[str]:
    """What remains of a killed server after a while."""
    deadline_s = time.monotonic() + GONE_WITHIN_S
    alive = family.pids
    while alive and time.monotonic() < deadline_s:
        alive = tuple(pid for pid in alive if _is_alive(pid))
        time.sleep(LOOK_AGAIN_S)
    yield from (f"process {pid} of the killed server lives on" for pid in alive)
    yield from (f"{name} was left behind" for name in sorted(family.shared) if Path(name).exists())


def _descendants(pid: int) -> Iterator[int]:
    for task in (PROC / str(pid) / "task").glob("*/children"):
        with suppress(OSError):
            for child in task.read_text().split():
                yield int(child)
                yield from _descendants(int(child))


def _maps(pid: int) -> str:
    try:
        return (PROC / str(pid) / "maps").read_text()
    except OSError:
        return ""


def _writes_recording(pid: int) -> bool:
    with suppress(OSError):
        return any(link.readlink().suffix == SUFFIX for link in (PROC / str(pid) / "fd").iterdir())
    return False


def _is_alive(pid: int) -> bool:
    try:
        state = (PROC / str(pid) / "stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    # A zombie that its parent has not reaped no longer runs.
    return state != "Z"
