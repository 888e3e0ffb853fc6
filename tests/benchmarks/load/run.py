"""A real server under viewers: what it costs the tracker, and what each viewer gets."""

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

from tests.benchmarks.load.stalled import Stalled
from tests.benchmarks.running_server import CHECKOUT, PATIENCE_S, RunningServer
from tests.benchmarks.viewer import cpu_s

SETTLING_S = 3.0
# What is not the tracker's work: waiting for the process to be scheduled, and what the web server does.
NOT_TRACKER = frozenset({"waiting", "overlay", "encode"})
RESIDENT = re.compile(r"VmRSS:\s+(\d+) kB")
LET_GO = re.compile(r"^coaxial_viewer_let_go_total\{.*\} ([0-9.]+)$", re.MULTILINE)


@dataclass(frozen=True, slots=True, kw_only=True)
class Got:
    """What one viewer got; see `reading.Got`."""

    kind: str
    is_open: bool
    seconds: float
    ages_ms: list[float]
    scales: list[float | None]
    total_bytes: int

    @property
    def images_per_s(self) -> float:
        """How many came in a second."""
        return len(self.ages_ms) / self.seconds


@dataclass(frozen=True, slots=True, kw_only=True)
class Loaded:
    """One stretch of time with so many viewers.

    Attributes:
        viewers: all of them, the stalled and the thin one too.
        tracker_ms: time of the tracking process for each image, without waiting.
        got: of each viewer whose line carries everything.
        thin: of the one on 1 Mbit/s.
        stalled_s: after what time the stalled one was let go.
        let_go: how many viewers were let go.
        resident_mb: of the web server, at the beginning and at the end.
        cpu_ratio: of the web server and of the tracking process (with the theatre's rendering), of a core.
    """

    viewers: int
    tracker_ms: list[float]
    got: Sequence[Got] = ()
    thin: Got | None = None
    stalled_s: float | None = None
    let_go: int = 0
    resident_mb: tuple[float, float] = (float("nan"), float("nan"))
    cpu_ratio: dict[str, float] = field(default_factory=dict)


class Gauge(threading.Thread):
    """Listens to `/ws/live` all the while, with and without viewers, for the tracker's own times."""

    def __init__(self, server: RunningServer) -> None:
        super().__init__(daemon=True)
        self._socket = connect(server.socket_address("/ws/live"), proxy=None, compression=None)
        self._heard: list[float] = []
        self.start()

    def run(self) -> None:
        """Take each image's times."""
        try:
            for text in self._socket:
                snapshot = json.loads(text)["snapshot"]
                if snapshot is not None:
                    spent = snapshot["stage_ms"].items()
                    self._heard.append(sum(ms for name, ms in spent if name not in NOT_TRACKER))
        except ConnectionClosed:
            return

    def await_first(self) -> None:
        """Until the tracker has tracked for a while: the first images wait for loading."""
        while len(self._heard) < 30:
            time.sleep(0.1)

    def taken_during(self, seconds: float) -> list[float]:
        """The times of all images of so many seconds from now on."""
        before = len(self._heard)
        time.sleep(seconds)
        return self._heard[before:]

    def close(self) -> None:
        """Hear no more."""
        self._socket.close()
        self.join(PATIENCE_S)


def mix(viewers: int) -> dict[str, int]:
    """So many viewers by kind, as a theatre has them: most watch the page, some plain video, some numbers."""
    mjpeg, live = viewers // 4, viewers // 6
    return {"view": viewers - mjpeg - live, "mjpeg": mjpeg, "live": live}


def without_viewers(gauge: Gauge, *, seconds: float) -> Loaded:
    """Nobody watches."""
    return Loaded(viewers=0, tracker_ms=gauge.taken_during(seconds))


def with_viewers(server: RunningServer, gauge: Gauge, viewers: int, *, seconds: float) -> Loaded:
    """So many watch; from 3 on, one of them is stalled and one is on a thin line."""
    special = viewers >= 3
    resident, let_go = resident_mb(server.pid), _let_go(server)
    amounts = mix(viewers - 2 if special else viewers)
    crowd = _crowd(server, seconds, *(f"--{kind}={count}" for kind, count in amounts.items()))
    thin = _crowd(server, seconds, "--thin") if special else None
    stalled = Stalled(server.port) if special else None
    time.sleep(SETTLING_S)
    cpu, began_s = cpu_s(server.pid), time.monotonic()
    tracker_ms = gauge.taken_during(seconds)
    spent_s, cpu_after = time.monotonic() - began_s, cpu_s(server.pid)
    resident_after = resident_mb(server.pid)
    got = _told(crowd)
    if stalled is not None:
        stalled.close()
    return Loaded(
        viewers=viewers,
        tracker_ms=tracker_ms,
        got=got,
        thin=None if thin is None else _told(thin)[0],
        stalled_s=None if stalled is None else stalled.let_go_after_s,
        let_go=_let_go(server) - let_go,
        resident_mb=(resident, resident_after),
        cpu_ratio={}
        if cpu is None or cpu_after is None
        else {name: (cpu_after[name] - cpu[name]) / spent_s for name in cpu},
    )


def _crowd(server: RunningServer, seconds: float, *arguments: str) -> "subprocess.Popen[str]":
    return subprocess.Popen(
        [
            sys.executable,
            *("-m", "tests.benchmarks.load.crowd", "--port", str(server.port)),
            *("--settling", str(SETTLING_S), "--seconds", str(seconds), *arguments),
        ],
        cwd=CHECKOUT,
        stdout=subprocess.PIPE,
        text=True,
    )


def _told(crowd: "subprocess.Popen[str]") -> list[Got]:
    try:
        told, _ = crowd.communicate(timeout=PATIENCE_S)
    finally:
        if crowd.poll() is None:
            crowd.kill()
    return [Got(**one) for one in json.loads(told)]


def resident_mb(pid: int) -> float:
    """Memory of a process that is in use; not a number where the system does not tell."""
    status = Path(f"/proc/{pid}/status")
    found = RESIDENT.search(status.read_text(encoding="ascii")) if status.exists() else None
    return float("nan") if found is None else int(found[1]) / 1000.0


def _let_go(server: RunningServer) -> int:
    with urllib.request.urlopen(f"http://127.0.0.1:{server.port}/metrics", timeout=PATIENCE_S) as answer:
        return round(sum(float(number) for number in LET_GO.findall(answer.read().decode())))
