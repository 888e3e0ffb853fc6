"""Run a server for hours with viewers, alarms, recordings, jobs and kills, and report what grows.

    make soak HOURS=8
    PYTHONPATH=. python -m tests.procedure.soak --hours 8 [--viewers 10] [--rate-hz 30]

A navigating rehearsal with viewers that come and go. Each round records, acknowledges alarms, makes an index
and tables of the recording, deletes it, and kills the tracking process or the one that records. The memory of
the web process must stay within 5 % of what it was after the first quarter; of descriptors, threads,
processes and files none may be left; and the 99th percentile of the ages must not grow.
"""

import argparse
import json
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from server.config import Config
from tests.procedure.killing.people import CONFIRM
from tests.procedure.killing.processes import PROC, family_of, kill, left_behind
from tests.procedure.killing.theatre import prepare, settings_of
from tests.procedure.real_server import CHECKOUT, RealServer, unended_server

ROUND_S, SETTLING_S = 40.0, 5.0
MAX_GROWTH_RATIO, MAX_AGE_GROWTH_RATIO = 0.05, 0.25
NOT_INDEXED = 409
COLUMNS = "{:<26}{:>16}{:>12}\n"


@dataclass(frozen=True, slots=True, kw_only=True)
class Sample:
    """What the server holds, at rest: no recording, no job.

    Attributes:
        at_s: monotonic time.
        web_mb: memory of the web process alone, without the images that it shares with others.
        descriptors, threads: of the web process.
        processes: of the server.
        files: in its folder, without recordings.
    """

    at_s: float
    web_mb: float
    descriptors: int
    threads: int
    processes: int
    files: int


def sample(pid: int, home: Path) -> Sample:
    """Return what a server holds now."""
    process = PROC / str(pid)
    own_kb = next(
        int(line.split()[1])
        for line in (process / "smaps_rollup").read_text(encoding="ascii").splitlines()
        if line.startswith("Anonymous:")
    )
    return Sample(
        at_s=time.monotonic(),
        web_mb=own_kb / 1024.0,
        descriptors=len(list((process / "fd").iterdir())),
        threads=len(list((process / "task").iterdir())),
        processes=len(family_of(pid).pids),
        files=sum(one.is_file() and "recordings" not in one.parts for one in home.rglob("*")),
    )


class SoakedServer:
    """A navigating server, and one round of its work after the other."""

    def __init__(self, server: RealServer, *, seed: int) -> None:
        self.server, self.kills = server, 0
        self._rng = random.Random(seed)
        (case,) = server.ask("GET", "/api/cases", 200)["cases"]
        server.ask("POST", "/api/recordings/consent", 200, json={"case_id": case["id"], "is_given": True})
        self.confirm()

    def confirm(self) -> None:
        """Begin the navigation, or go on with it."""
        self.server.shown()
        needed = self.server.ask("GET", "/api/procedure", 200)["confirmation"]
        if needed is not None:
            given = {"registration_id": needed["registration_id"]}
            self.server.ask("POST", CONFIRM, 200, json=given)

    def work(self, seconds: float) -> None:
        """Record for this time with alarms and a kill, then export and delete the recording."""
        until_s = time.monotonic() + seconds
        name = self.server.ask("POST", "/api/recordings/start", 200)["name"]
        kill_at_s = until_s - seconds * self._rng.uniform(0.2, 0.8)
        while time.monotonic() < until_s:
            numbers = [one["number"] for one in self.server.ask("GET", "/api/alarms", 200)["alarms"]]
            if numbers:
                self.server.door.post("/api/alarms/acknowledgement", json={"numbers": numbers, "by": "Ito"})
            if time.monotonic() > kill_at_s:
                kill_at_s = float("inf")
                self._kill()
            time.sleep(1.0)
        self.server.ask("POST", "/api/recordings/stop", 200)
        self._export(name)
        self.server.ask("DELETE", f"/api/recordings/{name}", 204)

    def _kill(self) -> None:
        family = family_of(self.server.process.pid)
        target = self._rng.choice((family.tracking, family.recording))
        if target is not None:
            kill((target,))
            self.kills += 1
            self.confirm()

    def _export(self, name: str) -> None:
        def is_indexed() -> bool:
            self.server.ask("GET", f"/api/recordings/{name}/timeline", 200)
            return bool(
                self.server.door.get(f"/api/recordings/{name}/images/0.jpg").status_code != NOT_INDEXED
            )

        self.server.until("an index", is_indexed)
        for table in ("poses", "alarms"):
            self.server.door.get(f"/api/recordings/{name}/export/{table}.csv").raise_for_status()


