"""A server under load by viewers: cost to the tracker, and what each viewer receives."""

import json
import re
import subprocess
import sys
import threading
import time
import urllib.request
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from tests.benchmarks.load.stalled_viewer import StalledViewer
from tests.benchmarks.running_server import CHECKOUT, PATIENCE_S, RunningServer
from tests.benchmarks.viewer import cpu_s

SETTLING_S = 3.0
# Excluded from the tracker's time: waiting for the scheduler, and work of the web server.
NOT_TRACKER = frozenset({"waiting", "overlay", "encode"})
RESIDENT = re.compile(r"VmRSS:\s+(\d+) kB")
DISCONNECTED = re.compile(r"^coaxial_viewer_let_go_total\{.*\} ([0-9.]+)$", re.MULTILINE)


@dataclass(frozen=True, slots=True, kw_only=True)
class ViewerResult:
    """What one viewer received; see `stream_readers.ReceivedImages`."""

    kind: str
    is_open: bool
    seconds: float
    ages_ms: list[float]
    scales: list[float | None]
    total_bytes: int

    @property
    def images_per_s(self) -> float:
        """Return the number of images per second."""
        return len(self.ages_ms) / self.seconds


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadResult:
    """Measurement of an interval with a number of viewers.

    Attributes:
        viewers: all of them, including the stalled and the slow one.
        tracker_ms: time of the tracking process for each image, without waiting.
        received: by each viewer with a fast connection.
        slow: of the viewer on 1 Mbit/s.
        stalled_s: time until the stalled viewer was disconnected.
        disconnected: number of viewers that were disconnected.
        resident_mb: of the web server, at the beginning and at the end.
        cpu_ratio: of the web server and of the tracking process (with the theatre's rendering), of a core.
    """

    viewers: int
    tracker_ms: list[float]
    received: Sequence[ViewerResult] = ()
    slow: ViewerResult | None = None
    stalled_s: float | None = None
    disconnected: int = 0
    resident_mb: tuple[float, float] = (float("nan"), float("nan"))
    cpu_ratio: dict[str, float] = field(default_factory=dict)


class TrackerTimes(threading.Thread):
    """Listens to `/ws/live`, with and without viewers, for the tracker's own times."""

    def __init__(self, server: RunningServer) -> None:
        super().__init__(daemon=True)
        self._socket = connect(server.socket_address("/ws/live"), proxy=None, compression=None)
        self._received: list[float] = []
        self.start()

    def run(self) -> None:
        """Record the times of each image."""
        try:
            for text in self._socket:
                snapshot = json.loads(text)["snapshot"]
                if snapshot is not None:
                    spent = snapshot["stage_ms"].items()
                    self._received.append(sum(ms for name, ms in spent if name not in NOT_TRACKER))
        except ConnectionClosed:
            return

    def await_first(self) -> None:
        """Wait until the tracker has run for a while: the first images include loading."""
        while len(self._received) < 30:
            time.sleep(0.1)

    def taken_during(self, seconds: float) -> list[float]:
        """Times of all images in the next seconds."""
        before = len(self._received)
        time.sleep(seconds)
        return self._received[before:]

    def close(self) -> None:
        """Close the connection."""
        self._socket.close()
        self.join(PATIENCE_S)


def mix(viewers: int) -> dict[str, int]:
    """Viewers by kind, as in a theatre: most watch the page, some plain video, some numbers."""
    mjpeg, live = viewers // 4, viewers // 6
    return {"view": viewers - mjpeg - live, "mjpeg": mjpeg, "live": live}


def without_viewers(tracker_times: TrackerTimes, *, seconds: float) -> LoadResult:
    """Measure without viewers."""
    return LoadResult(viewers=0, tracker_ms=tracker_times.taken_during(seconds))


def with_viewers(
    server: RunningServer, tracker_times: TrackerTimes, viewers: int, *, seconds: float
) -> LoadResult:
    """Measure with viewers; from 3 on, one is stalled and one has a slow connection."""
    special = viewers >= 3
    resident, disconnected = resident_mb(server.pid), _disconnected_viewers(server)
    amounts = mix(viewers - 2 if special else viewers)
    process = _start_viewers(server, seconds, *(f"--{kind}={count}" for kind, count in amounts.items()))
    slow = _start_viewers(server, seconds, "--slow") if special else None
    stalled = StalledViewer(server.port) if special else None
    time.sleep(SETTLING_S)
    cpu, began_s = cpu_s(server.pid), time.monotonic()
    tracker_ms = tracker_times.taken_during(seconds)
    spent_s, cpu_after = time.monotonic() - began_s, cpu_s(server.pid)
    resident_after = resident_mb(server.pid)
    received = _results_of(process)
    if stalled is not None:
        stalled.close()
    return LoadResult(
        viewers=viewers,
        tracker_ms=tracker_ms,
        received=received,
        slow=None if slow is None else _results_of(slow)[0],
        stalled_s=None if stalled is None else stalled.disconnected_after_s,
        disconnected=_disconnected_viewers(server) - disconnected,
        resident_mb=(resident, resident_after),
        cpu_ratio={}
        if cpu is None or cpu_after is None
        else {name: (cpu_after[name] - cpu[name]) / spent_s for name in cpu},
    )


def _start_viewers(server: RunningServer, seconds: float, *arguments: str) -> "subprocess.Popen[str]":
    return subprocess.Popen(
        [
            sys.executable,
            *("-m", "tests.benchmarks.load.viewer_process", "--port", str(server.port)),
            *("--settling", str(SETTLING_S), "--seconds", str(seconds), *arguments),
        ],
        cwd=CHECKOUT,
        stdout=subprocess.PIPE,
        text=True,
    )


def _results_of(process: "subprocess.Popen[str]") -> list[ViewerResult]:
    try:
        reported, _ = process.communicate(timeout=PATIENCE_S)
    finally:
        if process.poll() is None:
            process.kill()
    return [ViewerResult(**one) for one in json.loads(reported)]


def resident_mb(pid: int) -> float:
    """Resident memory of a process; NaN if the system does not provide it."""
    status = Path(f"/proc/{pid}/status")
    found = RESIDENT.search(status.read_text(encoding="ascii")) if status.exists() else None
    return float("nan") if found is None else int(found[1]) / 1000.0


def _disconnected_viewers(server: RunningServer) -> int:
    with urllib.request.urlopen(f"http://127.0.0.1:{server.port}/metrics", timeout=PATIENCE_S) as answer:
        return round(sum(float(number) for number in DISCONNECTED.findall(answer.read().decode())))
