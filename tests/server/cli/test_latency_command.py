"""`coaxial latency` as a person types it."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from server.cli import app
from server.latency import LatencyResult, Screen
from server.store import Home
from server.store.latency_file import MAX_CAMERAS, LatencyFile
from tests.server.latency.made_run import Run

LINES = """\
camera 0, 1280x720 px, 30.3 images/s, measured 2026-11-24T11:05:00Z by ito
  exposure to display 89 ms median, 104.7 ms p99, 159 codes
  screen and camera     57.0 ms median
  tracking              12.0 ms median
  server                 6.0 ms median
  line                   4.0 ms median
  page                  10.0 ms median
  Resolution: one image every 33 ms. A code is read 16.5 ms late on average; the numbers include this \
and the delay of the screen (1280x800 px, one frame every 16.7 ms).
  The clocks of page and server agree within 1.5 ms; 0 of 609 images were skipped.
"""


def result(camera: str = "camera 0", at: str = "2026-11-24T11:05:00Z") -> LatencyResult:
    return LatencyResult(
        at=at,
        made_by="ito",
        camera=camera,
        width_px=1280,
        height_px=720,
        rate_hz=30.3,
        screen=Screen(width_px=1280, height_px=800, period_ms=16.7),
        report=Run().report(),
    )


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> LatencyFile:
    monkeypatch.setenv("COAXIAL_HOME", str(tmp_path / "home"))
    with Home(tmp_path / "home") as home:
        return LatencyFile(home.folder)


def typed(*words: str) -> tuple[int, str]:
    reported = CliRunner().invoke(app, ["latency", *words])
    assert reported.exception is None or isinstance(reported.exception, SystemExit), reported.exception
    return reported.exit_code, reported.stdout


def test_what_was_measured_is_printed_with_its_resolution(file: LatencyFile) -> None:
    file.put(result())
    assert typed("show") == (0, LINES)


def test_a_machine_reads_the_same_as_json(file: LatencyFile) -> None:
    file.put(result("camera 1", at="2026-11-23T10:00:00Z"))
    file.put(result("camera 0"))
    status, text = typed("show", "--json")
    assert status == 0
    reported = json.loads(text)
    assert [one["camera"] for one in reported] == ["camera 0", "camera 1"]
    assert reported[0]["report"]["median_ms"] == result().report.median_ms


def test_each_camera_has_its_newest_result_and_few_are_remembered(file: LatencyFile) -> None:
    for number in range(MAX_CAMERAS + 5):
        file.put(result(f"camera {number}"))
    newer = result("camera 20", at="2026-11-25T09:00:00Z")
    file.put(newer)
    assert file.of("camera 20") == newer
    assert file.of("camera 3") is None
    assert len(file.results()) == MAX_CAMERAS


def test_without_a_result_it_states_how_to_measure_with_a_page(file: LatencyFile) -> None:
    assert file.results() == ()
    status, text = typed("show")
    assert status == 1
    assert text.startswith("No latency has been measured yet.")
    assert '"Measure" on the card "Latency"' in text
    assert typed("show", "--json") == (1, "[]\n")
    assert typed("measure") == (0, text.split("\n\n", 1)[1])
