"""Reliability of the stated probability of a breach, from drawn registrations and drills, without images.

python -m tests.benchmarks.breach_calibration [--registrations 500] [--drills 8]: a rod of bone of 5 mm
radius is registered by six landmarks, each touched with an error, and a drill of 2 mm radius is placed in or
beside it. Its true clearance, and where the true wall lies, come from the formula of the rod. Because no true
pose is preferred, of drills with the same stated probability that share is through the wall, if it is true.
"""

import argparse
import sys
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import scipy

from tests.benchmarks.levers import coverage
from tests.benchmarks.tables import Table
from tests.tracker.navigation.assessed import DRILL_RADIUS_MM, drill, drill_reference
from tests.tracker.navigation.bones import ROD_CHANNEL, ROD_FRONT_MM, ROD_RADIUS_MM, drill_at
from tests.tracker.registration.constellations import VERTEBRA, touched
from tracker.geometry import Array, Rigid, Tool, Vertebra
from tracker.navigation.uncertainty import UncertainPose
from tracker.registration import AnchoredTo
from tracker.registration.points import PointPairs, PointSettings, register_points

# Error of a touch on each axis, and the factor by which the pose of one image is off.
TOUCH_SD_MM = {"touches of 0.3 mm": 0.3, "touches of 0.5 mm": 0.5, "touches of 0.8 mm": 0.8}
TRACKING_SD = np.array([0.1] * 3 + [np.radians(0.1)] * 3)
# The wall of a CT, as the extraction of a surface states it.
WALL_SD_MM = 0.15
# Largest offset and tilt, and depths, of drills near any wall, and of every fourth one, near the front wall.
ANYWHERE = (4.5, 5.0, (10.0, 62.0))
IN_FRONT = (1.8, 2.5, (54.0, 66.0))
WALLS = ("medial", "lateral", "cranial", "caudal", "front")
# Without gross errors, which the stated covariance includes and these touches do not have.
WITHOUT_GROSS_ERRORS = PointSettings(max_left_out_mm=np.inf, min_fle_mm=1e-3)
DECILES = 10
# Logarithms of odds end here.
MIN_STATED = 0.002

BoolArray: TypeAlias = npt.NDArray[np.bool_]
IntArray: TypeAlias = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Drilled:
    """One drill: its registration and wall, the stated probability of a breach, and whether there is one."""

    registration: int
    wall: str
    stated: float
    is_through: bool


def true_clearance_mm(pose: Rigid[Vertebra, Tool]) -> tuple[float, str]:
    """Return the smallest distance of a drill to the wall of the rod, negative outside, and which wall it is.

    As in navigation, the surface through which a drill enters is no wall: points count from 2 mm past it,
    and from 7 mm past the entry where there is no bone.
    """
    along, turn = np.meshgrid(np.linspace(-70.0, 0.0, 281), np.linspace(0.0, 2.0 * np.pi, 181))
    local = np.stack([DRILL_RADIUS_MM * np.cos(turn), DRILL_RADIUS_MM * np.sin(turn), along], axis=-1)
    points = pose.move_points(local.reshape(-1, 3))
    depth = ROD_CHANNEL.entry_in_vertebra_mm[1] - points[:, 1]
    beside = np.hypot(points[:, 0], points[:, 2]) > ROD_RADIUS_MM
    inside = points[depth > np.where(beside, 7.0, 2.0)]
    to_side = ROD_RADIUS_MM - np.hypot(inside[:, 0], inside[:, 2])
    to_front = inside[:, 1] - ROD_FRONT_MM
    if to_front.min() < to_side.min():
        return float(to_front.min()), "front"
    x, _, z = inside[to_side.argmin()]
    # The rod is a pedicle on the left, and +x is the patient's left.
    wall = ("lateral" if x > 0.0 else "medial") if abs(x) > abs(z) else ("cranial" if z > 0.0 else "caudal")
    return float(to_side.min()), wall


def placed(rng: np.random.Generator, box: tuple[float, float, tuple[float, float]]) -> Rigid[Vertebra, Tool]:
    """Return the true pose of a drill, without a preference for any in this box."""
    offset_mm, tilt_deg, depths_mm = box
    return drill_at(
        ROD_CHANNEL,
        rng.uniform(*depths_mm),
        medial_mm=rng.uniform(-offset_mm, offset_mm),
        cranial_mm=rng.uniform(-offset_mm, offset_mm),
        medial_deg=rng.uniform(-tilt_deg, tilt_deg),
        cranial_deg=rng.uniform(-tilt_deg, tilt_deg),
    )


