"""`coaxial run` from its first line to its last."""

import json
import os
import re
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

from server.store import CaseStore, Home

REPOSITORY = Path(__file__).parents[3]


def ask(address: str, path: str, sent: object, **headers: str) -> tuple[Any, str]:
    """Send a request as a page does; return the answer and its cookie."""
    said = {"Content-Type": "application/json", "Origin": address.rstrip("/"), **headers}
    requested = urllib.request.Request(address + path, data=json.dumps(sent).encode(), headers=said)  # noqa: S310
    with urllib.request.urlopen(requested, timeout=60) as answer:  # noqa: S310  our own address
        return json.load(answer), str(answer.headers["Set-Cookie"])


def create_case(address: str, link: str) -> str:
    """Sign in with the link and create a case; return its id."""
    entered, cookie = ask(address, "api/session", {"invitation": link.partition("#")[2]})
    assert (entered["name"], entered["role"], entered["token"]) == ("Operator", "operator", None)
    assert {"HttpOnly", "SameSite=Strict", "Path=/"} <= set(cookie.split("; "))
    made, _ = ask(address, "api/cases", {"name": "one"}, Cookie=cookie.split(";")[0])
    return str(made["id"])


@pytest.mark.parametrize("ending", [signal.SIGINT, signal.SIGTERM])
def test_it_prints_one_address_serves_it_and_stops_without_a_word(
    tmp_path: Path, ending: signal.Signals
) -> None:
    writer = cv2.VideoWriter(str(tmp_path / "v.avi"), cv2.VideoWriter.fourcc(*"MJPG"), 25.0, (64, 48))
    for number in range(6):
        writer.write(np.full((48, 64, 3), 20 * number, dtype=np.uint8))
    writer.release()
    with subprocess.Popen(
        [sys.executable, "-m", "server", "run", "--source", "v.avi", "--port", "0"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(REPOSITORY), "COAXIAL_HOME": str(tmp_path / "home")},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # As in a terminal, where Ctrl+C reaches every process of the group; service managers do the same.
        start_new_session=True,
    ) as server:
        assert server.stdout is not None
        first, address, link, last = (server.stdout.readline().strip() for _ in range(4))
        assert "research software, not a medical device" in first
        found = re.fullmatch(r"Open (http://127\.0\.0\.1:\d+/)", address)
        assert found is not None
        assert last == "Press Ctrl+C to stop"
        with urllib.request.urlopen(found[1] + "health", timeout=60) as answer:  # noqa: S310  our own address
            assert answer.status == 200
        entry = re.fullmatch(
            rf"Sign in as operator \(once\): ({found[1]}enter#[0-9a-f]{{12}}\.[\w-]{{43}})", link
        )
        assert entry is not None
        case = create_case(found[1], entry[1])
        os.killpg(server.pid, ending)
        out, err = server.communicate(timeout=60)
    assert server.returncode == 0, err
    assert out == ""
    assert "Traceback" not in err
    assert "leaked" not in err
    assert '"level": "error"' not in err
    assert entry[1].partition("#")[2] not in err, "what opens the door is in no log"
    with Home(tmp_path / "home") as home, CaseStore(home) as store:
        assert [(stored.id, stored.name) for stored in store.list()] == [(case, "one")]


def test_a_second_server_with_the_same_folder_does_not_start(tmp_path: Path) -> None:
    with Home(tmp_path / "home"):
        second = subprocess.run(
            [sys.executable, "-m", "server", "run", "--port", "0"],
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": str(REPOSITORY), "COAXIAL_HOME": str(tmp_path / "home")},
            capture_output=True,
            text=True,
            check=False,
        )
    assert second.returncode == 2
    assert f"another Coaxial is running with the folder {tmp_path / 'home'}" in second.stderr
    assert "Traceback" not in second.stderr
