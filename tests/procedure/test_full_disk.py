"""A full disk during navigation: an alarm, numbers continue, and nothing confirmed is lost."""

import subprocess
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from tests.procedure.real_server import BUSY_MACHINE, RealServer, real_server

ROOM_MB, MIN_MB = 40, 20
SETTINGS: dict[str, Any] = {
    **BUSY_MACHINE,
    "rehearsal": {"skill": "good", "width": 640, "height": 360, "rate_hz": 12},
    "alarms": {"screen_lost_after_s": 600, "min_free_disk_mb": MIN_MB},
}
HOLD = {"by": "Dr. Sato"}


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A home folder on a small disk of its own."""
    home = tmp_path / "home"
    home.mkdir()
    requested = ["mount", "-t", "tmpfs", "-o", f"size={ROOM_MB}m", "tmpfs", str(home)]
    with suppress(FileNotFoundError):
        if subprocess.run(requested, check=False, capture_output=True).returncode == 0:
            yield tmp_path
            subprocess.run(["umount", str(home)], check=True)
            return
    pytest.skip("no small disk can be mounted here")


@pytest.mark.timeout(900)
def test_a_full_disk_is_an_alarm_and_navigation_goes_on(small_disk: Path) -> None:
    filler = small_disk / "home" / "filler"
    with real_server(small_disk, SETTINGS) as server:
        case = server.ask("POST", "/api/cases", 201, json={"name": "kept"})
        server.ask("POST", f"/api/cases/{case['id']}/open", 200)
        numbers_of_new_images(server)
        assert "DISK_NEARLY_FULL" not in alarms(server)

        fill(filler)
        nearly = server.until("the alarm", lambda: alarms(server).get("DISK_NEARLY_FULL"))
        assert nearly["measure"]["value"] < nearly["measure"]["limit"] == MIN_MB
        numbers_of_new_images(server)
        rejected = until_rejected(server)
        assert rejected["code"] == "STORE_FULL"
        assert "MB are free" in rejected["message"]
        assert rejected["context"]["free_mb"] < 1.0
        assert rejected["remedy"].startswith("Free disk space")
        # A hold request is shown in theatre although it cannot be stored, and its requester is informed.
        assert server.ask("POST", "/api/alarms/hold", 507, json=HOLD)["code"] == "STORE_FULL"
        reported = alarms(server)
        assert {"HOLD_REQUESTED", "RECORDING_STOPPED"} <= reported.keys()
        numbers_of_new_images(server)

        filler.unlink()
        server.until("room again", lambda: "RECORDING_STOPPED" not in alarms(server))
        server.ask("POST", "/api/cases", 201, json={"name": "after"})
        names = [one["name"] for one in server.ask("GET", "/api/cases", 200)["cases"]]
        assert {"kept", "after"} <= set(names)
        lines = server.ask("GET", "/api/alarms/log", 200)["lines"]
        assert ("HOLD_REQUESTED", "Dr. Sato") in {(one.get("condition"), one.get("by")) for one in lines}


def fill(file: Path) -> None:
    """Write until nothing more fits."""
    with suppress(OSError), file.open("wb", buffering=0) as full:
        while full.write(bytes(4096)):
            pass


def until_rejected(server: RealServer) -> Any:  # noqa: ANN401  JSON
    """The error after the last free page of the database is used."""

    def rejection() -> Any:  # noqa: ANN401  JSON
        answer = server.door.post("/api/cases", json={"name": "x" * 200})
        return None if answer.status_code == 201 else (answer.status_code, answer.json())

    status, reported = server.until("a refusal", rejection)
    assert status == 507
    return reported


def alarms(server: RealServer) -> dict[str, Any]:
    return {one["condition"]: one for one in server.ask("GET", "/api/alarms", 200)["alarms"]}


def numbers_of_new_images(server: RealServer) -> None:
    """Images keep arriving, with numbers."""
    newest = server.shown()

    def is_newer() -> bool:
        now = server.ask("GET", "/api/live", 200)["snapshot"]
        is_new = now is not None and now["image_number"] > newest["image_number"]
        return is_new and now["tools"][0]["deviation"]["kind"] == "deviation"

    server.until("numbers of another image", is_newer)
