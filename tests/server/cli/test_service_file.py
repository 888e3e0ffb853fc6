"""`coaxial service-file`: a unit that systemd accepts, and that keeps the server in its own folders."""

import configparser
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from server.cli import app
from server.installation import UNIT_EXECUTABLE, service_unit

ANALYZE = shutil.which("systemd-analyze")
# Of systemd-analyze security, from 0 (contained) to 10.
MAX_EXPOSURE = 2.5


@pytest.fixture
def unit() -> str:
    printed = CliRunner().invoke(app, ["service-file"])
    assert printed.exit_code == 0
    return printed.stdout


def settings(unit: str) -> configparser.SectionProxy:
    parser = configparser.ConfigParser(strict=False, interpolation=None)
    parser.optionxform = str  # pyrefly: ignore[bad-assignment, method-assign]  # systemd's names have capitals
    parser.read_string(unit)
    return parser["Service"]


def test_it_starts_this_installation(unit: str) -> None:
    assert settings(unit)["ExecStart"] == f"{Path(sys.executable).parent / 'coaxial'} run"
    assert UNIT_EXECUTABLE not in unit


def test_it_writes_into_its_own_folders_and_gains_no_rights(unit: str) -> None:
    service = settings(unit)
    assert service["Environment"].split()[:2] == ["COAXIAL_HOME=%S/coaxial", "XDG_CACHE_HOME=%C"]
    assert service["StateDirectory"] == service["CacheDirectory"] == "coaxial"
    assert service["ProtectSystem"] == "strict"
    assert service["CapabilityBoundingSet"] == ""
    assert {service[name] for name in ("NoNewPrivileges", "ProtectHome", "DynamicUser", "PrivateTmp")} == {
        "yes"
    }


def test_an_installation_in_a_home_folder_is_warned_of(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(Path(sys.executable).parent.parent))
    assert "is in a home folder" in CliRunner().invoke(app, ["service-file"]).stderr


@pytest.mark.skipif(ANALYZE is None, reason="systemd-analyze is not installed")
def test_systemd_accepts_it(tmp_path: Path) -> None:
    file = tmp_path / "coaxial.service"
    file.write_text(service_unit(Path(sys.executable)))
    verified = subprocess.run(
        [str(ANALYZE), "verify", str(file)], check=False, capture_output=True, text=True
    )
    assert (verified.returncode, verified.stderr) == (0, "")


@pytest.mark.skipif(ANALYZE is None, reason="systemd-analyze is not installed")
def test_systemd_accepts_a_folder_with_spaces_and_per_cent_signs(tmp_path: Path) -> None:
    executable = tmp_path / "100 %h" / "coaxial"
    executable.parent.mkdir()
    executable.symlink_to(sys.executable)
    file = tmp_path / "coaxial.service"
    file.write_text(service_unit(executable))
    verified = subprocess.run(
        [str(ANALYZE), "verify", str(file)], check=False, capture_output=True, text=True
    )
    assert (verified.returncode, verified.stderr) == (0, "")


@pytest.mark.skipif(ANALYZE is None, reason="systemd-analyze is not installed")
def test_systemd_finds_it_contained(tmp_path: Path) -> None:
    file = tmp_path / "coaxial.service"
    file.write_text(service_unit(Path(sys.executable)))
    command = [str(ANALYZE), "security", "--offline=true", f"--threshold={int(MAX_EXPOSURE * 10)}", str(file)]
    judged = subprocess.run(command, check=False, capture_output=True, text=True)
    assert judged.returncode == 0, judged.stdout[-400:]
