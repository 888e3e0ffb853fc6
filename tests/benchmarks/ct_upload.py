"""A CT of 512 x 512 x 400 voxels sent to a running server: how soon a slice of it is seen, and what it takes.

The server captures and tracks a rehearsal meanwhile, as it would in a theatre.
"""

import http.client
import json
import re
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from pydicom import uid

from tests.benchmarks.asked import Asked
from tests.benchmarks.ct_reading import SIZE_WH, SLICES, write_series, zipped
from tests.benchmarks.running_server import RunningServer, running_server
from tests.benchmarks.tables import Table

KINDS = {"uncompressed": uid.ExplicitVRLittleEndian, "JPEG 2000": uid.JPEG2000Lossless}
RATE_HZ = 30.0
VOLUME_MIB = SIZE_WH[0] * SIZE_WH[1] * SLICES * 2 / 2**20
WATCH_EVERY_S = 0.1
NOTE = (
    "Times begin when the last byte was sent. Memory is over the 200 MiB of the voxels: `server` is the most "
    "that the web server held, with what it had before; `all` is what it and every process under it "
    "(tracking, reading, decoding) held more than before, what they share and the mapped file counted once."
)
PATIENCE_S = 300.0
Told: TypeAlias = dict[str, object]


@dataclass(slots=True, kw_only=True)
class Memory:
    """The most that was held at once, in MiB; what processes share is counted once."""

    server_mib: float = 0.0
    together_mib: float = 0.0
    before_mib: float = 0.0


@dataclass(slots=True)
class Door:
    """The server's own door, kept open."""

    port: int

    def ask(self, method: str, path: str, body: bytes | None = None) -> tuple[int, bytes]:
        """Status and content of an answer."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE_S)
        try:
            headers = {"Content-Type": "application/json"} if body else {}
            connection.request(method, path, body, headers)
            answer = connection.getresponse()
            return answer.status, answer.read()
        finally:
            connection.close()

    def mapping(self, method: str, path: str, asked: Mapping[str, object] | None = None) -> Told:
        """The answer as JSON; RuntimeError where it is a refusal."""
        status, content = self.ask(method, path, None if asked is None else json.dumps(asked).encode())
        if status >= 300:
            raise RuntimeError(f"{method} {path}: {status} {content[:300]!r}")
        answer: Told = json.loads(content)
        return answer

    def send(self, path: str, file: Path) -> tuple[Told, float]:
        """Send a file as the body; the answer, and when its last byte was sent."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE_S)
        with file.open("rb") as content:
            connection.putrequest("POST", path)
            connection.putheader("Content-Length", str(file.stat().st_size))
            connection.endheaders()
            while chunk := content.read(2**20):
                connection.send(chunk)
        sent_s = time.perf_counter()
        answer: Told = json.loads(connection.getresponse().read())
        connection.close()
        return answer, sent_s


def measure_ct_upload(asked: Asked) -> list[Table]:
    """A table: both compressions, as a zip."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name, syntax in KINDS.items():
            made = Path(folder) / name
            write_series(made, syntax)
            archive = zipped(made)
            with running_server(asked, seed=asked.seeds[0], live_rate_hz=RATE_HZ) as server:
                rows.append(_row(name, archive, server))
    return [
        Table(
            title="Sent to a running server as a zip, which tracks 30 images a second meanwhile",
            columns=["slices", "first slice s", "CT open s", "axial ms", "sagittal ms", "server", "all"],
            rows=rows,
            note=NOTE,
        )
    ]


def _row(name: str, archive: Path, server: RunningServer) -> list[str]:
    door = Door(server.port)
    case = door.mapping("POST", "/api/cases", {"name": "benchmark"})
    door.mapping("POST", f"/api/cases/{case['id']}/open", {})
    # What tracking takes from its start on is not the CT's.
    _until(lambda: _tracks(door))
    with _watched(server.pid) as memory:
        begun, sent_s = door.send("/api/ct?made_by=benchmark", archive)
        first_s = _until(lambda: _is_shown(door, begun)) - sent_s
        open_s = _until(lambda: _is_done(door, begun)) - sent_s
        shown = []
        for plane in ("axial", "sagittal"):
            start = time.perf_counter()
            status, _ = door.ask("GET", f"/api/ct/slices/{plane}.png")
            if status != 200:
                raise RuntimeError(f"no {plane} slice: {status}")
            shown.append(1000.0 * (time.perf_counter() - start))
    return [
        name,
        f"{first_s:.1f}",
        f"{open_s:.1f}",
        *(f"{one:.0f}" for one in shown),
        f"{memory.server_mib / VOLUME_MIB:.2f}",
        f"{(memory.together_mib - memory.before_mib) / VOLUME_MIB:.2f}",
    ]


def _tracks(door: Door) -> bool:
    snapshot = door.mapping("GET", "/api/live").get("snapshot")
    return isinstance(snapshot, dict) and int(snapshot["image_number"]) > 3 * RATE_HZ


def _is_shown(door: Door, begun: Mapping[str, object]) -> bool:
    status, _ = door.ask("GET", f"/api/ct/uploads/{begun['upload_id']}/preview.png")
    # Once the CT is open there is no first slice to be asked for.
    return status in {200, 404}


def _is_done(door: Door, begun: Mapping[str, object]) -> bool:
    job = door.mapping("GET", f"/api/jobs/{begun['id']}")
    if job["state"] == "failed":
        raise RuntimeError(f"the CT was not read: {job['problem']}")
    return job["state"] == "done"


def _until(true: Callable[[], bool]) -> float:
    deadline_s = time.perf_counter() + PATIENCE_S
    while not true():
        if time.perf_counter() > deadline_s:
            raise RuntimeError("it took too long")
        time.sleep(0.02)
    return time.perf_counter()


@contextmanager
def _watched(pid: int) -> Iterator[Memory]:
    """The memory of the server and all under it, looked at again and again until the block ends."""
    memory, over = Memory(before_mib=_together_mib(pid)), threading.Event()

    def watch() -> None:
        while not over.wait(WATCH_EVERY_S):
            memory.server_mib = max(memory.server_mib, _mib(pid, "status", "VmRSS"))
            memory.together_mib = max(memory.together_mib, _together_mib(pid))

    thread = threading.Thread(target=watch, name="watching memory", daemon=True)
    thread.start()
    try:
        yield memory
    finally:
        over.set()
        thread.join()


def _together_mib(pid: int) -> float:
    return sum(_mib(one, "smaps_rollup", "Pss") for one in (pid, *_under(pid)))


def _under(pid: int) -> list[int]:
    """All processes under one; those that end meanwhile are left out."""
    found = []
    for task in Path(f"/proc/{pid}/task").glob("*/children"):
        try:
            children = [int(word) for word in task.read_text().split()]
        except OSError:
            continue
        for child in children:
            found += [child, *_under(child)]
    return found


def _mib(pid: int, file: str, name: str) -> float:
    try:
        text = Path(f"/proc/{pid}/{file}").read_text()
    except OSError:
        return 0.0
    told = re.search(rf"^{name}:\s+(\d+) kB", text, re.MULTILINE)
    return int(told[1]) / 1024.0 if told else 0.0
