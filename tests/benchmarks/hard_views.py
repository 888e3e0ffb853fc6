"""Coverage of the stated 95 % ellipsoids in views of which a fit is easily sure of a wrong pose.

python -m tests.benchmarks.hard_views [--scenes 200] [--seed 0]: single markers of 16 to 80 px with a spoilt
outline, in motion, leaning, covered along a side, or interlaced.
"""

import argparse
import sys

import numpy as np

from tests.benchmarks.levers import coverage
from tests.benchmarks.tables import Table
from tests.tracker import hard_views
from tests.tracker.small_scenes import judged_by_seed, trackers_by_face

VIEWS = {
    "framed": hard_views.framed,
    "sides cut off": hard_views.with_cut_sides,
    "strip along a side": hard_views.beside_a_strip,
    "strip along a side, tracked": hard_views.moving_beside_a_strip,
    "motion and defocus": hard_views.in_motion,
    "leaning, tracked": hard_views.leaning,
    "one side covered": hard_views.with_a_side_covered,
    "interlaced": hard_views.interlaced,
}


def main(arguments: list[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.hard_views", description=__doc__)
    parser.add_argument("--scenes", type=int, default=200, help="of each view")
    parser.add_argument("--seed", type=int, default=0, help="of the first scene")
    given = parser.parse_args(arguments)
    sys.stdout.write(table_of(range(given.seed, given.seed + given.scenes)).markdown + "\n")


def table_of(seeds: range) -> Table:
    """Return coverage and largest error of the poses in the scenes of these seeds, by view."""
    trackers, rows = trackers_by_face(), []
    for name, shown in VIEWS.items():
        judged = [one for _, one in judged_by_seed(shown, seeds, trackers)]
        found = [one for one in judged if one.covered]
        inside = np.array([one.covered for one in found]).sum(axis=0)
        worst = max(max(one.mahalanobis_squared) for one in found)
        rows.append(
            [
                name,
                f"{len(found)} of {len(judged)}",
                *(coverage(int(count), len(found)) for count in inside),
                f"{np.sqrt(worst):.1f}",
            ]
        )
    return Table(
        title=f"Markers of 16 to 80 px, {len(seeds)} scenes of each view: inside the stated 95 %",
        columns=["view", "images with a pose", "translation", "rotation", "tip", "largest error, stated sd"],
        rows=rows,
    )


if __name__ == "__main__":
    main()
