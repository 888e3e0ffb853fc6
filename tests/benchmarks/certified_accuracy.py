"""Print in how many rehearsed accuracy tests the claims of the certificate hold.

Each system has another camera noise, residual distortion, tip calibration and divot play. The truth is the
error of many later tests of the same system, at the same placements of the plate.

    PYTHONPATH=. python -m tests.benchmarks.certified_accuracy --systems 100
"""

import argparse
import sys
from collections import Counter
from collections.abc import Iterator

import numpy as np
from scipy import stats

from tracker.accuracy import (
    AccuracyAssessment,
    DivotPlate,
    Estimate,
    Fault,
    FigureName,
    PlateScale,
    assess_accuracy,
)
from tracker.accuracy.rehearsed import RehearsedFaults, RehearsedSystem, rehearse, true_errors_mm
from tracker.geometry import Array

TRUTH_ROUNDS = 6
SCALE_SD_RATIO = 1e-3


def plate_of(sd_mm: float) -> DivotPlate:
    points = {
        f"{3 * row + column + 1}": (60.0 * column, 60.0 * row, 0.0) for row in range(3) for column in range(3)
    }
    return DivotPlate(name="A4", points_mm=points, sd_mm=sd_mm)


def system_of(number: int, faults: RehearsedFaults | None = None) -> RehearsedSystem:
    random = np.random.default_rng(number)
    return RehearsedSystem(
        plate=plate_of(random.uniform(0.05, 0.25)),
        faults=faults or RehearsedFaults(),
        tip_sd_mm=random.uniform(0.02, 0.2),
        corner_sd_px=random.uniform(0.02, 0.06),
        jitter_sd_px=random.uniform(0.005, 0.02),
        field_sd_px=random.uniform(0.0, 0.06),
        seed=number,
    )


def assessed(system: RehearsedSystem) -> AccuracyAssessment:
    captures = [one.at_rest(system.tool) for one in rehearse(system, seed=0)]
    # The rulers are read with an error of their own.
    read = 1.0 + np.random.default_rng([system.seed, 9]).normal() * SCALE_SD_RATIO
    scale = PlateScale(x_ratio=read, y_ratio=read, sd_ratio=SCALE_SD_RATIO)
    return assess_accuracy(captures, system.plate, system.tool, plate_scale=scale)


def claims(system: RehearsedSystem, found: AccuracyAssessment) -> Iterator[tuple[str, bool]]:
    """Yield each claim and whether it holds."""
    of_image, errors = true_errors_mm(system, seed=1, rounds=TRUTH_ROUNDS).transpose(1, 0, 2)
    lengths = np.linalg.norm(of_image, axis=1)
    # The captures of a round are those of the near placement, and then those of the far one.
    by_placement = lengths.reshape(TRUTH_ROUNDS, 2, -1)
    worst = max(float(np.quantile(by_placement[:, one], 0.95)) for one in (0, 1))
    yield "95 % within the certified error", worst <= found.figures.error_95_mm
    groups = np.tile(np.arange(18).repeat(3), TRUTH_ROUNDS)
    means = np.array([errors[groups == one].mean(axis=0) for one in range(18)])
    inside = ((errors - means[groups]) ** 2).sum() / (len(errors) - 18)
    truths = {
        FigureName.POINT_RMS: float((lengths**2).mean()) ** 0.5,
        FigureName.POINT_PRECISION: float(inside) ** 0.5,
    }
    for name, truth in truths.items():
        figure = found.figures.get(name)
        assert figure is not None
        yield f"{name.value} in its interval", contains(figure.estimate, truth)
    tool = system.tool
    offset = tool.tip_in_marker_mm - np.array(system.tip_in_marker_mm)
    true_values: dict[Fault, Array] = {
        Fault.SCALE: np.array([system.faults.print_scale_ratio]),
        Fault.FOCAL_LENGTH: np.array([system.faults.focal_error_ratio]),
        Fault.TIP_OFFSET: offset,
    }
    for fault, value in true_values.items():
        estimate = found.diagnosis.of(fault)
        yield f"{fault.value} below its upper limit", bool(np.linalg.norm(value) <= estimate.max_size)
        if len(value) == 1:
            off = abs(estimate.value[0] - value[0])
            yield f"{fault.value} in its interval", bool(off <= 1.96 * estimate.sd)


def contains(estimate: Estimate, truth: float) -> bool:
    return estimate.low <= truth <= estimate.high


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--systems", type=int, default=100)
    given = parser.parse_args()
    confirmed: Counter[str] = Counter()
    outcomes: Counter[str] = Counter()
    for number in range(given.systems):
        system = system_of(number)
        found = assessed(system)
        outcomes.update({problem.code for problem in found.problems} or {"certified"})
        for claim, holds in claims(system, found):
            confirmed[claim] += holds
    for claim, count in confirmed.items():
        low, high = (
            stats.beta.ppf(0.025, count, given.systems - count + 1),
            stats.beta.ppf(0.975, count + 1, given.systems - count) if count < given.systems else 1.0,
        )
        sys.stdout.write(
            f"{claim:38s} {count:4d} of {given.systems} (95 % interval {low:.0%} to {high:.0%})\n"
        )
    sys.stdout.write(f"outcomes of sound systems: {dict(outcomes)}\n")


if __name__ == "__main__":
    main()
