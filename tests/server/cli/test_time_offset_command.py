"""`coaxial time-offset` as typed: two recordings of one motion to the offset between their clocks."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from server.cli import app
from tests.tracker.pose.shared_motion import HandMotion, Source, at_rest
from tracker.errors import InvalidInput
from tracker.pose.temporal_calibration import PoseSeries

CAMERA = Source(seed=1, late_s=0.125)
TRACKER = Source(seed=2, rate_hz=60.0)
HAND = HandMotion(seed=3)


def tracked(path: Path, series: PoseSeries, name: str = "drill") -> Path:
    """Lines of `coaxial track`, with an image at the end without the marker."""
    assert series.rotations is not None
    rows = zip(
        series.times_s.tolist(), series.rotations.tolist(), series.translations_mm.tolist(), strict=True
    )
    lines: list[dict[str, Any]] = [
        {
            "time_s": time_s,
            "name": name,
            "side_mm": 25.0,
            "seen": True,
            "camera_from_marker": {"rotation": rotation, "translation_mm": translation},
        }
        for time_s, rotation, translation in rows
    ]
    lines.append({"time_s": 99.0, "name": name, "seen": False, "camera_from_marker": None})
    path.write_text("\n".join(map(json.dumps, lines)))
    return path


def in_metres(path: Path, series: PoseSeries) -> Path:
    """A second tracker's CSV."""
    assert series.rotations is not None
    rows = [
        series.times_s,
        *(series.translations_mm.T / 1000.0),
        *Rotation.from_matrix(series.rotations).as_quat().T,
    ]
    header = "time_s,x,y,z,qx,qy,qz,qw"
    np.savetxt(path, np.column_stack(rows), delimiter=",", header=header, comments="", fmt="%.9f")
    return path


@pytest.fixture
def camera(tmp_path: Path) -> Path:
    return tracked(tmp_path / "camera.jsonl", CAMERA.record(HAND))


@pytest.fixture
def second(tmp_path: Path) -> Path:
    return in_metres(tmp_path / "second.csv", TRACKER.record(HAND))


def typed(*words: str | Path, status: int = 0) -> str:
    result = CliRunner().invoke(app, ["time-offset", *map(str, words)])
    assert result.exit_code == status, result.output
    return result.stdout


def test_the_offset_is_printed_with_its_sign_and_what_was_used(camera: Path, second: Path) -> None:
    answer = json.loads(typed(camera, second, "--json"))
    assert answer["offset_s"] == pytest.approx(0.125, abs=4.0 * answer["sd_s"])
    assert 0.0 < answer["sd_s"] < answer["gate"]["max_sd_s"]
    assert answer["gate"]["passed"] is True
    assert answer["first"]["used"] == answer["first"]["poses"] == 360
    assert answer["first"]["unseen_images"] == 1
    assert answer["second"]["rate_hz"] == pytest.approx(60.0, rel=1e-3)
    words = typed(camera, second)
    assert words.startswith("Offset: +12")
    assert f"time stamps of {camera} are later than those of {second}" in words
    assert "Add +0.12" in words
    assert words.splitlines()[-1] == "Passed."


def test_swapped_files_swap_the_sign_and_who_is_late(camera: Path, second: Path) -> None:
    offset_s = json.loads(typed(camera, second, "--json"))["offset_s"]
    assert json.loads(typed(second, camera, "--json"))["offset_s"] == pytest.approx(-offset_s, abs=1e-6)
    words = typed(second, camera)
    assert words.startswith("Offset: -12")
    assert f"time stamps of {camera} are later than those of {second}" in words
    assert f"to the times of {camera} to convert them to those of {second}" in words


def test_translations_need_the_unit_of_each_file(camera: Path, second: Path) -> None:
    words = (camera, second, "--motion", "translation", "--json")
    answer = json.loads(typed(*words, "--second-unit", "m"))
    assert answer["offset_s"] == pytest.approx(0.125, abs=4.0 * answer["sd_s"])
    assert answer["motion"] == "translation"
    rejected = json.loads(typed(*words, status=1))
    assert rejected["gate"]["failures"][0]["code"] == "TIME_OFFSET_NO_MOTION"


def test_what_does_not_determine_the_offset_is_reported_with_status_1(tmp_path: Path, second: Path) -> None:
    still = tracked(tmp_path / "still.jsonl", CAMERA.record(at_rest))
    answer = json.loads(typed(still, second, "--json", status=1))
    assert answer["offset_s"] is None
    assert answer["gate"]["passed"] is False
    failure = answer["gate"]["failures"][0]
    assert failure["code"] == "TIME_OFFSET_NO_MOTION"
    assert str(still) in failure["message"]
    assert failure["remedy"].endswith(".")
    assert typed(still, second, status=1).splitlines()[-1] == "FAILED."


def test_the_search_goes_as_far_as_asked(tmp_path: Path, second: Path) -> None:
    late = tracked(tmp_path / "late.jsonl", replace(CAMERA, late_s=1.5).record(HAND))
    typed(late, second, status=1)
    answer = json.loads(typed(late, second, "--max-offset-s", "2", "--json"))
    assert answer["offset_s"] == pytest.approx(1.5, abs=4.0 * answer["sd_s"])


def test_a_marker_is_chosen_for_each_file(tmp_path: Path, second: Path) -> None:
    both = tracked(tmp_path / "both.jsonl", CAMERA.record(HAND))
    other = tracked(tmp_path / "other.jsonl", CAMERA.record(HandMotion(seed=9)), "awl")
    both.write_text(both.read_text() + "\n" + other.read_text())
    answer = json.loads(typed(both, second, "--first-marker", "drill", "--json"))
    assert answer["offset_s"] == pytest.approx(0.125, abs=4.0 * answer["sd_s"])
    result = CliRunner().invoke(app, ["time-offset", str(both), str(second)])
    assert getattr(result.exception, "code", "") == "POSES_OF_SEVERAL_MARKERS"


def test_poses_without_times_are_bad_input(tmp_path: Path, second: Path) -> None:
    untimed = tmp_path / "untimed.jsonl"
    lines = (json.loads(line) for line in tracked(untimed, CAMERA.record(HAND)).read_text().splitlines())
    untimed.write_text("\n".join(json.dumps({**line, "time_s": None}) for line in lines))
    result = CliRunner().invoke(app, ["time-offset", str(untimed), str(second)])
    # Reported by `main` in one sentence, with status 2.
    assert isinstance(result.exception, InvalidInput)
    assert result.exception.code == "POSE_TIMES_MISSING"
    assert "untimed.jsonl, line 1" in result.exception.message
