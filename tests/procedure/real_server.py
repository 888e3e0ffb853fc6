"""A server in its own process, started as by a user, with the rehearsal as its camera."""

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import httpx2
import yaml
from websockets.sync.client import connect

CHECKOUT = Path(__file__).resolve().parents[2]
# Timeout of each wait on a busy machine.
PATIENCE_S = 600.0
# Each look is a request that takes the server some milliseconds.
LOOK_AGAIN_S = 0.1
# A busy machine delays images; other tests check that alarm. A screen is armed once and stays armed.
BUSY_MACHINE: Mapping[str, object] = {
    "limits": {"pose_stale_after_ms": 10_000, "video_stale_after_ms": 10_000, "scene_stale_after_ms": 10_000},
    "alarms": {"screen_lost_after_s": 600},
}
# Access rules are tested elsewhere.
OPEN_DOOR: Mapping[str, object] = {"security": {"sign_in": "off"}}


@dataclass(slots=True, kw_only=True)
class RealServer:
    """A running server and its process."""

    port: int
    process: "subprocess.Popen[str]"
    door: httpx2.Client

    def ask(self, method: str, path: str, status: int, **sent: Any) -> Any:  # noqa: ANN401  JSON
        """Return the answer, which must have this status."""
        answer = self.door.request(method, path, **sent)
        assert answer.status_code == status, f"{method} {path}: {answer.status_code} {answer.text[:600]}"
        return answer.json() if answer.content else None

    def rejected(self, method: str, path: str, code: str, **sent: Any) -> Any:  # noqa: ANN401  JSON
        """Return the rejection of a step out of order: code, message and remedy."""
        reported = self.ask(method, path, 409, **sent)
        assert reported["code"] == code, reported
        assert reported["message"]
        assert reported["remedy"].endswith(".")
        return reported

    def until(self, what: str, true: Callable[[], Any]) -> Any:  # noqa: ANN401  whatever became true
        """Return this value as soon as it is true."""
        deadline_s = time.monotonic() + PATIENCE_S
        while not (given := true()):
            assert time.monotonic() < deadline_s, f"not within {PATIENCE_S:g} s: {what}"
            time.sleep(LOOK_AGAIN_S)
        return given

    def shown(self) -> Any:  # noqa: ANN401  JSON
        """Return the newest snapshot as soon as there is one that is not stale."""
        return self.until("a snapshot", lambda: self.ask("GET", "/api/live", 200)["snapshot"])

    def done(self, job: Mapping[str, Any]) -> Any:  # noqa: ANN401  JSON
        """Wait for a job and return its result."""

        def over() -> Any:  # noqa: ANN401  JSON
            now = self.ask("GET", f"/api/jobs/{job['id']}", 200)
            return now if now["state"] in {"done", "failed", "cancelled"} else None

        reported = self.until(str(job["title"]), over)
        assert reported["state"] == "done", reported["problem"]
        return reported["result"]

    @contextmanager
    def listening(self) -> Iterator[Iterator[dict[str, Any]]]:
        """Messages of `/ws/live`, as a client receives them."""
        with connect(f"ws://127.0.0.1:{self.port}/ws/live", proxy=None, compression=None) as socket:
            yield (_message(socket.recv(timeout=PATIENCE_S)) for _ in iter(int, 1))


def _message(text: str | bytes) -> dict[str, Any]:
    reported: dict[str, Any] = httpx2.Response(200, content=text).json()
    return reported


@contextmanager
def real_server(
    folder: Path, settings: Mapping[str, object], *, packages: Path | None = None
) -> Iterator[RealServer]:
    """`coaxial run` with these settings and its cases in this folder, ended by its own process id.

    `packages`: a folder with further packages, added to its import path.

    """
    with started(folder, settings, packages=packages) as process:
        try:
            port = port_of(process)
            with httpx2.Client(base_url=f"http://127.0.0.1:{port}", timeout=PATIENCE_S) as door:
                yield RealServer(port=port, process=process, door=door)
        finally:
            process.send_signal(signal.SIGTERM)
            try:
                process.wait(PATIENCE_S)
            except subprocess.TimeoutExpired:
                process.kill()
                raise
    assert process.returncode == 0, f"the server ended with status {process.returncode}"


def started(
    folder: Path,
    settings: Mapping[str, object],
    *,
    errors: IO[str] | None = None,
    packages: Path | None = None,
) -> "subprocess.Popen[str]":
    """The process of `coaxial run`, which may not answer yet; its log goes to `errors`."""
    folder.mkdir(exist_ok=True)
    (folder / "config.yaml").write_text(yaml.safe_dump({**OPEN_DOOR, **settings}), encoding="utf-8")
    return subprocess.Popen(
        [sys.executable, "-m", "server", "run", "--port", "0"],
        cwd=folder,
        env={
            **os.environ,
            "PYTHONPATH": os.pathsep.join(map(str, filter(None, (CHECKOUT, packages)))),
            "COAXIAL_HOME": str(folder / "home"),
        },
        stdout=subprocess.PIPE,
        stderr=errors,
        text=True,
    )


def unended_server(ending: ExitStack, folder: Path, settings: Mapping[str, object]) -> RealServer:
    """A server that its caller kills; `ending` then closes what belongs to it. Its log is in this folder."""
    errors = ending.enter_context((folder / "log.txt").open("a", encoding="utf-8"))
    process = ending.enter_context(started(folder, settings, errors=errors))
    port = port_of(process)
    door = ending.enter_context(httpx2.Client(base_url=f"http://127.0.0.1:{port}", timeout=PATIENCE_S))
    return RealServer(port=port, process=process, door=door)


def port_of(process: "subprocess.Popen[str]") -> int:
    for line in process.stdout or ():
        found = re.search(r"http://127\.0\.0\.1:(\d+)/", line)
        if found is not None:
            return int(found[1])
    raise AssertionError(
        f"the server ended with status {process.wait(PATIENCE_S)} before it said its address"
    )
