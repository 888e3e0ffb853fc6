"""Calibration of simulated tools: errors of tip and axis, and coverage of their stated covariance."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import scipy

from tests.benchmarks.figures import Figure, Share, interval, size_of
from tests.benchmarks.options import BenchmarkOptions
from tests.benchmarks.section_result import SectionResult
from tests.benchmarks.tables import Table, pair, percentile
from tests.tracker.pose.tool.pivoted import AXIS, Hand, pivoted, spun
from tracker.errors import CalibrationError
from tracker.geometry import angle_between_deg
from tracker.pose.tool import pivot_calibration, spin_calibration

LONG = (-14.0, 390.0, -7.0)
ONE_CAMERA = Hand(shift_sd_mm=0.03, depth_sd_mm=0.3, turn_sd_deg=(0.3, 0.3, 0.05))
HANDS: Mapping[str, tuple[Hand, bool]] = {
    "like a ball, 0.2 mm": (Hand(shift_sd_mm=0.2, turn_sd_deg=(0.0, 0.0, 0.0)), False),
    "of angles, 0.3 deg": (Hand(shift_sd_mm=0.02, turn_sd_deg=(0.3, 0.3, 0.3)), False),
    "of both, 0.1 mm and 0.1 deg": (Hand(), False),
    "one camera: depth 0.3 mm, tilt 0.3 deg": (ONE_CAMERA, False),
    "one camera, covariances stated": (ONE_CAMERA, True),
    "of both, 15 % outliers": (Hand(outlier_ratio=0.15), False),
    "of both, 35 % outliers": (Hand(outlier_ratio=0.35), False),
    "of both, 16 poses": (Hand(count=16), False),
    "of both, 300 poses": (Hand(count=300), False),
    "of both, tilted by 12 deg to each side": (Hand(tilts_deg=(12.0, 12.0)), False),
    "pointer of 390 mm, 0.5 mm and 0.1 deg": (
        Hand(tip_mm=LONG, tilts_deg=(18.0, 18.0), shift_sd_mm=0.5, pivot_mm=(-800.0, -80.0, 2100.0)),
        False,
    ),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Runs:
    """Errors, stated standard deviations and coverage of many calibrations of one kind."""

    errors: list[float]
    stated: list[float]
    inside: int
    rejected: int

    @property
    def count(self) -> int:
        """Return the number of accepted calibrations."""
        return len(self.errors)


def measure_tools(options: BenchmarkOptions) -> SectionResult:
    """Measure pivot and spin calibrations of simulated tools against their truth."""
    tips = {name: pivots(hand, runs=options.runs, states=states) for name, (hand, states) in HANDS.items()}
    axes = {
        "wobble 1 deg, spun by 160 deg": spins(runs=options.runs, wobble_deg=1.0, arc_deg=160.0),
        "wobble 2 deg, spun by 120 deg, a tenth outliers": spins(
            runs=options.runs, wobble_deg=2.0, arc_deg=120.0, outliers=6
        ),
    }
    figures: dict[str, Figure] = {}
    for name, runs in {**tips, **axes}.items():
        figures[f"{name}: inside 95 %"] = Share(count=runs.inside, of=runs.count)
        error = size_of(runs.errors)
        if error is not None:
            figures[f"{name}: error"] = error
    return SectionResult(
        tables=[
            _table("Tip by pivoting, error in mm: median / 95th percentile", "noise of the poses", tips),
            _table("Axis by spinning, error in degrees: median / 95th percentile", "motion", axes),
        ],
        figures=figures,
    )


def pivots(hand: Hand, *, runs: int, states: bool) -> Runs:
    """Run pivot calibrations of one kind."""

    def one(seed: int) -> tuple[float, float, float]:
        made = pivoted(hand, seed=seed, states_covariance=states)
        found = pivot_calibration(made.poses)
        off = found.tip_in_marker_mm - made.tip_mm
        squared = float(off @ np.linalg.solve(found.tip_covariance_mm2, off))
        return float(np.linalg.norm(off)), found.tip_sd_mm, squared

    return _runs(one, runs=runs, freedom=3)


def spins(*, runs: int, wobble_deg: float, arc_deg: float, outliers: int = 0) -> Runs:
    """Run spin calibrations of one kind."""

    def one(seed: int) -> tuple[float, float, float]:
        poses = spun(seed=seed, wobble_deg=wobble_deg, arc_deg=arc_deg, outliers=outliers)
        found = spin_calibration(poses, tip_in_marker_mm=120.0 * AXIS)
        across = np.linalg.svd(found.axis_in_marker[None, :])[2][1:]
        off = across @ AXIS
        squared = float(off @ np.linalg.solve(across @ found.axis_covariance_rad2 @ across.T, off))
        return angle_between_deg(found.axis_in_marker, AXIS), found.axis_sd_deg, squared

    return _runs(one, runs=runs, freedom=2)


def _runs(one: Callable[[int], tuple[float, float, float]], *, runs: int, freedom: int) -> Runs:
    errors, stated, inside, rejected = [], [], 0, 0
    maximum = float(scipy.special.chdtri(freedom, 0.05))
    for seed in range(runs):
        try:
            error, sd, squared = one(seed)
        except CalibrationError:
            rejected += 1
            continue
        errors.append(error)
        stated.append(sd)
        inside += squared <= maximum
    return Runs(errors=errors, stated=stated, inside=inside, rejected=rejected)


def _table(title: str, what: str, runs_of: Mapping[str, Runs]) -> Table:
    rows = []
    for name, runs in runs_of.items():
        low, high = interval(runs.inside, runs.count, 1.96)
        rows.append(
            [
                name,
                str(runs.count),
                str(runs.rejected),
                pair(runs.errors, 95.0, 3),
                f"{percentile(runs.stated, 50.0):.3f}",
                f"{runs.inside / max(runs.count, 1):.3f} ({low:.2f}-{high:.2f})",
            ]
        )
    columns = [what, "runs", "rejected", "error", "stated sd, worst way", "inside the stated 95 %"]
    return Table(title=title, columns=columns, rows=rows)
