"""`coaxial certify` as typed: a rehearsed test, its faults, its certificate, and what voids it."""

import json
import shlex
import shutil
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest
import yaml
from typer.testing import CliRunner

from server.capture.address import source_from_text
from server.certificate import PlateFile
from server.cli import app
from server.latency import LatencyReport, LatencyResult, Screen
from server.store.latency_file import LatencyFile
from tracker.errors import NavigationError


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("COAXIAL_HOME", str(tmp_path / "home"))
    return tmp_path / "home"


def typed(*words: str | Path, status: int = 0) -> str:
    result = CliRunner().invoke(app, ["certify", *map(str, words)])
    if isinstance(result.exception, NavigationError):
        raise result.exception
    assert result.exit_code == status, result.output
    return result.output


def rehearsed(folder: Path, *faults: str, rulers: str | None = None) -> list[str]:
    """Write a rehearsal and return the command that it prints."""
    last = typed("rehearse", "--output", folder, *faults).splitlines()[-1]
    words = shlex.split(last)[2:]
    if rulers is not None:
        words[words.index("--rulers-mm") + 1] = rulers
    return words


@pytest.fixture(scope="module")
def certified(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a rehearsal, its certificate, and the home folder whose key signed it."""
    folder = tmp_path_factory.mktemp("certified")
    with pytest.MonkeyPatch.context() as monkeypatch:
        monkeypatch.setenv("COAXIAL_HOME", str(folder / "home"))
        words = rehearsed(folder / "test")
        assert "Certified to" in typed(*words, "--output", folder / "certificate", "--by", "Anna")
    return folder


@pytest.fixture
def certificate(certified: Path, tmp_path: Path) -> Path:
    """The certificate in a copy of that folder."""
    shutil.copytree(certified, tmp_path, dirs_exist_ok=True)
    return tmp_path / "certificate.json"


@pytest.mark.parametrize(
    ("faults", "rulers", "codes"),
    [
        pytest.param(["--print-scale", "-1"], None, ["ACCURACY_PLATE_SCALE"], id="print, by its rulers"),
        pytest.param(
            ["--print-scale", "-1"],
            "100,100",
            ["ACCURACY_MARKER_SCALE", "ACCURACY_STATED_TOO_SMALL"],
            id="scale",
        ),
        pytest.param(
            ["--tip-offset", "1"], None, ["ACCURACY_TIP_OFFSET", "ACCURACY_STATED_TOO_SMALL"], id="tip"
        ),
        pytest.param(
            ["--focal", "2"], None, ["ACCURACY_FOCAL_LENGTH", "ACCURACY_STATED_TOO_SMALL"], id="focal length"
        ),
    ],
)
def test_a_faulty_rehearsal_is_refused_by_name(
    tmp_path: Path, faults: list[str], rulers: str | None, codes: list[str]
) -> None:
    words = rehearsed(tmp_path / "test", *faults, rulers=rulers)
    output = typed(*words, "--json", "--output", tmp_path / "certificate", status=1)
    result = json.loads(output[: output.rindex("}") + 1])
    assert [one["code"] for one in result["problems"]] == codes
    assert result["certificate"] is None
    assert not (tmp_path / "certificate.json").exists()


def test_a_plate_that_nobody_measured_is_not_certified(tmp_path: Path) -> None:
    words = rehearsed(tmp_path / "test")
    at = words.index("--rulers-mm")
    assert "the rulers of the printed plate were not measured" in typed(
        *words[:at], *words[at + 2 :], status=1
    )


def test_the_scale_of_a_machined_plate_is_as_uncertain_wherever_its_origin_is() -> None:
    """Positions 500 mm from the origin made the scale ten times as certain."""
    corners = {"1": (0.0, 0.0), "2": (60.0, 0.0), "3": (0.0, 80.0), "4": (60.0, 80.0)}
    for origin_mm in (0.0, 500.0):
        divots = {name: [x + origin_mm, y + origin_mm, 0.0] for name, (x, y) in corners.items()}
        scale = PlateFile(name="lab", sd_mm=0.05, divots=divots).scale(None, sd_mm=0.2)
        assert scale is not None
        assert scale.sd_ratio == pytest.approx(0.05 / 100.0)


@pytest.mark.parametrize("divots", [{}, {name: [0.0, 0.0, 0.0] for name in "1234"}])
def test_a_machined_plate_without_distances_is_rejected(divots: dict[str, list[float]]) -> None:
    with pytest.raises(NavigationError) as raised:
        PlateFile(name="lab", sd_mm=0.05, divots=divots).scale(None, sd_mm=0.2)
    assert raised.value.code == "PLATE_INVALID"


def test_a_certificate_is_checked_as_json_and_as_pdf(certificate: Path) -> None:
    for file in (certificate, certificate.with_suffix(".pdf")):
        assert "Valid." in typed("check", file)
    content = json.loads(certificate.read_bytes())["certificate"]
    assert content["issued_by"] == "Anna"
    assert {one["name"] for one in content["figures"]} >= {"point_rms_mm", "inside_stated_95_ratio"}
    assert content["audit"] is None


def test_elsewhere_a_certificate_is_valid_only_with_the_key_of_its_issuer(
    certificate: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    signer = typed("signer").strip()
    monkeypatch.setenv("COAXIAL_HOME", str(tmp_path / "elsewhere"))
    assert "unknown key" in typed("check", certificate, status=1)
    assert "Valid." in typed("check", certificate, "--signer", signer)
    assert "another key" in typed("check", certificate, "--signer", "00" * 32, status=1)


def test_a_measured_latency_of_the_camera_is_in_the_certificate(tmp_path: Path, home: Path) -> None:
    words = rehearsed(tmp_path / "test")
    camera = tmp_path / "test" / "camera.yaml"
    camera.write_text(yaml.safe_dump({**yaml.safe_load(camera.read_text()), "camera": {"source": "0"}}))
    report = LatencyReport(
        samples=150,
        median_ms=84.0,
        p99_ms=131.0,
        stage_ms={},
        image_period_ms=33.0,
        late_on_average_ms=16.5,
        clock_error_ms=0.5,
        images=600,
        read_images=590,
        skipped_images=2,
    )
    screen = Screen(width_px=1280, height_px=800, period_ms=16.7)
    result = LatencyResult(
        at="2026-11-24T11:05:00Z",
        made_by="ito",
        camera=source_from_text("0").name,
        width_px=1920,
        height_px=1080,
        rate_hz=30.0,
        screen=screen,
        report=report,
    )
    home.mkdir()
    LatencyFile(home).put(result)
    typed(*words, "--output", tmp_path / "certificate")
    latency = json.loads((tmp_path / "certificate.json").read_bytes())["certificate"]["latency"]
    assert (latency["p99_ms"], latency["uncertainty_ms"]) == (131.0, 17.0)


def test_a_certificate_expires(certificate: Path) -> None:
    for days, status in ((89, 0), (91, 1)):
        later = datetime.now(UTC) + timedelta(days=days)
        with patch("server.cli.certify_check.utc_now", lambda later=later: later):
            typed("check", certificate, status=status)


@pytest.mark.parametrize(
    ("option", "file", "change", "code"),
    [
        pytest.param(
            "--camera", "camera.yaml", {"distortion": [0.01, 0.0, 0.0, 0.0, 0.0]}, "CAMERA", id="lens"
        ),
        pytest.param("--camera", "camera.yaml", {"camera": {"name": "another"}}, "CAMERA", id="camera"),
        pytest.param(
            "--camera",
            "camera.yaml",
            {"camera": {"name": "rehearsal", "controls": {"focus": 3}}},
            "CAMERA",
            id="focus",
        ),
        pytest.param("--tool", "tool.yaml", {"side_mm": 25.1}, "TOOL", id="side"),
    ],
)
def test_a_certificate_is_void_after_a_change(
    certificate: Path, option: str, file: str, change: dict[str, Any], code: str
) -> None:
    path = certificate.parent / "test" / file
    assert "Valid." in typed("check", certificate, option, path)
    values = yaml.safe_load(path.read_text())
    path.write_text(yaml.safe_dump({**values, **change}))
    output = typed("check", certificate, option, path, "--json", status=1)
    result = json.loads(output[: output.rindex("}") + 1])
    assert [one["code"] for one in result["problems"]] == [f"CERTIFICATE_{code}_CHANGED"]


def test_a_certificate_is_void_with_another_version(certificate: Path) -> None:
    camera = certificate.parent / "test" / "camera.yaml"
    with patch("server.installation.product_version", lambda: "9.9"):
        assert "in use is 9.9" in typed("check", certificate, "--camera", camera, status=1)


def test_an_altered_certificate_is_an_error(certificate: Path) -> None:
    certificate.write_bytes(certificate.read_bytes().replace(b'"error_95_mm":0.', b'"error_95_mm":0.0', 1))
    with pytest.raises(NavigationError) as raised:
        typed("check", certificate)
    assert raised.value.code == "CERTIFICATE_ALTERED"


def test_poses_that_were_tracked_with_another_calibration_are_rejected(tmp_path: Path) -> None:
    """Otherwise a certificate would be of a camera file that nobody tested."""
    words = rehearsed(tmp_path / "test")
    camera = tmp_path / "test" / "camera.yaml"
    values = yaml.safe_load(camera.read_text())
    camera.write_text(yaml.safe_dump({**values, "distortion": [0.001, 0.0, 0.0, 0.0, 0.0]}))
    with pytest.raises(NavigationError) as raised:
        typed(*words)
    assert raised.value.code == "POSES_OF_ANOTHER_CAMERA"


def test_a_plate_is_printed_with_its_definition(tmp_path: Path) -> None:
    typed("plate", "--output", tmp_path / "plate.pdf", "--size", "3x4", "--pitch-mm", "50")
    assert (tmp_path / "plate.pdf").read_bytes().startswith(b"%PDF-1.4")
    plate = yaml.safe_load((tmp_path / "plate.yaml").read_text())
    assert plate["divots"]["12"] == [100.0, 150.0, 0.0]
    with pytest.raises(NavigationError) as raised:
        typed("plate", "--output", tmp_path / "plate.pdf", "--size", "9x9", "--pitch-mm", "60")
    assert raised.value.code == "PLATE_TOO_LARGE"


def test_a_capture_of_an_unknown_divot_names_those_of_the_plate(tmp_path: Path) -> None:
    words = rehearsed(tmp_path / "test")
    file = tmp_path / "test" / "captures.yaml"
    values = yaml.safe_load(file.read_text())
    values["captures"][0]["divot"] = "A9"
    file.write_text(yaml.safe_dump(values))
    with pytest.raises(NavigationError, match="no divot 'A9'"):
        typed(*words)
