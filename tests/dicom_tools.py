"""Programs of others that read what Coaxial writes: dcmtk's tools and Orthanc, both packages of Debian."""

import json
import os
import shutil
import socket
import subprocess
import threading
import urllib.request
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from pynetdicom.transport import AssociationSocket

# Debian has Orthanc where only root's path leads.
WHERE = os.pathsep.join([os.environ.get("PATH", os.defpath), "/usr/sbin", "/usr/local/sbin"])


def dicom_tool(name: str) -> Path:
    """Path of a program; without it the test is skipped, or fails in continuous integration."""
    found = shutil.which(name, path=WHERE)
    if found is not None:
        return Path(found)
    sentence = f"needs {name}: install the packages dcmtk and orthanc, as .make/find-dicom-tools does"
    if os.environ.get("CI") == "true":
        pytest.fail(sentence)
    pytest.skip(sentence)


def free_port() -> int:
    """A port of this computer that nobody listens on."""
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        port: int = one.getsockname()[1]
    return port


def close_always(self: AssociationSocket) -> None:
    """Close a socket also if its peer is gone, where pynetdicom leaves it to the garbage collector."""
    if self.socket is not None:
        with suppress(OSError):
            self.socket.shutdown(socket.SHUT_RDWR)
        self.socket.close()


@pytest.fixture(autouse=True)
def closed_sockets(monkeypatch: pytest.MonkeyPatch) -> None:
    """No socket of pynetdicom is left open; for a module that imports this."""
    monkeypatch.setattr(AssociationSocket, "_shutdown_socket", close_always)


@dataclass(frozen=True, slots=True, kw_only=True)
class Orthanc:
    """A running archive."""

    port: int
    http: str

    def find(self, level: str, query: dict[str, str]) -> list[dict[str, Any]]:
        """What it stores at a level ("Study", "Series", "Instance") that matches."""
        request = json.dumps({"Level": level, "Query": query, "Expand": True}).encode()
        with urllib.request.urlopen(f"{self.http}/tools/find", data=request, timeout=30) as answer:  # noqa: S310  loopback
            found: list[dict[str, Any]] = json.load(answer)
        return found

    def get(self, address: str) -> bytes:
        """The content of one of its addresses."""
        with urllib.request.urlopen(f"{self.http}{address}", timeout=30) as answer:  # noqa: S310  loopback
            content: bytes = answer.read()
        return content

    def post(self, address: str, content: object) -> Any:  # noqa: ANN401  JSON
        """The answer to a request with a JSON body, or with bytes."""
        body = content if isinstance(content, bytes) else json.dumps(content).encode()
        with urllib.request.urlopen(f"{self.http}{address}", data=body, timeout=60) as answer:  # noqa: S310  loopback
            return json.load(answer)


@contextmanager
def orthanc_in(folder: Path, *, settings: Mapping[str, object] | None = None) -> Iterator[Orthanc]:
    """An Orthanc on free ports of this computer, whose data are in a folder."""
    program = dicom_tool("Orthanc")
    folder.mkdir(parents=True, exist_ok=True)
    http, port = free_port(), free_port()
    configuration = {
        "StorageDirectory": str(folder / "storage"),
        "HttpPort": http,
        "DicomPort": port,
        "RemoteAccessAllowed": False,
        "AuthenticationEnabled": False,
        "DicomAlwaysAllowStore": True,
        "DicomCheckCalledAet": True,
        "DicomAet": "ORTHANC",
        **(settings or {}),
    }
    (folder / "orthanc.json").write_text(json.dumps(configuration))
    process = subprocess.Popen(
        [program, folder / "orthanc.json"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    try:
        assert process.stdout is not None
        for line in process.stdout:
            if "Orthanc has started" in line:
                break
        else:
            pytest.fail("Orthanc did not start")
        drain = threading.Thread(target=process.stdout.read, daemon=True)
        drain.start()
        yield Orthanc(port=port, http=f"http://127.0.0.1:{http}")
    finally:
        process.terminate()
        process.wait(20)
        drain.join(20)
        process.stdout.close()
