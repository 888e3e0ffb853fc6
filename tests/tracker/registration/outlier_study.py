"""Simulated registrations with and without one mistaken landmark.

`python -m tests.tracker.registration.outlier_study` prints the table.

Landmarks are drawn from a lumbar vertebra's; one is touched 6 mm off in a random direction. Some draws come
with the covariances of the tips, as on the server, some without, as from files.
"""

import argparse
import sys
from dataclasses import dataclass, field

import numpy as np
from scipy.special import chdtri

from tests.tracker.registration.constellations import VERTEBRA, touched
from tracker.errors import RegistrationError
from tracker.geometry import Array
from tracker.registration.points import PointGate, PointPairs, PointRegistration, register_points

# Also the other lamina, the root of the spinous process and both lower facets.
LANDMARKS = np.vstack(
    [VERTEBRA, [[-9.0, 9.0, -3.0], [0.0, 15.0, 2.0], [14.0, 4.0, -22.0], [-13.0, 5.0, -21.0]]]
)
# The entry point of a left channel, and its end in the vertebral body.
TARGETS = np.array([[16.0, 0.0, 6.0], [10.0, -44.0, 4.0]])
OUTLIER_MM = 6.0
SD_MM = (0.3, 0.6)  # of a landmark along each axis: FLE of 0.5 and 1.0 mm
GATE = PointGate(max_tre_mm=np.inf)


@dataclass
class Tally:
    """Results of simulated registrations; each list has a value a registration, or a row a target.

    Attributes:
        rejected: whether the gates on FRE and leave-one-out error reject it.
        widened: whether a gross error is not excluded.
        first, named: whether the mistaken point is the likeliest outlier, and whether it is among them.
        off_mm, stated_mm, alone_mm: (2,) true error, stated error, stated error without outlier.
        inside, inside_alone: (2,) whether the 95 % regions of the two contain the truth.
    """

    rejected: list[bool] = field(default_factory=list)
    widened: list[bool] = field(default_factory=list)
    first: list[bool] = field(default_factory=list)
    named: list[bool] = field(default_factory=list)
    off_mm: list[list[float]] = field(default_factory=list)
    stated_mm: list[list[float]] = field(default_factory=list)
    alone_mm: list[list[float]] = field(default_factory=list)
    inside: list[list[bool]] = field(default_factory=list)
    inside_alone: list[list[bool]] = field(default_factory=list)


def draw(count: int, rng: np.random.Generator, *, outlier_mm: float, stated: bool, tally: Tally) -> None:
    """Simulate one registration by `count` landmarks; add its results."""
    while True:
        fixed = LANDMARKS[rng.permutation(len(LANDMARKS))[:count]]
        sd = float(rng.choice(SD_MM))
        truth = touched(fixed, rng, sd)
        way = rng.normal(size=3)
        wrong = int(rng.integers(count))
        moving = truth.moving_mm.copy()
        moving[wrong] += outlier_mm * way / np.linalg.norm(way)
        # A tip knows its own noise, not that of the landmark; the settings add a floor for it.
        noise = np.tile(sd**2 / 2.0 * np.eye(3), (count, 1, 1)) if stated else None
        pairs = PointPairs(fixed_mm=fixed, moving_mm=moving, moving_covariances_mm2=noise)
        try:
            found = register_points(pairs)
        except RegistrationError as error:
            if error.code == "POINTS_COLLINEAR":
                continue
            # Another order fits better: rejected, too, without naming a point.
            tally.rejected.append(True)
            return
        break
    outliers = found.outliers(GATE)
    tally.rejected.append(bool(found.failures(GATE, [])))
    tally.widened.append(any(mm > found.settings.max_left_out_mm for mm in found.undetected_mm.values()))
    if outliers:
        tally.first.append(outliers[0] == wrong)
        tally.named.append(wrong in outliers)
    if tally.rejected[-1]:
        return
    inverse = truth.fixed_from_moving.inverse
    errors = [found.fixed_from_moving.move_points(inverse.move_points(at)) - at for at in TARGETS]
    tally.off_mm.append([float(np.linalg.norm(error)) for error in errors])
    tally.stated_mm.append([found.tre_stated_mm(at) for at in TARGETS])
    tally.alone_mm.append([found.tre_without_outlier_mm(at) for at in TARGETS])
    both = [(found.covariance, tally.inside), (found.covariance_without_outlier, tally.inside_alone)]
    for covariance, inside in both:
        inside.append([_inside(found, covariance, at, off) for at, off in zip(TARGETS, errors, strict=True)])


def _inside(found: PointRegistration, covariance: Array, target: Array, error: Array) -> bool:
    arm = found.fixed_from_moving.rotation @ found.fixed_from_moving.inverse.move_points(target)
    row = np.hstack([np.eye(3), -np.cross(np.eye(3), arm)])
    at_target = row @ covariance @ row.T
    return bool(error @ np.linalg.solve(at_target, error) < chdtri(3, 0.05))


def study(count: int, runs: int, *, outlier_mm: float, stated: bool, seed: int = 0) -> Tally:
    """Return the results of `runs` registrations by `count` landmarks, with one mistaken by `outlier_mm`."""
    rng = np.random.default_rng([seed, count, int(stated), int(outlier_mm > 0.0)])
    tally = Tally()
    for _ in range(runs):
        draw(count, rng, outlier_mm=outlier_mm, stated=stated, tally=tally)
    return tally


def main() -> None:
    """Print a table by number of landmarks."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=300)
    runs = parser.parse_args().runs
    sys.stdout.write(
        "landmarks, noise | good sets: rejected, stated mm without > with outlier at entry and depth, "
        "covered | 6 mm off: rejected, likeliest right, among the named; accepted: off mm, "
        "covered without > with\n"
    )
    for stated in (True, False):
        for count in range(3, 9):
            good = study(count, runs, outlier_mm=0.0, stated=stated)
            bad = study(count, runs, outlier_mm=OUTLIER_MM, stated=stated)
            before, after = np.median(good.alone_mm, axis=0), np.median(good.stated_mm, axis=0)
            row = (
                f"{count}, {'tips' if stated else 'residuals'} | {np.mean(good.rejected):.3f}, "
                f"{before[0]:.2f} > {after[0]:.2f}, {before[1]:.2f} > {after[1]:.2f}, "
                f"{np.mean(good.inside):.3f} | {np.mean(bad.rejected):.3f}, "
            )
            row += f"{np.mean(bad.first):.2f}, {np.mean(bad.named):.2f}; " if bad.first else "-; "
            if bad.off_mm:
                off = np.median(bad.off_mm, axis=0)
                row += (
                    f"{len(bad.off_mm)}: {off[0]:.1f}, {off[1]:.1f}, "
                    f"{np.mean(bad.inside_alone):.2f} > {np.mean(bad.inside):.2f}"
                )
            sys.stdout.write(row + "\n")
            sys.stdout.flush()


if __name__ == "__main__":
    main()
