"""Real images of boards: at least as good as their published results, with as many views or more."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from tests.real_data import real_data_file
from tracker.camera import Board, CheckerBoard, DotBoard
from tracker.camera.calibration import CalibrationReport, calibrate
from tracker.camera.detection import BoardNotFound, BoardView, find_board
from tracker.camera.rig import calibrate_rig

Found = list[BoardView | BoardNotFound]
Calibrated = tuple[Found, CalibrationReport]


def calibrated(folder: Path, pattern: str, board: Board) -> Calibrated:
    images = [np.asarray(cv2.imread(str(file)), dtype=np.uint8) for file in sorted(folder.glob(pattern))]
    assert images
    found = [find_board(image, board) for image in images]
    size = (images[0].shape[1], images[0].shape[0])
    return found, calibrate([one for one in found if isinstance(one, BoardView)], size_wh_px=size)


@pytest.fixture(scope="module")
def stereo_pair() -> dict[str, Calibrated]:
    folder = real_data_file("calibration", "checkerboard-stereo")
    board = CheckerBoard(columns=9, rows=6, square_mm=1.0)
    return {side: calibrated(folder, f"{side}*.jpg", board) for side in ("left", "right")}


def test_a_stereo_pair_of_checkerboards(stereo_pair: dict[str, Calibrated]) -> None:
    left, left_report = stereo_pair["left"]
    right, right_report = stereo_pair["right"]
    assert left_report.views_used == right_report.views_used == 13
    assert left_report.rms_px <= 0.195
    assert right_report.rms_px <= 0.207
    shots = [
        {"left": a, "right": b}
        for a, b in zip(left, right, strict=True)
        if isinstance(a, BoardView) and isinstance(b, BoardView)
    ]
    rig = calibrate_rig(shots, {"left": left_report, "right": right_report})
    assert rig.shared_shots == 13
    assert rig.rms_px <= 0.217
    assert rig.cameras[1].baseline_mm == pytest.approx(3.328, abs=0.02)
    assert 0.0005 < rig.cameras[1].baseline_sd_mm < 0.02


def test_two_cameras_of_the_pair_are_reported_and_one_alone_is_not(
    stereo_pair: dict[str, Calibrated],
) -> None:
    views = {
        side: [one for one in found if isinstance(one, BoardView)] for side, (found, _) in stereo_pair.items()
    }
    report = calibrate([*views["left"][:10], *views["right"][:5]], size_wh_px=(640, 480))
    assert report.rms_px < 0.23
    (message,) = messages_of_two_cameras(report)
    assert "5 of 15 views (11, 12, 13, 14 and 1 more)" in message
    assert [messages_of_two_cameras(one) for _, one in stereo_pair.values()] == [[], []]


def messages_of_two_cameras(report: CalibrationReport) -> list[str]:
    return [one.message for one in report.warnings if one.code == "TWO_CAMERAS"]


def test_a_machined_dot_grid() -> None:
    folder = real_data_file("calibration", "metal-dot-grid")
    board = DotBoard(columns=16, rows=14, pitch_mm=4.0, fiducials=(69, 74, 149, 154))
    found, report = calibrated(folder, "view-*.png", board)
    assert len(found) == report.views_used == 7
    assert report.rms_px <= 0.62
    assert 1735 < report.camera.matrix[0, 0] < 1770
    assert sum(view.dropped_points for view in report.views) < 10


def test_an_endoscope_with_pixels_that_are_not_square() -> None:
    folder = real_data_file("calibration", "charuco-stereo")
    board = CheckerBoard(columns=13, rows=8, square_mm=3.0)
    _, report = calibrated(folder, "R-*.jpg", board)
    assert report.views_used == 12
    assert report.rms_px <= 0.338
    assert report.pixel_aspect_ratio == pytest.approx(1.09, abs=0.005)
