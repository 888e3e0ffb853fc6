"""Views of two cameras in one calibration are detected, and those of one camera are not."""

from dataclasses import replace

import numpy as np
import pytest

from tests.benchmarks.calibration.cameras import BOARD, KnownCamera, known_camera, seen_view
from tracker.camera.calibration import CalibrationReport, calibrate
from tracker.camera.detection import BoardView


def views_of(camera: KnownCamera, count: int, rng: np.random.Generator) -> list[BoardView]:
    return [seen_view(camera.model, BOARD, rng, noise_px=0.2) for _ in range(count)]


def reported(report: CalibrationReport) -> list[str]:
    return [one.message for one in report.warnings if one.code == "TWO_CAMERAS"]


@pytest.mark.parametrize("seed", [1, 5])
def test_a_second_camera_of_one_make_is_reported_with_its_images(seed: int) -> None:
    rng = np.random.default_rng(seed)
    one = known_camera(rng)
    matrix = one.model.matrix.copy()
    matrix[[0, 1], [0, 1]] *= 1.02
    matrix[0, 2] += 10.0
    other = KnownCamera(model=replace(one.model, matrix=matrix))
    size = one.model.size_wh_px
    names = [*(f"a{n}" for n in range(9)), *(f"b{n}" for n in range(4))]
    report = calibrate([*views_of(one, 9, rng), *views_of(other, 4, rng)], size_wh_px=size, names=names)
    (message,) = reported(report)
    assert "4 of 13 views (b0, b1, b2, b3) fit a separate camera clearly better" in message
    # The same camera alone, with as many views.
    assert reported(calibrate(views_of(one, 13, rng), size_wh_px=size)) == []
