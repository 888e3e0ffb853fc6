"""`coaxial track` over a folder whose images are not all alike, and into a file that is there."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner

from server.capture.folder import DEFAULT_RATE_HZ
from server.cli import app
from tracker.errors import NavigationError
from tracker.pose.sighting import UnseenReason

CAMERA = """\
matrix: [[80.0, 0.0, 31.5], [0.0, 80.0, 23.5], [0.0, 0.0, 1.0]]
distortion: [0.0, 0.0, 0.0, 0.0]
size_wh_px: [64, 48]
"""


@pytest.fixture
def marker(tmp_path: Path) -> Path:
    picture = np.zeros((40, 40), np.uint8)
    picture[10:20, 10:] = 255
    cv2.imwrite(str(tmp_path / "m.png"), picture)
    return tmp_path / "m.png"


@pytest.fixture(autouse=True)
def quiet(monkeypatch: pytest.MonkeyPatch) -> None:
    """Disables the command's log: its stream ends with the command, but other tests continue."""
    monkeypatch.setattr("server.cli.track.configure_logging", lambda _settings: None)


def folder_of(path: Path, **sizes_wh_px: tuple[int, int]) -> Path:
    """Grey images by name, in a new folder."""
    path.mkdir()
    for name, (width, height) in sizes_wh_px.items():
        cv2.imwrite(str(path / f"{name}.png"), np.full((height, width), 90, np.uint8))
    return path


def tracked(folder: Path, marker: Path, *words: str | Path) -> tuple[int, str]:
    """Exit status and standard error."""
    typed = ("track", folder, "--marker", marker, "--side-mm", 40, *words)
    result = CliRunner().invoke(app, [str(word) for word in typed])
    if isinstance(result.exception, NavigationError):
        # `server.cli.main` tells it, with status 2.
        return 2, f"{result.exception.message}\n{result.exception.remedy}"
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result.exit_code, result.stderr


def test_an_image_of_another_size_is_reported_with_number_and_file(tmp_path: Path, marker: Path) -> None:
    (tmp_path / "camera.yaml").write_text(CAMERA, encoding="utf-8")
    images = folder_of(tmp_path / "images", a1=(64, 48), a2=(60, 48), a3=(64, 48))
    status, text = tracked(images, marker, "--camera", tmp_path / "camera.yaml")
    assert status == 2
    message, remedy = text.split("\n")
    assert message == "image 1 (a2.png) is 60x48 px, but the camera was calibrated at 64x48 px"
    assert remedy.startswith("Omit the image ")


def test_every_image_that_cannot_be_read_is_reported_and_what_can_be_is_whole(
    tmp_path: Path, marker: Path
) -> None:
    images = folder_of(tmp_path / "images", **dict.fromkeys(("1", "2", "3", "4"), (64, 48)))
    (images / "1.png").write_bytes((images / "1.png").read_bytes()[:60])
    (images / "3.png").write_bytes(b"")
    status, text = tracked(images, marker, "--json", tmp_path / "o.jsonl")
    assert status == 2
    assert "2 images cannot be used: " in text
    assert f"{images / '1.png'} (its 60 bytes are" in text
    assert f"{images / '3.png'} (its 0 bytes are" in text
    lines = (tmp_path / "o.jsonl").read_text(encoding="utf-8").splitlines()
    assert [json.loads(line)["image_number"] for line in lines] == [1, 3]
    assert not (tmp_path / "o.jsonl.part").exists()


def test_tracking_again_writes_over_the_lines_only_where_that_is_said(tmp_path: Path, marker: Path) -> None:
    images = folder_of(tmp_path / "images", a=(64, 48))
    lines = tmp_path / "pivot.jsonl"
    lines.write_text("yesterday\n", encoding="utf-8")
    status, text = tracked(images, marker, "--json", lines)
    assert status == 2
    assert "--replace" in text
    assert lines.read_text(encoding="utf-8") == "yesterday\n"
    assert tracked(images, marker, "--json", lines, "--replace")[0] == 0
    assert json.loads(lines.read_text(encoding="utf-8"))["image_number"] == 0


def test_help_describes_the_content_of_a_line() -> None:
    text = " ".join(CliRunner().invoke(app, ["track", "--help"], env={"COLUMNS": "80"}).output.split())
    for reason in UnseenReason:
        assert f"{reason.value}: " in text
    assert f"(default {DEFAULT_RATE_HZ:g} Hz)" in text
    assert "pose_covariance: 6x6 in mm and rad, translation first, then rotation as a small" in text
    assert "left-multiplied rotation vector in the camera's frame" in text
