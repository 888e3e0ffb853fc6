"""`coaxial` as a person types it."""

import json
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt
import pytest
from typer.testing import CliRunner

from server.cli import app, main
from tracker.pipeline import Tracker
from tracker.pose import Sighting

REPOSITORY = Path(__file__).parents[3]


Ended = subprocess.CompletedProcess[str]


def coaxial(*words: str | Path, folder: Path) -> Ended:
    environment = {**os.environ, "PYTHONPATH": str(REPOSITORY), "COAXIAL_HOME": str(folder / "home")}
    environment.pop("COAXIAL_PORT", None)
    return subprocess.run(
        [sys.executable, "-W", "error", "-m", "server", *map(str, words)],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )


@pytest.fixture
def typed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., Ended]:
    """The same in this process, because starting another one takes longer than most of these commands."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COAXIAL_HOME", str(tmp_path / "home"))
    # Its stream ends with the command, but the process and its other tests continue.
    monkeypatch.setattr("server.cli.track.configure_logging", lambda _settings: None)

    def ended(*words: str | Path) -> Ended:
        monkeypatch.setattr(sys, "argv", ["coaxial", *map(str, words)])
        with pytest.raises(SystemExit) as left:
            main()
        reported = capsys.readouterr()
        status = left.value.code
        assert isinstance(status, int)
        return Ended(words, status, reported.out, reported.err)

    return ended


def write_film(path: Path, *, images: int) -> Path:
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), 25.0, (64, 48))
    for number in range(images):
        writer.write(np.full((48, 64, 3), 5 * number, dtype=np.uint8))
    writer.release()
    return path


@pytest.fixture
def film(tmp_path: Path) -> Path:
    return write_film(tmp_path / "v.avi", images=6)


@pytest.fixture
def marker(tmp_path: Path) -> Path:
    picture = np.zeros((40, 40), np.uint8)
    picture[10:20, 10:] = 255
    path = tmp_path / "m one.png"
    cv2.imwrite(str(path), picture)
    return path


def is_one_sentence_with_remedy(text: str) -> bool:
    lines = text.strip().splitlines()
    return len(lines) == 2 and lines[0].startswith("Error: ") and lines[1].endswith(".")


@pytest.mark.parametrize("words", [["--help"], ["run", "--help"], ["track", "--help"], ["--version"]])
def test_help_and_version_answer(words: list[str]) -> None:
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0
    assert "Coaxial" in result.output or "Usage" in result.output


def test_a_wrong_setting_stops_the_start_with_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "config.yaml").write_text("server: {prot: 8000}\n")
    result = coaxial("run", folder=tmp_path)
    assert result.returncode == 2
    assert is_one_sentence_with_remedy(result.stderr)
    for word in ("config.yaml", "'server.prot'", "'server.port'"):
        assert word in result.stderr
    assert result.stdout == ""


@pytest.mark.parametrize("once", ["--no-loop", "--once"])
def test_a_file_can_be_played_once(monkeypatch: pytest.MonkeyPatch, once: str) -> None:
    taken: list[bool | None] = []
    monkeypatch.setattr("server.cli.run.run_dashboard", lambda given, **_: taken.append(given.loop))
    result = CliRunner().invoke(app, ["run", once])
    assert (result.exit_code, taken) == (0, [False]), result.output


def test_a_taken_port_is_reported(tmp_path: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        result = coaxial("run", "--port", str(taken.getsockname()[1]), folder=tmp_path)
    assert result.returncode == 2
    assert is_one_sentence_with_remedy(result.stderr)
    assert "--port" in result.stderr


def test_an_address_that_is_not_of_this_machine_is_reported(tmp_path: Path) -> None:
    # 192.0.2.1 is reserved for documentation: no machine has it.
    (tmp_path / "config.yaml").write_text("server:\n  host: 192.0.2.1\n", encoding="utf-8")
    result = coaxial("run", "--port", "0", folder=tmp_path)
    assert result.returncode == 2
    assert is_one_sentence_with_remedy(result.stderr)
    assert "192.0.2.1" in result.stderr
    assert "server.host" in result.stderr


def test_track_writes_a_line_for_every_image(film: Path, marker: Path, tmp_path: Path) -> None:
    result = coaxial(
        "track", film, "--marker", marker, "--side-mm", "40", "--json", "out.jsonl", folder=tmp_path
    )
    assert result.returncode == 0, result.stderr
    assert result.stdout == ""
    assert result.stderr.startswith("6 images: m-one seen in 0 (missed: ")
    assert " per image, reading " in result.stderr
    assert "no result in mm without a camera file (--camera)" in result.stderr
    lines = [json.loads(line) for line in (tmp_path / "out.jsonl").read_text().splitlines()]
    assert [line["image_number"] for line in lines] == list(range(6))
    assert [line["time_s"] for line in lines] == pytest.approx([n / 25 for n in range(6)])
    assert not (tmp_path / "out.jsonl.part").exists()
    keys = {
        *("image_number", "time_s", "name", "seen", "reason", "camera_from_marker", "pose_covariance"),
        *("corners_px", "score_ratio", "target_score_ratio", "model_coverage_ratio", "target_coverage_ratio"),
        *("fit_error_px2", "found_by", "best_score_ratio", "stage_ms", "side_mm", "calibration_sha256"),
    }
    for line in lines:
        assert set(line) == keys
        assert line["name"] == "m-one"
        assert not line["seen"]
        assert line["reason"]
        assert line["side_mm"] == 40.0
        assert line["stage_ms"]["reading"] >= 0.0


def test_track_can_write_to_standard_output_and_stop_early(
    typed: Callable[..., Ended], film: Path, marker: Path
) -> None:
    words = ("--marker", marker, "--side-mm", "40", "--name", "a", "--json", "-", "--images", "2")
    result = typed("track", film, *words)
    assert result.returncode == 0, result.stderr
    assert [json.loads(line)["name"] for line in result.stdout.splitlines()] == ["a", "a"]


def test_a_stopped_track_tells_how_far_it_came_and_leaves_a_part(
    film: Path, marker: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    step = Tracker.step

    def step_with_ctrl_c(
        tracker: Tracker, image: npt.NDArray[np.uint8], *, captured_at_s: float, **options: bool
    ) -> dict[str, Sighting]:
        signal.raise_signal(signal.SIGINT)
        assert signal.getsignal(signal.SIGINT) == signal.SIG_DFL  # a second one ends it at once
        return step(tracker, image, captured_at_s=captured_at_s, **options)

    monkeypatch.setattr(Tracker, "step", step_with_ctrl_c)
    lines = tmp_path / "o.jsonl"
    result = CliRunner().invoke(
        app, ["track", str(film), "--marker", str(marker), "--side-mm", "4", "--json", str(lines)]
    )
    assert result.exit_code == 130, result.output
    assert "Stopped: 1 image:" in result.stderr
    assert len((tmp_path / "o.jsonl.part").read_text(encoding="utf-8").splitlines()) == 1
    assert not lines.exists()


def test_a_cut_video_is_tracked_as_far_as_it_goes_and_reported(
    typed: Callable[..., Ended], film: Path, marker: Path, tmp_path: Path
) -> None:
    write_film(film, images=40)
    film.write_bytes(film.read_bytes()[: film.stat().st_size * 6 // 10])
    result = typed("track", film, "--marker", marker, "--side-mm", "40", "--json", "o.jsonl")
    assert result.returncode == 2
    assert "of 40 images" in result.stderr
    assert (tmp_path / "o.jsonl").read_text().count("\n") < 40


@pytest.mark.parametrize(
    ("words", "reported"),
    [
        pytest.param(["v.avi"], "no marker", id="no-marker"),
        pytest.param(["v.avi", "--marker", "m one.png"], "--side-mm 0 times", id="no-side"),
        pytest.param(["v.avi", "--marker", "none.png", "--side-mm", "4"], "none.png", id="no-picture"),
        pytest.param(["v.avi", "--marker", "m one.png", "--side-mm", "-4"], "above 0", id="negative-side"),
        pytest.param(["none.avi", "--marker", "m one.png", "--side-mm", "4"], "none.avi", id="no-video"),
        pytest.param(
            ["m one.png", "--marker", "m one.png", "--side-mm", "4", "--camera", "c"],
            "--camera",
            id="no-camera",
        ),
        pytest.param(["0", "--marker", "m one.png", "--side-mm", "4"], "camera 0", id="live-source"),
        pytest.param(
            ["v.avi", "--marker", "m one.png", "--side-mm", "4", "--json", "no/o.jsonl"],
            "no/o.jsonl",
            id="no-folder",
        ),
        pytest.param(
            ["v.avi", "--marker", "m one.png", "--side-mm", "4", "--json", "."], "directory", id="into-folder"
        ),
        pytest.param(
            ["v.avi", "--marker", "m one.png", "--side-mm", "4", "--json", "v.avi"],
            "overwrite",
            id="over-the-video",
        ),
        pytest.param(
            ["v.avi", "--marker", "m one.png", "--side-mm", "4", "--json", "m one.png"],
            "overwrite",
            id="over-the-marker",
        ),
    ],
)
@pytest.mark.usefixtures("film", "marker")
def test_what_cannot_be_tracked_is_reported_in_one_sentence(
    typed: Callable[..., Ended], words: list[str], reported: str
) -> None:
    result = typed("track", *words)
    assert result.returncode == 2
    assert is_one_sentence_with_remedy(result.stderr), result.stderr
    assert reported in result.stderr


@pytest.mark.usefixtures("film", "marker")
def test_a_process_of_its_own_tells_the_same_and_logs_nothing_beside(
    typed: Callable[..., Ended], tmp_path: Path
) -> None:
    words = ("track", "v.avi", "--marker", "m one.png", "--side-mm", "4", "--json", "m one.png")
    result, here = coaxial(*words, folder=tmp_path), typed(*words)
    assert is_one_sentence_with_remedy(result.stderr), result.stderr
    assert (result.returncode, result.stdout, result.stderr) == (here.returncode, here.stdout, here.stderr)
