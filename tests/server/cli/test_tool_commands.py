"""`coaxial pivot`, `spin` and `tip-check` as typed, and the tool file on its way into the setup."""

import json
import sys
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from server.cli import app, main
from server.config_file import load_config
from server.errors import ConfigError
from server.setup import build_setup
from tests.real_data import real_data_file
from tests.tracker.pose.tool.pivoted import AXIS, Hand, pivoted, spun
from tests.tracker.scenes import perfectly_seen
from tracker.errors import NavigationError
from tracker.geometry import Array, Rigid
from tracker.navigation import ToolPose, navigate
from tracker.pose import Seen
from tracker.pose.tool import Poses

TIP = (float(120.0 * AXIS[0]), float(120.0 * AXIS[1]), float(120.0 * AXIS[2]))
PIVOT_KEYS = {
    *("tip_in_marker_mm", "pivot_mm", "rms_3d_mm", "covariance_mm2", "used", "rejected", "tilt_range_deg"),
}


def saved(folder: Path, poses: Poses, name: str = "poses.npy") -> Path:
    matrices = np.tile(np.eye(4), (len(poses), 1, 1))
    matrices[:, :3, :3], matrices[:, :3, 3] = poses.rotations, poses.translations_mm
    np.save(folder / name, matrices)
    return folder / name


@pytest.fixture
def pivot_poses(tmp_path: Path) -> Path:
    return saved(tmp_path, pivoted(Hand(tip_mm=TIP, outlier_ratio=0.1)).poses)


@pytest.fixture
def spin_poses(tmp_path: Path) -> Path:
    return saved(tmp_path, spun(), "spin.npy")


def typed(*words: str | Path, folder: Path, status: int = 0) -> str:
    result = CliRunner().invoke(app, [*map(str, words), "--config", str(empty_config(folder))])
    assert result.exit_code == status, result.output
    return result.stdout


def empty_config(folder: Path) -> Path:
    (folder / "none.yaml").write_text("")
    return folder / "none.yaml"


def reported(*words: str | Path, folder: Path, status: int = 0) -> dict[str, Any]:
    answer: dict[str, Any] = json.loads(typed(*words, "--json", folder=folder, status=status))
    return answer


def test_pivot_prints_the_tip_with_all_documented_values(tmp_path: Path, pivot_poses: Path) -> None:
    answer = reported("pivot", pivot_poses, folder=tmp_path)
    assert set(answer) >= PIVOT_KEYS
    np.testing.assert_allclose(answer["tip_in_marker_mm"], TIP, atol=0.4)
    assert np.shape(answer["covariance_mm2"]) == (3, 3)
    assert answer["used"] + answer["rejected"] == answer["poses"] == 60
    assert len(answer["rejected_poses"]) == answer["rejected"] > 0
    assert answer["rejected_poses"][0]["reason"] == "OFF_THE_PIVOT"
    assert answer["tilt_range_deg"] == pytest.approx(60.0, abs=8.0)
    assert answer["gate"]["passed"] is True
    words = typed("pivot", pivot_poses, folder=tmp_path)
    assert "3-D RMS" in words
    assert words.splitlines()[-1] == "Passed."


def test_a_pivot_over_the_gate_is_reported_in_full_with_status_1_and_writes_no_file(tmp_path: Path) -> None:
    poses = saved(tmp_path, pivoted(Hand(shift_sd_mm=0.8)).poses)
    words = ("pivot", poses, "--marker", "drill", "--side-mm", "25", "--output", tmp_path / "tool.yaml")
    answer = reported(*words, folder=tmp_path, status=1)
    assert answer["gate"]["passed"] is False
    assert answer["gate"]["failures"][0]["code"] == "PIVOT_RESIDUAL_TOO_LARGE"
    assert answer["written"] is None
    assert not (tmp_path / "tool.yaml").exists()
    assert typed("pivot", poses, folder=tmp_path, status=1).splitlines()[-1] == "FAILED."


def test_the_gate_is_the_one_of_the_settings(tmp_path: Path, pivot_poses: Path) -> None:
    (tmp_path / "strict.yaml").write_text("tool_calibration: {max_rms_3d_mm: 0.01}")
    result = CliRunner().invoke(app, ["pivot", str(pivot_poses), "--config", str(tmp_path / "strict.yaml")])
    assert result.exit_code == 1
    assert "allowed 0.01 mm" in result.output


