"""`coaxial calibrate` as a person types it."""

import json
import re
import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from server.camera_file import load_camera_file, read_camera_file, reject_other_camera
from server.cli import app
from tests.tracker.camera.rendered import POSES, picture
from tracker.camera import CheckerBoard
from tracker.errors import CalibrationError, NavigationError

BOARD = ("--pattern", "checkerboard", "--size", "9x6", "--square-mm", "12")


def typed(*words: str | Path, command: str = "calibrate") -> tuple[int, str]:
    result = CliRunner().invoke(app, [command, *map(str, words)])
    if isinstance(result.exception, NavigationError):
        # `server.cli.main` tells it, with status 2.
        return 2, result.exception.code
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result.exit_code, result.stdout


@pytest.fixture(scope="module")
def images(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("images")
    board = CheckerBoard(columns=9, rows=6, square_mm=12.0)
    for index, pose in enumerate(POSES[:6]):
        cv2.imwrite(str(folder / f"view{index}.png"), picture(board, pose, seed=index))
    cv2.imwrite(str(folder / "view9.png"), np.full((480, 640), 90, np.uint8))
    return folder


def test_a_camera_file_plots_and_json_are_written(images: Path, tmp_path: Path) -> None:
    output = tmp_path / "camera.yaml"
    status, text = typed(
        *BOARD, "--output", output, "--plots", tmp_path, "--camera-name", "main", "--json", images
    )
    assert status == 0, text
    reported = json.loads(text)
    assert reported["size_wh_px"] == [640, 480]
    assert [view["used"] for view in reported["views"]] == [True] * 6 + [False]
    assert [view["image"] for view in reported["views"]] == [f"view{n}.png" for n in (0, 1, 2, 3, 4, 5, 9)]
    assert reported["views"][-1]["rms_px"] is None
    assert "corners" in reported["views"][-1]["reason"]
    assert reported["rms_px"] < 0.4
    camera = load_camera_file(output)
    np.testing.assert_allclose(camera.matrix, reported["matrix"])
    np.testing.assert_allclose(camera.distortion, reported["distortion"])
    facts = yaml.safe_load(output.read_text())
    assert facts["camera"] == {"name": "main"}
    assert facts["boards"][0]["size"] == [9, 6]
    # A plot is stored and read in all languages: its only text is the length of the scale.
    for name, text in (("residuals.svg", r"\d+(/\d+)? px"), ("coverage.svg", "")):
        svg = (tmp_path / name).read_text()
        assert svg.startswith("<svg")
        assert re.fullmatch(text, "".join(re.findall("<text[^>]*>([^<]*)<", svg)))


def test_the_report_is_readable_and_the_gate_fails_with_status_1(images: Path, tmp_path: Path) -> None:
    output = tmp_path / "camera.yaml"
    status, text = typed(*BOARD, "--output", output, "--max-rms-px", "0.001", str(images / "*.png"))
    assert status == 1
    assert "RMS" in text
    assert "view9.png" in text
    assert not output.exists()


def test_without_an_output_it_states_that_no_camera_file_was_written(images: Path) -> None:
    status, text = typed(*BOARD, images)
    assert status == 0, text
    assert "No camera file was written. To write one, give --output" in text


def test_a_file_of_another_camera_is_rejected(images: Path, tmp_path: Path) -> None:
    output = tmp_path / "camera.yaml"
    assert typed(*BOARD, "--output", output, "--camera-name", "side", images)[0] == 0
    file = read_camera_file(output)
    reject_other_camera(file, path=output, name="side", source=0)
    with pytest.raises(CalibrationError) as reported:
        reject_other_camera(file, path=output, name="main", source=0)
    assert reported.value.code == "CAMERA_DIFFERS"
    (tmp_path / "config.yaml").write_text(f"camera:\n  source: 0\n  calibration: {output}\n")
    result = CliRunner().invoke(app, ["run", "--config", str(tmp_path / "config.yaml")])
    assert isinstance(result.exception, NavigationError)
    assert "'side'" in result.exception.message


def test_bad_input_is_reported_and_nothing_is_written(images: Path, tmp_path: Path) -> None:
    text_file = tmp_path / "notes.png"
    text_file.write_text("no image")
    small = tmp_path / "small.png"
    cv2.imwrite(str(small), np.zeros((100, 100), np.uint8))
    twin = tmp_path / "twin.png"
    twin.write_bytes((images / "view0.png").read_bytes())
    empty = tmp_path / "empty"
    empty.mkdir()
    output = tmp_path / "camera.yaml"
    cases: list[tuple[str, tuple[str | Path, ...]]] = [
        ("IMAGES_MISSING", (*BOARD, empty)),
        ("IMAGES_MISSING", (*BOARD, "nowhere/*.png")),
        ("IMAGE_UNREADABLE", (*BOARD, text_file)),
        ("IMAGE_SIZES_DIFFER", (*BOARD, images / "view0.png", small)),
        ("TOO_FEW_VIEWS", (*BOARD, images / "view0.png", images / "view1.png", twin)),
        ("TOO_FEW_VIEWS", (*BOARD, images / "view0.png", images / "view1.png", text_file)),
        ("BOARD_NOT_FOUND", (*BOARD, images / "view9.png")),
        ("TOO_FEW_VIEWS", (*BOARD, images / "view0.png")),
        ("BOARD_OPTION_INVALID", ("--pattern", "dots", "--size", "14", "--pitch-mm", "4", images)),
        ("BOARD_OPTION_MISSING", ("--pattern", "charuco", "--size", "8x6", "--square-mm", "4", images)),
        ("BOARD_OPTION_UNUSED", ("--pattern", "dots", "--size", "8x6", "--square-mm", "4", images)),
        ("BOARD_OPTION_UNUSED", ("--pattern", "dots", "--size", "8x6", "--tag-mm", "4", images)),
        ("BOARD_OPTION_UNUSED", (*BOARD, "--inset-square-mm", "4", images)),
        ("BOARD_INVALID", ("--pattern", "dots", "--size", "8x6", "--pitch-mm", "-4", images)),
        ("COEFFICIENTS_INVALID", (*BOARD, "--coefficients", "6", images / "view0.png")),
        ("OUTPUT_IS_INPUT", (*BOARD, "--output", images / "view0.png", images)),
    ]
    for code, words in cases:
        assert (
            typed(*words, "--output", output)[1] == code
            if "--output" not in words
            else typed(*words)[1] == code
        )
    assert not output.exists()


def test_a_bad_file_is_reported_and_affects_no_other(images: Path, tmp_path: Path) -> None:
    folder = tmp_path / "images"
    shutil.copytree(images, folder)
    (folder / "a-text.png").write_text("no image")
    (folder / "an-empty.jpg").touch()
    cv2.imwrite(str(folder / "small.png"), np.zeros((100, 100), np.uint8))
    cv2.imwrite(str(folder / "tiny.png"), np.zeros((3, 3), np.uint8))
    shutil.copy(folder / "view0.png", folder / "view0-again.png")
    whole, spoilt = (json.loads(typed(*BOARD, "--json", one)[1]) for one in (images, folder))
    # Sums over threads differ in the last digit.
    np.testing.assert_allclose(spoilt["matrix"], whole["matrix"], rtol=1e-9)
    assert spoilt["passed"]
    reason_of = {view["image"]: view["reason"] for view in spoilt["views"] if not view["used"]}
    assert set(reason_of) == {"a-text.png", "an-empty.jpg", "small.png", "tiny.png", "view0.png", "view9.png"}
    assert reason_of["a-text.png"] == "its 8 bytes are not a readable image"
    assert reason_of["an-empty.jpg"] == "its 0 bytes are not a readable image"
    assert "100x100 px, but most images have 640x480 px" in reason_of["small.png"]
    assert "3x3 px" in reason_of["tiny.png"]
    assert "duplicate of view0-again.png" in reason_of["view0.png"]
    assert "view0-again.png" in typed(*BOARD, folder)[1]


def test_a_rig_is_written_with_its_baseline(images: Path, tmp_path: Path) -> None:
    # The same camera twice: the second replaces the first.
    left, right = tmp_path / "left", tmp_path / "right"
    for folder in (left, right):
        folder.mkdir()
        for index in range(6):
            (folder / f"view{index}.png").write_bytes((images / f"view{index}.png").read_bytes())
    output = tmp_path / "rig.yaml"
    cameras = ("--camera", f"left={left}", "--camera", f"right={right}")
    status, text = typed(*BOARD, *cameras, "--output", output, "--json", command="calibrate-rig")
    assert status == 0, text
    reported = json.loads(text)
    assert [camera["name"] for camera in reported["cameras"]] == ["left", "right"]
    assert reported["cameras"][1]["baseline_mm"] < 0.01
    assert reported["shared_views"] == 6
    assert yaml.safe_load(output.read_text())["cameras"][1]["name"] == "right"
    (right / "view0.png").unlink()
    assert typed(*BOARD, *cameras, command="calibrate-rig") == (2, "RIG_IMAGES_UNEVEN")
    assert typed(*BOARD, "--camera", str(left), command="calibrate-rig") == (2, "RIG_OPTION_INVALID")
