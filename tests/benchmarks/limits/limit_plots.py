"""Plots of a run: detection by condition, tip error against its bound, and covariance coverage."""

import math
from collections.abc import Callable, Sequence

from tests.benchmarks.dot_plots import Panel, Series, svg
from tests.benchmarks.figures import interval
from tests.benchmarks.limits import goals
from tests.benchmarks.limits.condition_tables import TWO_SD, coverage_groups, errors, right
from tests.benchmarks.limits.conditions_run import ConditionRun
from tests.benchmarks.limits.evaluation import COVERED, Evaluation
from tests.benchmarks.limits.run import LimitsRun
from tests.benchmarks.tables import median

OWN, STEP, PEERS = "#1f5fbf", "#0a0a0a", {"cv2.aruco": "#d2691e", "AprilTag": "#8a2be2"}
KINDS = ("#1f5fbf", "#d2691e", "#0a0a0a")
BOUND = "#2e8b57"
FEWEST_STATED = 5

Value = Callable[[Sequence[Evaluation]], float]


def limit_plots(run: LimitsRun) -> dict[str, str]:
    """Return each picture by its name."""
    return {
        "found": svg(
            "Share of images in which the marker is found", [_found(run, rig) for rig in run.conditions]
        ),
        "tip": svg(
            "Median error of the tip 120 mm from the marker, in mm",
            [_tip(run, rig) for rig in run.conditions],
        ),
        "coverage": svg(
            "Share of errors inside their stated 95 % ellipsoid; shaded: the goal",
            [_coverage(run, rig) for rig in run.conditions],
        ),
    }


def _found(run: LimitsRun, rig: str) -> Panel:
    some = run.conditions[rig]
    return Panel(
        title=f"camera {rig}",
        rows=[one.condition for one in some],
        limits=(0.0, 1.0),
        series=[
            *_peers(run, some, _share),
            Series(name="search", colour=OWN, values=[_share(one.searched) for one in some]),
            Series(
                name="tracked by step",
                colour=STEP,
                values=[_share(one.stepped) for one in some],
                is_hollow=True,
            ),
        ],
    )


def _tip(run: LimitsRun, rig: str) -> Panel:
    some = run.conditions[rig]
    return Panel(
        title=f"camera {rig}",
        rows=[one.condition for one in some],
        limits=(0.05, 100.0) if rig == "A" else (0.01, 20.0),
        is_log=True,
        series=[
            *_peers(run, some, _tip_mm),
            Series(name="search", colour=OWN, values=[_tip_mm(one.searched) for one in some]),
            Series(
                name="tracked by step",
                colour=STEP,
                values=[_tip_mm(one.stepped) for one in some],
                is_hollow=True,
            ),
            Series(
                name="Cramer-Rao bound",
                colour=BOUND,
                values=[median(bound.tip_mm for bound in one.bounds) for one in some],
                is_hollow=True,
            ),
        ],
    )


def _coverage(run: LimitsRun, rig: str) -> Panel:
    groups = [(name, some) for name, some in coverage_groups(run, rig) if len(some) >= FEWEST_STATED]
    series = []
    for number, (what, colour) in enumerate(zip(COVERED, KINDS, strict=True)):
        counts = [(sum(one.covered[number] for one in some), len(some)) for _, some in groups]
        series.append(
            Series(
                name=what,
                colour=colour,
                values=[inside / count for inside, count in counts],
                ranges=[interval(inside, count, TWO_SD) for inside, count in counts],
                is_hollow=number > 0,
            )
        )
    return Panel(
        title=f"camera {rig}",
        rows=[name for name, _ in groups],
        limits=(0.0, 1.0),
        band=goals.COVERED,
        series=series,
    )


def _peers(run: LimitsRun, some: Sequence[ConditionRun], value: Value) -> list[Series]:
    return [
        Series(name=name, colour=PEERS[name], values=[value(one.peers[name]) for one in some])
        for name in run.peers
    ]


def _share(judgements: Sequence[Evaluation]) -> float:
    return right(judgements) / len(judgements) if judgements else math.nan


def _tip_mm(judgements: Sequence[Evaluation]) -> float:
    return median(errors(judgements, "tip_mm"))