def test_a_mistake_is_one_sentence_with_its_remedy_and_status_2(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    poses = saved(tmp_path, pivoted(Hand(tilts_deg=(30.0, 0.0), spin_deg=0.0)).poses)
    monkeypatch.setattr(sys, "argv", ["coaxial", "pivot", str(poses), "--json"])
    with pytest.raises(SystemExit) as left:
        main()
    reported = capsys.readouterr()
    assert left.value.code == 2
    assert reported.out == ""
    assert reported.err.startswith("Error: about one direction the tool was tilted by only")
    assert len(reported.err.splitlines()) == 2


def tool_file(folder: Path, pivot_poses: Path, *, spin_poses: Path | None = None) -> Path:
    file = folder / "awl-tool.yaml"
    typed("pivot", pivot_poses, "--marker", "awl", "--side-mm", "20", "--output", file, folder=folder)
    if spin_poses is not None:
        typed("spin", spin_poses, "--tool", file, "--output", file, folder=folder)
    return file


def settings(folder: Path, file: Path, **changes: object) -> Path:
    picture = np.zeros((40, 40), np.uint8)
    picture[10:20, 10:] = 255
    for name, turned in (("drill", picture), ("awl", np.ascontiguousarray(picture.T[::-1] // 2 * 1))):
        cv2.imwrite(str(folder / f"{name}.png"), turned)
    camera = {
        "matrix": [[900, 0, 320], [0, 900, 240], [0, 0, 1]],
        "distortion": [0] * 5,
        "size_wh_px": [640, 480],
    }
    (folder / "camera.json").write_text(json.dumps(camera))
    drawn = {"marker": "drill", "tip_in_marker_mm": [0, -99, 0], "axis_in_marker": [0, -1, 0]}
    calibrated = {"marker": "awl", "calibration": file.name, "radius_mm": 1.5, "length_mm": 90, **changes}
    values = {
        "camera": {"source": "film.avi", "calibration": "camera.json"},
        "markers": {
            "drill": {"image": "drill.png", "side_mm": 25.0},
            "awl": {"image": "awl.png", "side_mm": changes.pop("side_mm", 20.0)},
        },
        "tools": {"drill": {**drawn, "radius_mm": 2, "length_mm": 120}, "awl": calibrated},
    }
    calibrated.pop("side_mm", None)
    (folder / "config.yaml").write_text(yaml.safe_dump(values))
    return folder / "config.yaml"


def seen_at(translation_mm: Array) -> Seen:
    return perfectly_seen(
        Rigid(rotation=np.diag([1.0, -1.0, -1.0]), translation_mm=translation_mm), found_by="search"
    )


def test_two_tools_one_drawn_and_one_calibrated_stand_in_one_snapshot(
    tmp_path: Path, pivot_poses: Path, spin_poses: Path
) -> None:
    file = tool_file(tmp_path, pivot_poses, spin_poses=spin_poses)
    setup = build_setup(load_config(settings(tmp_path, file), environment={})).setup
    assert setup is not None
    places = {"drill": np.array([0.0, 0.0, 500.0]), "awl": np.array([50.0, 0.0, 400.0])}
    snapshot = navigate(
        setup=setup,
        sightings={name: seen_at(place) for name, place in places.items()},
        image_number=1,
        captured_at_s=0.0,
        size_wh_px=(640, 480),
        stage_ms={},
        skipped_images=0,
    )
    tips = {"drill": [0.0, -99.0, 0.0], "awl": TIP}
    for name, tip in tips.items():
        in_view = snapshot.tools[name]
        assert isinstance(in_view, ToolPose)
        expected = places[name] + np.diag([1.0, -1.0, -1.0]) @ np.array(tip)
        np.testing.assert_allclose(in_view.camera_from_tool.translation_mm, expected, atol=0.4)
    awl = snapshot.tools["awl"]
    assert isinstance(awl, ToolPose)
    np.testing.assert_allclose(awl.camera_from_tool.rotation[:, 2], [1.0, -1.0, -1.0] * AXIS, atol=0.02)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        pytest.param({"side_mm": 21.0}, ["marker 'awl' of 20 mm", "of 21 mm"], id="another-side"),
        pytest.param({"marker": "drill"}, ["marker 'awl'", "the tool has 'drill'"], id="another-marker"),
        pytest.param({"tip_in_marker_mm": [0, 1, 2]}, ["tip_in_marker_mm", "one of them"], id="two-tips"),
        pytest.param({"axis_in_marker": [0, 1, 2]}, ["in the settings and in"], id="two-axes"),
        pytest.param({"calibration": "gone.yaml"}, ["gone.yaml cannot be read"], id="no-file"),
        pytest.param(
            {"calibration": "camera.json"}, ["camera.json cannot be used"], id="another-kind-of-file"
        ),
        pytest.param({"calibration": None}, ["tip_in_marker_mm' is missing"], id="nothing-at-all"),
    ],
)
def test_a_tool_file_that_does_not_fit_stops_the_start(
    tmp_path: Path, pivot_poses: Path, spin_poses: Path, changes: dict[str, object], words: list[str]
) -> None:
    file = tool_file(tmp_path, pivot_poses, spin_poses=spin_poses)
    with pytest.raises(ConfigError) as caught:
        load_config(settings(tmp_path, file, **changes), environment={})
    for word in words:
        assert word in caught.value.message


def test_a_tip_without_axis_asks_for_one_and_takes_it_from_the_drawing(
    tmp_path: Path, pivot_poses: Path
) -> None:
    file = tool_file(tmp_path, pivot_poses)
    with pytest.raises(ConfigError, match="coaxial spin"):
        load_config(settings(tmp_path, file), environment={})
    config = load_config(settings(tmp_path, file, axis_in_marker=[0, -2, 0]), environment={})
    axis = build_setup(config).tools["awl"].marker_from_tool.rotation[:, 2]
    np.testing.assert_allclose(axis, [0, -1, 0], atol=1e-12)


def test_spin_prints_the_axis_towards_the_tip(tmp_path: Path, spin_poses: Path) -> None:
    answer = reported("spin", spin_poses, "--tip-mm", "12,-120,6", folder=tmp_path)
    np.testing.assert_allclose(answer["axis_in_marker"], AXIS, atol=0.02)
    assert answer["points_to_tip"] is True
    assert reported("spin", spin_poses, folder=tmp_path)["points_to_tip"] is False


def test_the_tip_check_passes_the_tip_that_was_found_and_fails_another(
    tmp_path: Path, pivot_poses: Path
) -> None:
    clean = saved(tmp_path, pivoted(Hand(tip_mm=TIP), seed=5).poses, "check.npy")
    file = tool_file(tmp_path, pivot_poses)
    answer = reported("tip-check", clean, "--tool", file, folder=tmp_path)
    assert answer["rms_3d_mm"] < 0.6
    assert answer["max_mm"] > answer["rms_3d_mm"]
    other = reported("tip-check", clean, "--tip-mm", "5 -110 0", folder=tmp_path, status=1)
    assert other["gate"]["failures"][0]["code"] == "TIP_CHECK_FAILED"


@pytest.mark.parametrize(
    ("words", "code"),
    [
        pytest.param(["tip-check"], "TOOL_TIP_MISSING", id="no-tip"),
        pytest.param(["tip-check", "--tip-mm", "1,2"], "TOOL_TIP_INVALID", id="two-numbers"),
        pytest.param(["tip-check", "--tip-mm", "1,2,inf"], "TOOL_TIP_INVALID", id="infinite"),
        pytest.param(["pivot", "--output", "t.yaml"], "TOOL_MARKER_UNKNOWN", id="file-without-marker"),
        pytest.param(
            ["pivot", "--output", "t.yaml", "--marker", "a b", "--side-mm", "4"],
            "TOOL_MARKER_UNKNOWN",
            id="name-with-a-space",
        ),
        pytest.param(["spin", "--output", "t.yaml"], "TOOL_FILE_NEEDED", id="axis-without-tip"),
    ],
)
def test_an_invalid_option_is_reported(
    tmp_path: Path, pivot_poses: Path, words: list[str], code: str
) -> None:
    command, *rest = words
    config = str(empty_config(tmp_path))
    result = CliRunner().invoke(app, [command, str(pivot_poses), *rest, "--config", config])
    assert getattr(result.exception, "code", "") == code


def tracked(folder: Path, poses: Poses, *, side_mm: float) -> Path:
    """Lines of `coaxial track` with these poses."""
    lines = (
        {
            "name": "drill",
            "side_mm": side_mm,
            "seen": True,
            "camera_from_marker": {"rotation": rotation.tolist(), "translation_mm": translation.tolist()},
        }
        for rotation, translation in zip(poses.rotations, poses.translations_mm, strict=True)
    )
    (folder / "tracked.jsonl").write_text("\n".join(map(json.dumps, lines)))
    return folder / "tracked.jsonl"


def test_poses_that_were_tracked_with_another_side_make_no_tool(tmp_path: Path) -> None:
    lines = tracked(tmp_path, pivoted(Hand(tip_mm=TIP)).poses, side_mm=25.0)
    file = tmp_path / "t.yaml"

    def rejected(*words: str | Path) -> str:
        result = CliRunner().invoke(
            app, [*map(str, words), "--config", str(empty_config(tmp_path)), "--output", str(file)]
        )
        assert not file.exists()
        assert isinstance(result.exception, NavigationError)
        return f"{result.exception.code}: {result.exception.message}"

    said = rejected("pivot", lines, "--side-mm", "99")
    assert said.startswith("TOOL_SIDE_DIFFERS")
    assert "25 mm" in said
    assert "99 mm" in said
    # Without an option it is the side that they were tracked with.
    typed("pivot", lines, "--output", file, folder=tmp_path)
    assert yaml.safe_load(file.read_text())["side_mm"] == 25.0
    spin = tracked(tmp_path, spun(), side_mm=25.4)
    answer = CliRunner().invoke(app, ["spin", str(spin), "--tool", str(file)])
    assert isinstance(answer.exception, NavigationError)
    assert answer.exception.code == "TOOL_SIDE_DIFFERS"


def test_real_poses_are_read_and_fail_the_gate_for_what_they_are(tmp_path: Path) -> None:
    answer = reported("pivot", real_data_file("tracking", "pivot"), folder=tmp_path, status=1)
    assert answer["poses"] == 57
    assert answer["used"] >= 50
    assert answer["rms_3d_mm"] < 2.5
    assert "LICENSE" in answer["ignored_files"]
