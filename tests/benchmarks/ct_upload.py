"""Upload of a CT of 512 x 512 x 400 voxels to a running server: time to the first slice, and memory.

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

from tests.benchmarks.ct_reading import SIZE_WH, SLICES, write_series, zipped
from tests.benchmarks.options import BenchmarkOptions
from tests.benchmarks.running_server import RunningServer, running_server
from tests.benchmarks.tables import Table

KINDS = {"uncompressed": uid.ExplicitVRLittleEndian, "JPEG 2000": uid.JPEG2000Lossless}
RATE_HZ = 30.0
VOLUME_MIB = SIZE_WH[0] * SIZE_WH[1] * SLICES * 2 / 2**20
POLL_EVERY_S = 0.1
NOTE = (
    "Times begin when the last byte was sent. Memory is over the 200 MiB of the voxels: `server` is the most "
    "that the web server held, with what it had before; `all` is what it and every process under it "
    "(tracking, reading, decoding) held more than before, what they share and the mapped file counted once."
)
PATIENCE_S = 300.0
Status: TypeAlias = dict[str, object]


@dataclass(slots=True, kw_only=True)
class Memory:
    """Peak memory in MiB; shared memory is counted once."""

    server_mib: float = 0.0
    together_mib: float = 0.0
    before_mib: float = 0.0


@dataclass(slots=True)
class HttpClient:
    """A persistent HTTP connection to the server."""

    port: int

    def request(self, method: str, path: str, body: bytes | None = None) -> tuple[int, bytes]:
        """Return status and content of a response."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE_S)
        try:
            headers = {"Content-Type": "application/json"} if body else {}
            connection.request(method, path, body, headers)
            answer = connection.getresponse()
            return answer.status, answer.read()
        finally:
            connection.close()

    def mapping(self, method: str, path: str, options: Mapping[str, object] | None = None) -> Status:
        """Return the response as JSON; RuntimeError for an error status."""
        status, content = self.request(
            method, path, None if options is None else json.dumps(options).encode()
        )
        if status >= 300:
            raise RuntimeError(f"{method} {path}: {status} {content[:300]!r}")
        answer: Status = json.loads(content)
        return answer

    def send(self, path: str, file: Path) -> tuple[Status, float]:
        """Send a file as the body; return the response, and when the last byte was sent."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE_S)
        with file.open("rb") as content:
            connection.putrequest("POST", path)
            connection.putheader("Content-Length", str(file.stat().st_size))
            connection.endheaders()
            while chunk := content.read(2**20):
                connection.send(chunk)
        sent_s = time.perf_counter()
        answer: Status = json.loads(connection.getresponse().read())
        connection.close()
        return answer, sent_s


def measure_ct_upload(options: BenchmarkOptions) -> list[Table]:
    """Table of both compressions, as a zip."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name, syntax in KINDS.items():
            made = Path(folder) / name
            write_series(made, syntax)
            archive = zipped(made)
            with running_server(options, seed=options.seeds[0], live_rate_hz=RATE_HZ) as server:
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
    client = HttpClient(server.port)
    case = client.mapping("POST", "/api/cases", {"name": "benchmark"})
    client.mapping("POST", f"/api/cases/{case['id']}/open", {})
    # Memory that tracking allocates at its start does not belong to the CT.
    _until(lambda: _tracks(client))
    with _monitored(server.pid) as memory:
        begun, sent_s = client.send("/api/ct?made_by=benchmark", archive)
        first_s = _until(lambda: _is_shown(client, begun)) - sent_s
        open_s = _until(lambda: _is_done(client, begun)) - sent_s
        shown = []
        for plane in ("axial", "sagittal"):
            start = time.perf_counter()
            status, _ = client.request("GET", f"/api/ct/slices/{plane}.png")
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


def _tracks(client: HttpClient) -> bool:
    snapshot = client.mapping("GET", "/api/live").get("snapshot")
    return isinstance(snapshot, dict) and int(snapshot["image_number"]) > 3 * RATE_HZ


def _is_shown(client: HttpClient, begun: Mapping[str, object]) -> bool:
    status, _ = client.request("GET", f"/api/ct/uploads/{begun['upload_id']}/preview.png")
    # Once the CT is open, the first slice can no longer be requested.
    return status in {200, 404}


def _is_done(client: HttpClient, begun: Mapping[str, object]) -> bool:
    job = client.mapping("GET", f"/api/jobs/{begun['id']}")
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
def _monitored(pid: int) -> Iterator[Memory]:
    """Sample the memory of the server and its child processes until the block ends."""
    memory, over = Memory(before_mib=_together_mib(pid)), threading.Event()

    def watch() -> None:
        while not over.wait(POLL_EVERY_S):
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
    """Return all descendants of a process; those that end meanwhile are left out."""
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
    reported = re.search(rf"^{name}:\s+(\d+) kB", text, re.MULTILINE)
    return int(reported[1]) / 1024.0 if reported else 0.0
