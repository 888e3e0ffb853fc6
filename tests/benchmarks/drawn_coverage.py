"""Coverage of stated 95 % regions of calibrations and registrations from drawn errors, without images.

python -m tests.benchmarks.drawn_coverage [--runs 500]: tips by pivoting, registrations by landmarks and by
needles, each with exact confidence intervals.
"""

import argparse
import sys
from collections.abc import Iterator

import numpy as np
from scipy.special import chdtri

from tests.benchmarks.levers import coverage
from tests.benchmarks.tables import Table
from tests.tracker.pose.tool.pivoted import HANDS, STATED, squared_errors
from tests.tracker.registration.drawn_landmarks import KINDS, simulated
from tests.tracker.registration.needles.needle_scenes import OPEN, misfit, registered, scene

NEEDLES = {
    "entries seen": (True, 0),
    "entries hidden": (False, 0),
    "one entry touched": (True, 1),
}


def main(arguments: list[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.drawn_coverage", description=__doc__)
    parser.add_argument("--runs", type=int, default=500, help="of each row")
    runs = parser.parse_args(arguments).runs
    rows = [
        [name, coverage(sum(inside), len(inside))]
        for rows in (_pivoting(runs), _landmarks(runs), _needles(runs))
        for name, inside in rows
    ]
    title = f"{runs} draws of each row: inside the stated 95 %"
    sys.stdout.write(Table(title=title, columns=["what", "share"], rows=rows).markdown + "\n")


def _pivoting(runs: int) -> Iterator[tuple[str, list[bool]]]:
    for name, hand in HANDS.items():
        squared = squared_errors(hand, runs=runs, states_covariance=name in STATED)
        yield f"tip by pivoting, {name}", [one < chdtri(3, 0.05) for one in squared]


def _landmarks(runs: int) -> Iterator[tuple[str, list[bool]]]:
    for name, (count, noise, stated) in KINDS.items():
        seen = simulated(count, noise, stated, runs=runs)
        yield f"landmarks, noise {name}: target", seen.target
        yield f"landmarks, noise {name}: along a direction", seen.along
        yield f"landmarks, noise {name}: pose", seen.pose


def _needles(runs: int) -> Iterator[tuple[str, list[bool]]]:
    for name, (entry_is_seen, touched) in NEEDLES.items():
        scenes = [scene(seed, entry_is_seen=entry_is_seen, touched=touched) for seed in range(runs)]
        off = np.array([misfit(registered(one, OPEN), one) for one in scenes])
        yield f"needles, {name}: pose", (off < chdtri(6, 0.05)).tolist()


if __name__ == "__main__":
    main()
