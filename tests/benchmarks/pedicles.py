"""Accuracy of the pedicle measurement: random phantoms in random scans, with random clicks."""

import numpy as np
import scipy

from tests.benchmarks.pedicle_conditions import condition_tables
from tests.benchmarks.section_result import SectionResult
from tests.benchmarks.tables import Table
from tests.tracker.plan.pedicles import Off, off_by
from tracker.errors import NavigationError
from tracker.plan import measure_pedicle
from tracker.rehearsal.ct import random_grid, random_phantom, scan

PHANTOMS = 40
FINE_MM = 1.5


def measure_pedicles(phantoms: int = PHANTOMS) -> SectionResult:
    """Measure both pedicles of each phantom against their ground truth."""
    fine: list[Off] = []
    thick: list[Off] = []
    rejected: list[str] = []
    for seed in range(1, phantoms + 1):
        made = random_phantom(seed)
        volume = scan(made.hu_at, random_grid(made, seed))
        random = np.random.default_rng(seed)
        for side in ("left", "right"):
            truth = made.truth(side)
            aside = random.uniform(-0.3, 0.3, 2) * [truth.width_mm, truth.height_mm]
            seed_mm = made.seed_lps_mm(side, (random.uniform(-6.0, 6.0), float(aside[0]), float(aside[1])))
            try:
                off = off_by(measure_pedicle(volume, seed_mm, side), truth, volume)
            except NavigationError as error:
                rejected.append(error.code)
                continue
            (fine if volume.spacing_mm[2] < FINE_MM else thick).append(off)
    rows = [_row(f"slices under {FINE_MM} mm", fine), _row(f"slices of {FINE_MM} to 3 mm", thick)]
    note = (
        "Median / worst size of the error; widths and heights in voxels of the slice (0.35 to 0.9 mm), "
        f"also where slices are thicker. Within: half a voxel and one degree, with its 95 % Clopper-Pearson "
        f"interval. Rejected: {len(rejected)} {', '.join(sorted(set(rejected)))}".strip()
        + "."
    )
    columns = [
        "scan",
        "pedicles",
        "within",
        "width voxels",
        "height voxels",
        "transverse deg",
        "sagittal deg",
        "length mm",
    ]
    overall = Table(title="", columns=columns, rows=rows, note=note)
    return SectionResult(tables=[overall, *condition_tables()])


def _row(name: str, some: list[Off]) -> list[str]:
    numbers = (
        [abs(off.width_voxels) for off in some],
        [abs(off.height_voxels) for off in some],
        [abs(off.transverse_deg) for off in some],
        [abs(off.sagittal_deg) for off in some],
        [abs(off.length_mm) for off in some],
    )
    cells = [f"{np.median(sizes):.2f} / {max(sizes):.2f}" if sizes else "–" for sizes in numbers]
    return [name, str(len(some)), _share_within(some), *cells]


def _share_within(some: list[Off]) -> str:
    if not some:
        return "–"
    result = scipy.stats.binomtest(sum(off.is_small for off in some), len(some))
    interval = result.proportion_ci(0.95, method="exact")
    return f"{result.statistic:.3f} ({interval.low:.3f}-{interval.high:.3f})"
