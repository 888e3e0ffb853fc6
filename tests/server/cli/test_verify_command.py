"""`coaxial verify`: tables, JSON and plots of rows, and the exit status."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from server.cli import verify as verify_module
from server.cli.commands import app
from tracker.registration import AnchoredTo
from tracker.rehearsal import Phase
from tracker.verification import ImageRow, RegistrationMethod, RegistrationRow, TheatreRows, Variant
from tracker.verification.tool_errors import ErrorSample, ToolErrors

RUNNER = CliRunner()
QUIET = Variant(method=RegistrationMethod.POINTS, anchored_to=AnchoredTo.CAMERA, camera_moves=False)
MOVED = Variant(method=RegistrationMethod.POINTS, anchored_to=AnchoredTo.CAMERA, camera_moves=True)


def _error_sample(random: np.random.Generator, dof: int, width: float) -> ErrorSample:
    off = width * random.normal(size=dof)
    return ErrorSample(
        error=float(np.linalg.norm(off)), stated_sd=1.0, mahalanobis_squared=float(off @ off), dof=dof
    )


def _image(seed: int, variant: Variant, since_s: float, absent: str, width: float) -> ImageRow:
    random = np.random.default_rng([seed, 7])
    tool_errors = ToolErrors(
        entry=_error_sample(random, 2, width),
        angle=_error_sample(random, 2, width),
        depth=_error_sample(random, 1, width),
        tip=_error_sample(random, 3, width),
    )
    return ImageRow(
        seed=seed,
        variant=variant,
        at_s=12.0,
        phase=Phase.DRILL,
        counts=True,
        since_move_s=since_s,
        absent=absent,
        tool_errors=None if absent else tool_errors,
        is_through=False,
        through_ratio=0.1,
    )


def _made(*, width: float = 1.0, stops: bool = True) -> object:
    def verified(seed: int) -> TheatreRows:
        late = _image(seed, MOVED, 5.0, "CAMERA_MOVED" if stops else "", 1.0 if stops else 50.0)
        return TheatreRows(
            seed=seed,
            registrations=(
                RegistrationRow(
                    seed=seed,
                    method=RegistrationMethod.POINTS,
                    anchored_to=AnchoredTo.CAMERA,
                    rejected="",
                    check_mm=0.4,
                    check_passed=True,
                ),
            ),
            images=(_image(seed, QUIET, -np.inf, "", width), late),
        )

    return verified


def _run(monkeypatch: pytest.MonkeyPatch, made: object, *words: str) -> tuple[int, str]:
    monkeypatch.setattr(verify_module, "verify_theatre", made)
    result = RUNNER.invoke(app, ["verify", "--theatres", "400", "--jobs", "1", *words])
    return result.exit_code, result.stdout


def test_what_holds_passes_with_its_numbers_as_json(monkeypatch: pytest.MonkeyPatch) -> None:
    status, reported = _run(monkeypatch, _made(), "--json", "--rows")
    value = json.loads(reported)
    quiet = next(one for one in value["variants"] if not one["camera_moves"])
    tip = quiet["errors"]["tip"]
    assert (status, value["passed"], value["theatres"]) == (0, True, 400)
    assert tip["of"] == 400
    assert tip["covered_ratio"] == pytest.approx(0.95, abs=0.03)
    assert tip["covered_95_ratio"][0] < tip["covered_ratio"] < tip["covered_95_ratio"][1]
    assert len(value["rows"]) == 800


@pytest.mark.parametrize("width", [pytest.param(1.4, id="too-sure"), pytest.param(0.5, id="too-unsure")])
def test_a_coverage_that_is_surely_wrong_fails(monkeypatch: pytest.MonkeyPatch, width: float) -> None:
    status, reported = _run(monkeypatch, _made(width=width))
    assert status == 1
    assert "allowed 92% to 98%" in reported


def test_wrong_numbers_after_the_camera_moved_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    status, reported = _run(monkeypatch, _made(stops=False), "--json")
    value = json.loads(reported)
    assert status == 1
    assert sum(one["shown_wrong"] for one in value["variants"]) == 400


def test_plots_are_written(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    status, _ = _run(monkeypatch, _made(), "--plots", str(tmp_path / "plots"))
    assert status == 0
    for name in ("errors", "coverage"):
        assert (tmp_path / "plots" / f"{name}.svg").read_text(encoding="utf-8").count("<polyline") == 4


def test_a_folder_that_cannot_be_made_is_reported_before_the_work(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x", encoding="utf-8")
    result = RUNNER.invoke(app, ["verify", "--plots", str(tmp_path / "file" / "plots")])
    assert result.exit_code != 0
    assert getattr(result.exception, "code", "") == "OUTPUT_NOT_WRITABLE"
