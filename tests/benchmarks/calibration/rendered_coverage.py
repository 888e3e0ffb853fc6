"""Coverage of the 95 % intervals of a camera calibrated from rendered images of each kind of board."""

import numpy as np

from tests.benchmarks.section_result import SectionResult
from tests.benchmarks.tables import Table
from tests.tracker.camera.rendered import CAMERA, Pose, picture
from tracker.camera import AprilGridBoard, Board, CharucoBoard, CheckerBoard, DotBoard
from tracker.camera.calibration import calibrate
from tracker.camera.detection import BoardView, find_board
from tracker.errors import CalibrationError

RUNS, VIEWS = 16, 10
MAX_TILT_DEG, DISTANCE_MM = 35.0, (200.0, 330.0)
BOARDS: dict[str, Board] = {
    "dots": DotBoard(columns=13, rows=9, pitch_mm=9.0),
    "checkerboard": CheckerBoard(columns=9, rows=6, square_mm=12.0),
    "ChArUco": CharucoBoard(columns=9, rows=7, square_mm=14, marker_mm=10, dictionary="DICT_5X5_250"),
    "AprilGrid": AprilGridBoard(columns=5, rows=4, tag_mm=18.0, gap_mm=6.0),
}
NAMES = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3")


def measure_rendered_calibration() -> SectionResult:
    """Calibrate the known camera of the renderer from random views of each board."""
    rows = [_row(name, board, RUNS) for name, board in BOARDS.items()]
    return SectionResult(
        tables=[
            Table(
                title=f"Calibration from rendered boards, {VIEWS} views each",
                columns=("board", "calibrations", "jackknife", "inside 95 %", *NAMES),
                rows=rows,
                note="RMS of the error divided by its stated standard deviation, of each number. Jackknife: "
                "calibrations whose neighbouring points are found to be correlated. Inside: of all numbers "
                "together, which are not independent within a calibration.",
            )
        ]
    )


def _row(name: str, board: Board, runs: int) -> list[str]:
    k = CAMERA.matrix
    truth = np.array([k[0, 0], k[1, 1], k[0, 2], k[1, 2], *CAMERA.distortion])
    ratios, inside, correlated, rejected = [], [], 0, 0
    for run in range(runs):
        try:
            report = calibrate(_views(board, run), size_wh_px=CAMERA.size_wh_px)
        except CalibrationError:
            rejected += 1
            continue
        correlated += report.is_noise_correlated
        ratios.append(np.full(len(NAMES), np.nan))
        for n, one in enumerate(report.parameters):
            ratios[-1][n] = (one.value - truth[n]) / one.sd
            inside.append(one.low_95 <= truth[n] <= one.high_95)
    rms = np.sqrt(np.nanmean(np.square(ratios), axis=0))
    done = f"{len(ratios)}" + (f", {rejected} rejected" if rejected else "")
    share = f"{100.0 * np.mean(inside):.1f} % of {len(inside)}"
    return [name, done, f"{correlated}", share, *(f"{one:.2f}" for one in rms)]


def _views(board: Board, run: int) -> list[BoardView]:
    random = np.random.default_rng(run)
    views: list[BoardView] = []
    while len(views) < VIEWS:
        # Not cached: each picture is needed once.
        image = picture.__wrapped__(board, _pose(random), seed=int(random.integers(1 << 30)))
        found = find_board(image, board)
        if isinstance(found, BoardView):
            views.append(found)
    return views


def _pose(random: np.random.Generator) -> Pose:
    tilt, turn = random.uniform(0.0, MAX_TILT_DEG), random.uniform(0.0, 2.0 * np.pi)
    z = random.uniform(*DISTANCE_MM)
    aside = random.uniform(-0.12, 0.12, 2) * z
    return (
        (float(tilt * np.cos(turn)), float(tilt * np.sin(turn)), float(random.uniform(-25.0, 25.0))),
        (float(aside[0]), float(aside[1]), float(z)),
    )
