"""A server process started by its command line, used over HTTP, and stopped by its process id."""

import os
import re
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import yaml

from tests.benchmarks.options import BenchmarkOptions

CHECKOUT = Path(__file__).resolve().parents[2]
PATIENCE_S = 60.0


@dataclass(frozen=True, slots=True, kw_only=True)
class RunningServer:
    """A server that answers.

    Attributes:
        port: on 127.0.0.1.
        pid: of the web server; capture and tracking are its children.
    """

    port: int
    pid: int

    def socket_address(self, path: str) -> str:
        """Return the address of a WebSocket of this server."""
        return f"ws://127.0.0.1:{self.port}{path}"


@contextmanager
def running_server(
    options: BenchmarkOptions,
    *,
    seed: int,
    live_rate_hz: float,
    rehearsal: Mapping[str, object] | None = None,
) -> Iterator[RunningServer]:
    """Run `python -m server run` with the rehearsal of this seed until the end of the block.

    What is said of the rehearsal beside how hard it is: its scene, its skill, its events.

    Raises:
        RuntimeError: it does not say its address.
    """
    played = {
        "seed": seed,
        "rate_hz": live_rate_hz,
        "noise": options.noise,
        "blur": options.blur,
        "clutter": options.clutter,
        "light": options.light,
        **(rehearsal or {}),
    }
    with tempfile.TemporaryDirectory() as folder:
        settings = Path(folder) / "benchmark.yaml"
        settings.write_text(
            yaml.safe_dump({"rehearsal": played, "security": {"sign_in": "off"}}), encoding="utf-8"
        )
        with subprocess.Popen(
            [sys.executable, "-m", "server", "run", "--config", str(settings), "--port", "0"],
            cwd=folder,
            env={**os.environ, "PYTHONPATH": str(CHECKOUT), "COAXIAL_HOME": folder},
            stdout=subprocess.PIPE,
            stderr=sys.stderr,
            text=True,
        ) as process:
            try:
                yield RunningServer(port=_port_of(process), pid=process.pid)
            finally:
                process.send_signal(signal.SIGTERM)
                try:
                    process.wait(PATIENCE_S)
                except subprocess.TimeoutExpired:
                    process.kill()


def _port_of(process: "subprocess.Popen[str]") -> int:
    for line in process.stdout or ():
        found = re.search(r"http://127\.0\.0\.1:(\d+)/", line)
        if found is not None:
            return int(found[1])
    raise RuntimeError(f"the server ended with status {process.wait(PATIENCE_S)} before it said its address")
