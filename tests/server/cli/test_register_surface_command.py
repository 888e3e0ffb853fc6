"""`coaxial register surface` as a person types it."""

import json
from pathlib import Path

import numpy as np
import pytest

from server.imaging.meshes import ply_from_surface
from tests.server.cli.register_words import typed, written
from tests.tracker.registration.constellations import VERTEBRA
from tests.tracker.registration.sweeps import SweepTruth, corners_from_behind, sweep_over, vertebra


@pytest.fixture
def mesh(tmp_path: Path) -> Path:
    path = tmp_path / "bone.ply"
    path.write_bytes(ply_from_surface(vertebra()))
    return path


@pytest.fixture
def truth() -> SweepTruth:
    return sweep_over(corners_from_behind(), np.random.default_rng(1), sd_mm=0.15, count=50)


def test_a_sweep_from_a_start_and_from_landmarks(tmp_path: Path, mesh: Path, truth: SweepTruth) -> None:
    points = written(tmp_path / "p.csv", truth.moving_mm, "x,y,z")
    start = tmp_path / "start.json"
    start.write_text(json.dumps({"fixed_from_moving": truth.start.matrix.tolist()}))
    words = ("surface", "--surface", mesh, "--points", points, "--target-mm", "15,10,5")
    status, text = typed(*words, "--start", start, "--json")
    document = json.loads(text)
    assert status == 0
    assert np.allclose(document["fixed_from_moving"], truth.fixed_from_moving.matrix, atol=1.5)
    assert document["rms_mm"] < 0.3
    assert document["tre_expected_mm"] < 0.6
    assert document["moved_mm"] == pytest.approx(2.0, abs=0.4)
    fixed = written(tmp_path / "f.csv", VERTEBRA)
    moving = written(tmp_path / "m.csv", truth.fixed_from_moving.inverse.move_points(VERTEBRA))
    status, text = typed(*words, "--fixed", fixed, "--moving", moving)
    assert status == 0
    assert "At the target 15, 10, 5 mm" in text
    mistaken = VERTEBRA + np.eye(6, 3) * [0.0, 6.0, 0.0]
    moving = written(tmp_path / "w.csv", truth.fixed_from_moving.inverse.move_points(mistaken))
    status, text = typed(*words, "--fixed", fixed, "--moving", moving)
    assert (status, text.split(":")[0]) == (2, "POINTS_FIT_TOO_LARGE")


def test_both_commands_state_their_errors_in_one_form_and_by_the_convention_that_they_name(
    tmp_path: Path, mesh: Path, truth: SweepTruth
) -> None:
    tips = truth.fixed_from_moving.inverse.move_points(VERTEBRA)
    tips = tips + 0.3 * np.random.default_rng(2).normal(size=tips.shape)
    files = (
        "--fixed",
        written(tmp_path / "f.csv", VERTEBRA),
        "--moving",
        written(tmp_path / "m.csv", tips),
        "--target-mm",
        "15,10,5",
        "--json",
    )
    sweep = written(tmp_path / "p.csv", truth.moving_mm)
    by_points = json.loads(typed("points", *files)[1])
    status, text = typed("surface", "--surface", mesh, "--points", sweep, *files)
    by_surface = json.loads(text)
    assert status == 0
    shared = {"fixed_from_moving", "covariance", "covariance_of", "targets", "floors", "limits", "gate"}
    shared |= {"tre_expected_mm", "tre_expected_is", "tre_stated_is", "warnings"}
    assert shared <= set(by_points) & set(by_surface)
    assert (by_points["floors"], by_surface["floors"]) == ({"min_fle_mm": 0.5}, {"min_sd_mm": 0.3})
    for document in (by_points, by_surface):
        (target,) = document["targets"]
        matrix, at = np.array(document["fixed_from_moving"]), np.array(target["target_mm"])
        # x = exp([r]x) R m + t + d, with R m = x - t.
        x, y, z = at - matrix[:3, 3]
        jacobian = np.hstack([np.eye(3), [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]])
        at_target = jacobian @ np.array(document["covariance"]) @ jacobian.T
        assert target["tre_stated_mm"] == pytest.approx(np.sqrt(np.trace(at_target)), rel=1e-6)
        assert target["tre_expected_mm"] == document["tre_expected_mm"] < target["tre_stated_mm"]


def test_a_sweep_off_the_bone_ends_with_status_1(tmp_path: Path, mesh: Path, truth: SweepTruth) -> None:
    start, config = tmp_path / "start.json", tmp_path / "config.yaml"
    start.write_text(json.dumps(truth.start.matrix.tolist()))
    config.write_text("registration: {max_surface_rms_mm: 0.02}\n")
    points = written(tmp_path / "p.csv", truth.moving_mm)
    words = ("surface", "--surface", mesh, "--points", points, "--start", start, "--json")
    assert typed(*words)[0] == 0
    status, text = typed(*words, "--config", config)
    assert status == 1
    assert [one["code"] for one in json.loads(text)["gate"]["failures"]] == ["SURFACE_FIT_TOO_LARGE"]


@pytest.mark.parametrize(
    ("content", "code"),
    [
        pytest.param("", "REGISTRATION_START_INVALID", id="empty"),
        pytest.param("[[1, 2], [3, 4]]", "REGISTRATION_START_INVALID", id="small"),
        pytest.param('{"a": 1}', "REGISTRATION_START_INVALID", id="something-else"),
        pytest.param(json.dumps((2.0 * np.eye(4)).tolist()), "REGISTRATION_START_INVALID", id="no-last-row"),
        pytest.param(json.dumps(np.diag([2.0, 2.0, 2.0, 1.0]).tolist()), "ROTATION_INVALID", id="scaled"),
        pytest.param(json.dumps(np.diag([1.0, 1.0, -1.0, 1.0]).tolist()), "ROTATION_INVALID", id="mirrored"),
    ],
)
def test_a_start_that_is_none_is_reported(tmp_path: Path, mesh: Path, content: str, code: str) -> None:
    start = tmp_path / "start.json"
    start.write_text(content)
    points = written(tmp_path / "p.csv", VERTEBRA)
    status, text = typed("surface", "--surface", mesh, "--points", points, "--start", start)
    assert (status, text.split(":")[0]) == (2, code)


def test_without_a_start_it_states_what_to_give(tmp_path: Path, mesh: Path) -> None:
    points = written(tmp_path / "p.csv", VERTEBRA)
    status, text = typed("surface", "--surface", mesh, "--points", points)
    assert (status, text.split(":")[0]) == (2, "REGISTRATION_START_MISSING")


def test_a_sweep_that_determines_too_little_ends_with_status_2(
    tmp_path: Path, mesh: Path, truth: SweepTruth
) -> None:
    start = tmp_path / "start.json"
    start.write_text(json.dumps(truth.start.matrix.tolist()))
    points = written(tmp_path / "p.csv", truth.moving_mm[:6])
    status, text = typed("surface", "--surface", mesh, "--points", points, "--start", start, "--json")
    assert (status, text.split(":")[0]) == (2, "SURFACE_SWEEP_SMALL")
