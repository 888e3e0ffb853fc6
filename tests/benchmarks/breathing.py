"""What the monitor of the patient's reference makes of breathing and of bumps, before a still scene.

python -m tests.benchmarks.breathing [--patients 12]: poses with noise, no images. Breaths vary in depth,
length and direction from patient to patient, and in depth and length from breath to breath.
"""

import argparse
import sys
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tests.benchmarks.tables import Table
from tracker.geometry import Camera, Marker, Rigid
from tracker.navigation.monitoring import ReferenceMonitor, ReferenceState, SceneState

RATE_HZ, LEARNING_S, LASTS_S = 30.0, 30.0, 150.0
DEPTHS_MM = (0.0, 3.0, 5.0, 8.0, 10.0, 12.0)
DEG_OF_MM = 0.25
BUMPS_MM = (3.0, 5.0, 7.0, 10.0)
BUMP_LASTS_S, SOON_S, LATE_S = 0.15, 0.5, 10.0
NOISE_MM, NOISE_DEG = np.array([0.1, 0.1, 0.4]), 0.2
WITHHELD = {ReferenceState.SWAYING, ReferenceState.MOVED}


@dataclass(frozen=True, slots=True, kw_only=True)
class Breathing:
    """Displacement of a reference by breathing: vectors in mm and degrees, and the breaths.

    Attributes:
        shift_mm: (3,) at the deepest.
        turn_deg: (3,) at the deepest.
        depth_at_s: relative depth, 0 to about 1, in steps of an image.
    """

    shift_mm: npt.NDArray[np.float64]
    turn_deg: npt.NDArray[np.float64]
    depth_at_s: npt.NDArray[np.float64]


def breathing(depth_mm: float, random: np.random.Generator) -> Breathing:
    """Return the breathing of one patient; 10 to 20 breaths a minute, with a rest after breathing out."""
    shift, turn = random.normal(size=(2, 3))
    depths: list[npt.NDArray[np.float64]] = []
    period_s = random.uniform(3.0, 6.0)
    while sum(map(len, depths)) < (LEARNING_S + LASTS_S) * RATE_HZ:
        images = round(period_s * random.normal(1.0, 0.05) * RATE_HZ)
        # Steeper in and out than a cosine, with a rest between.
        breath = np.sin(np.pi * np.arange(images) / images) ** 3
        depths.append(random.normal(1.0, 0.08) * breath)
    return Breathing(
        shift_mm=depth_mm * shift / np.linalg.norm(shift),
        turn_deg=DEG_OF_MM * depth_mm * turn / np.linalg.norm(turn),
        depth_at_s=np.concatenate(depths),
    )


def states(
    patient: Breathing, random: np.random.Generator, *, bump_mm: float = 0.0, bumped_s: float = np.inf
) -> Iterator[tuple[float, ReferenceState]]:
    """Yield the state in each image; a monitor that reports a motion begins again, as in navigation."""
    way = random.normal(size=3)
    way /= np.linalg.norm(way)
    monitor: ReferenceMonitor | None = None
    for number, depth in enumerate(patient.depth_at_s):
        at_s = number / RATE_HZ
        bump = bump_mm * float(np.clip((at_s - bumped_s) / BUMP_LASTS_S, 0.0, 1.0))
        pose: Rigid[Camera, Marker] = Rigid.from_vector(
            np.radians(depth * patient.turn_deg + random.normal(0.0, NOISE_DEG, 3)),
            np.array([0.0, 0.0, 500.0])
            + depth * patient.shift_mm
            + bump * way
            + random.normal(0.0, 1.0, 3) * NOISE_MM,
        )
        if monitor is None:
            monitor = ReferenceMonitor(pose)
            continue
        state = monitor.check(pose, SceneState.STILL, at_s=at_s).state
        yield at_s, state
        if state is ReferenceState.MOVED:
            monitor = ReferenceMonitor(pose)


def breathing_table(patients: int) -> Table:
    """Return how often breathing alone withholds the registration."""
    rows = []
    for depth_mm in DEPTHS_MM:
        withheld = images = moved = first = 0
        for seed in range(patients):
            random = np.random.default_rng([seed, 1])
            for at_s, state in states(breathing(depth_mm, random), random):
                if at_s < LEARNING_S:
                    first += state in WITHHELD
                    continue
                images += 1
                withheld += state in WITHHELD
                moved += state is ReferenceState.MOVED
        rows.append(
            [
                f"{depth_mm:g} mm, {DEG_OF_MM * depth_mm:g} deg",
                f"{first / (patients * LEARNING_S * RATE_HZ):.3f}",
                f"{withheld / images:.4f}",
                f"{moved / (images / RATE_HZ / 3600.0):.1f}",
            ]
        )
    return Table(
        title=f"Breathing, {patients} patients of {LASTS_S:.0f} s after {LEARNING_S:.0f} s",
        columns=["depth", "withheld at first", "withheld later", "reported as a bump, an hour"],
        rows=rows,
    )


def bump_table(patients: int) -> Table:
    """Return how many bumps are reported, and how soon."""
    rows = []
    for depth_mm in DEPTHS_MM[::2]:
        for bump_mm in BUMPS_MM:
            soon = late = 0
            for seed in range(patients):
                random = np.random.default_rng([seed, 2])
                patient = breathing(depth_mm, random)
                bumped_s = random.uniform(LEARNING_S, LEARNING_S + LASTS_S / 2.0)
                after = [
                    at_s - bumped_s
                    for at_s, state in states(patient, random, bump_mm=bump_mm, bumped_s=bumped_s)
                    if state is ReferenceState.MOVED and at_s > bumped_s
                ]
                soon += bool(after) and after[0] <= SOON_S
                late += bool(after) and after[0] <= LATE_S
            rows.append(
                [f"{depth_mm:g} mm", f"{bump_mm:g} mm", f"{soon / patients:.2f}", f"{late / patients:.2f}"]
            )
    return Table(
        title=f"Bumps of {BUMP_LASTS_S:g} s, in {patients} patients",
        columns=["breath", "bump", f"reported within {SOON_S:g} s", f"within {LATE_S:g} s"],
        rows=rows,
    )


def main(arguments: list[str] | None = None) -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.breathing", description=__doc__)
    parser.add_argument("--patients", type=int, default=12, help="of each row")
    given = parser.parse_args(arguments)
    for table in (breathing_table(given.patients), bump_table(given.patients)):
        sys.stdout.write(table.markdown + "\n")


if __name__ == "__main__":
    main()