def drilled(
    touch_sd_mm: float, settings: PointSettings, *, registrations: int, drills: int
) -> Iterator[Drilled]:
    """Draw registrations, and drills in each."""
    rng = np.random.default_rng(7)
    reference = replace(drill_reference(), wall_sd_mm=WALL_SD_MM)
    for registration in range(registrations):
        truth = touched(VERTEBRA, rng, touch_sd_mm)
        found = register_points(
            PointPairs(fixed_mm=truth.fixed_mm, moving_mm=truth.moving_mm), settings=settings
        ).registration(AnchoredTo.CAMERA)
        patient = UncertainPose(pose=found.anchor_from_vertebra, covariance=found.covariance)
        wall_mm = rng.normal(scale=WALL_SD_MM)
        for number in range(drills):
            true_pose = placed(rng, IN_FRONT if number % 4 == 3 else ANYWHERE)
            clearance_mm, wall = true_clearance_mm(true_pose)
            anchor_from_tool = truth.fixed_from_moving.inverse @ true_pose
            seen = anchor_from_tool.displaced(TRACKING_SD * rng.normal(size=6))
            tool = patient.inverse @ UncertainPose(pose=seen, covariance=np.diag(TRACKING_SD**2))
            yield Drilled(
                registration=registration,
                wall=wall,
                stated=reference.analyse(tool, drill(), ROD_CHANNEL).now.through_ratio,
                is_through=clearance_mm + wall_mm < 0.0,
            )


def reliability(name: str, drills: list[Drilled]) -> Table:
    """Return stated and actual shares of breaches, by deciles of the stated probability and by walls."""
    stated = np.array([one.stated for one in drills])
    is_through = np.array([one.is_through for one in drills])
    decile = np.minimum((stated * DECILES).astype(int), DECILES - 1)
    groups = {f"{10 * number} to {10 * (number + 1)} %": decile == number for number in range(DECILES)} | {
        wall: np.array([one.wall == wall for one in drills]) for wall in WALLS
    }
    rows = [
        [
            label,
            str(chosen.sum()),
            f"{stated[chosen].mean():.3f}",
            coverage(is_through[chosen].sum(), chosen.sum()),
        ]
        for label, chosen in groups.items()
        if chosen.any()
    ]
    low, slope, high = slope_of(stated, is_through, np.array([one.registration for one in drills]))
    return Table(
        title=f"{name}: {len(drills)} drills, slope {slope:.2f} ({low:.2f} to {high:.2f})",
        columns=["stated, or wall", "drills", "mean stated", "breaches"],
        rows=rows,
    )


def slope_of(stated: Array, is_through: BoolArray, registration: IntArray) -> tuple[float, float, float]:
    """Return the slope of the log odds of breaches over the stated ones, between its 95 % bounds.

    Below 1 the probabilities are too sure, above 1 too cautious. The bounds are those of a bootstrap of
    registrations, because the drills of one share its error.
    """
    odds = scipy.special.logit(np.clip(stated, MIN_STATED, 1.0 - MIN_STATED))
    members = [np.flatnonzero(registration == one) for one in np.unique(registration)]
    rng = np.random.default_rng(1)
    draws = [
        np.concatenate([members[one] for one in rng.integers(len(members), size=len(members))])
        for _ in range(200)
    ]
    slopes = [_slope(odds[chosen], is_through[chosen]) for chosen in draws]
    low, high = np.quantile(slopes, [0.025, 0.975])
    return float(low), _slope(odds, is_through), float(high)


def _slope(odds: Array, is_through: BoolArray) -> float:
    def cost(line: Array) -> float:
        return float(np.logaddexp(0.0, np.where(is_through, -1.0, 1.0) * (line[0] + line[1] * odds)).mean())

    return float(scipy.optimize.minimize(cost, [0.0, 1.0]).x[1])


def main(arguments: list[str] | None = None) -> None:
    """Print a table for each error of touches."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.benchmarks.breach_calibration", description=__doc__
    )
    parser.add_argument("--registrations", type=int, default=500)
    parser.add_argument("--drills", type=int, default=8, help="in each registration")
    options = parser.parse_args(arguments)
    for name, sd_mm in TOUCH_SD_MM.items():
        for what, settings in (
            ("as shown", PointSettings()),
            ("without floor and gross errors", WITHOUT_GROSS_ERRORS),
        ):
            drills = list(
                drilled(sd_mm, settings, registrations=options.registrations, drills=options.drills)
            )
            sys.stdout.write(reliability(f"{name}, {what}", drills).markdown + "\n\n")


if __name__ == "__main__":
    main()