def soak(*, hours: float, viewers: int, rate_hz: float, seed: int) -> int:
    """Run the soak and print its report; return the number of limits that were exceeded."""
    seconds = 3600.0 * hours
    settings: dict[str, Any] = settings_of(reference=True)
    settings["rehearsal"] = {**settings["rehearsal"], "rate_hz": rate_hz, "skill": "breaching"}
    settings["recording"] = {"when": "manual"}
    with tempfile.TemporaryDirectory() as name, ExitStack() as ending:
        folder = Path(name) / "server"
        folder.mkdir()
        prepare(folder / "home", Config.model_validate(settings))
        server = unended_server(ending, folder, settings)
        # Whatever happens: its end is waited for.
        ending.callback(lambda: kill(family_of(server.process.pid).pids))
        soaked = SoakedServer(server, seed=seed)
        began_s = time.monotonic()
        crowd = subprocess.Popen(
            [
                *(sys.executable, "-m", "tests.procedure.soak_viewers", "--port", str(server.port)),
                *("--viewers", str(viewers), "--seconds", str(seconds)),
            ],
            cwd=CHECKOUT,
            stdout=ending.enter_context((Path(name) / "ages.txt").open("w")),
        )
        samples = [sample(server.process.pid, folder / "home")]
        try:
            while time.monotonic() < began_s + seconds - ROUND_S:
                soaked.work(ROUND_S)
                time.sleep(SETTLING_S)
                samples.append(sample(server.process.pid, folder / "home"))
            crowd.wait(seconds)
            time.sleep(SETTLING_S)
            samples.append(sample(server.process.pid, folder / "home"))
        finally:
            crowd.kill()
            crowd.wait()
        family = family_of(server.process.pid)
        server.process.send_signal(signal.SIGTERM)
        server.process.wait(60.0)
        left = [*left_behind(family), *_temporary_files(folder / "home")]
        ages = [
            tuple(map(float, line.split())) for line in (Path(name) / "ages.txt").read_text().splitlines()
        ]
    return _report(samples, ages, left, kills=soaked.kills, began_s=began_s)


def _temporary_files(home: Path) -> list[str]:
    return [f"{one} is left" for one in (home / "temporary").rglob("*")]


def _report(
    samples: Sequence[Sample],
    ages: Sequence[tuple[float, ...]],
    left: Sequence[str],
    *,
    kills: int,
    began_s: float,
) -> int:
    end_s = samples[-1].at_s
    quarter_s = began_s + (end_s - began_s) / 4.0
    first = next(one for one in samples if one.at_s >= quarter_s)
    last = samples[-1]
    early = [age for at_s, age in ages if quarter_s - (end_s - began_s) / 8.0 <= at_s <= first.at_s]
    late = [age for at_s, age in ages if at_s >= end_s - (end_s - began_s) / 4.0]
    p99 = [float(np.percentile(one, 99)) if one else float("nan") for one in (early, late)]
    rows = [
        ("web process, MB", first.web_mb, last.web_mb, first.web_mb * (1.0 + MAX_GROWTH_RATIO)),
        ("descriptors", first.descriptors, last.descriptors, first.descriptors),
        ("threads", first.threads, last.threads, first.threads),
        ("processes", first.processes, last.processes, first.processes),
        ("files", first.files, last.files, first.files),
        ("age p99, ms", p99[0], p99[1], p99[0] * (1.0 + MAX_AGE_GROWTH_RATIO)),
    ]
    words = (
        f"{(end_s - began_s) / 60.0:.0f} min, {len(samples) - 2} rounds, {kills} kills, {len(ages)} results"
    )
    sys.stdout.write(f"{words}\n{COLUMNS.format('', 'first quarter', 'end')}")
    exceeded = 0
    for what, before, after, limit in rows:
        is_exceeded = not after <= limit
        exceeded += is_exceeded
        numbers = (f"{before:.1f}", f"{after:.1f}{' !' if is_exceeded else ''}")
        sys.stdout.write(COLUMNS.format(what, *numbers))
    sys.stdout.write("".join(f"{one}\n" for one in left))
    sys.stdout.write(
        json.dumps([[round(one.web_mb, 1), one.descriptors, one.threads] for one in samples]) + "\n"
    )
    return exceeded + len(left)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--hours", type=float, default=8.0)
    parser.add_argument("--viewers", type=int, default=10)
    parser.add_argument("--rate-hz", type=float, default=30.0)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    sys.exit(min(1, soak(hours=given.hours, viewers=given.viewers, rate_hz=given.rate_hz, seed=given.seed)))
