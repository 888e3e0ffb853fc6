"""NATS server of others, the package nats-server of Debian, for tests of the hub."""

import os
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.dicom_tools import free_port

WHERE = os.pathsep.join([os.environ.get("PATH", os.defpath), "/usr/sbin", "/usr/local/bin"])
START_TIMEOUT_S = 30.0


def nats_program() -> str:
    """Path of nats-server; without it the test is skipped, or fails in continuous integration."""
    found = shutil.which("nats-server", path=WHERE)
    if found is not None:
        return found
    sentence = "needs nats-server: install the package of this name, as .make/find-nats-server does"
    if os.environ.get("CI") == "true" or os.environ.get("COAXIAL_REQUIRE_DATA") == "1":
        pytest.fail(sentence)
    pytest.skip(sentence)


class NatsServer:
    """A NATS server with JetStream on a free port, which can be killed and started again with its data.

    Args:
        folder: of its data and its settings.
        settings: more lines of its settings, as users and TLS.
    """

    def __init__(self, folder: Path, *, settings: str = "") -> None:
        self.port = free_port()
        self._file = folder / "nats.conf"
        folder.mkdir(parents=True, exist_ok=True)
        self._file.write_text(
            f'listen: "127.0.0.1:{self.port}"\njetstream {{ store_dir: "{folder / "data"}" }}\n{settings}\n'
        )
        self._program = nats_program()
        self._process: subprocess.Popen[bytes] | None = None

    @property
    def url(self) -> str:
        """Its address."""
        return f"nats://127.0.0.1:{self.port}"

    @property
    def pid(self) -> int:
        """Id of its process."""
        assert self._process is not None
        return self._process.pid

    def start(self) -> None:
        """Start it; returns when it accepts connections."""
        self._process = subprocess.Popen(
            [self._program, "-c", self._file], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        deadline_s = time.monotonic() + START_TIMEOUT_S
        while True:
            assert self._process.poll() is None, "nats-server did not start"
            try:
                socket.create_connection(("127.0.0.1", self.port), timeout=1.0).close()
            except ConnectionRefusedError:
                assert time.monotonic() < deadline_s, "nats-server does not listen"
                time.sleep(0.01)
            else:
                return

    def kill(self) -> None:
        """End it without any farewell."""
        if self._process is not None:
            self._process.send_signal(signal.SIGKILL)
            self._process.wait(20)
            self._process = None


@contextmanager
def nats_in(folder: Path, *, settings: str = "") -> Iterator[NatsServer]:
    """Return a running NATS server whose data are in a folder."""
    server = NatsServer(folder, settings=settings)
    server.start()
    try:
        yield server
    finally:
        server.kill()
