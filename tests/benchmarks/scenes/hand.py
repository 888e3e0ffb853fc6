"""Smooth hand motion of a marker: slow swings and tremor, known at every time."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from tests.benchmarks.scenes.conditions import BASE, Condition
from tests.benchmarks.scenes.faces import Face
from tests.benchmarks.scenes.placement import posed, scene_at, shutter_poses
from tests.benchmarks.scenes.rigs import Rig
from tests.benchmarks.scenes.scene import Pose, Scene
from tracker.geometry import Array

SHUTTER_S = 0.004
RATE_HZ = 60.0
# Root mean square of the swings' speed, mm/s and degrees/s, and of the tremor, mm and degrees.
SPEEDS = {
    "still": (0.0, 0.0, 0.10, 0.10),
    "slow": (30.0, 15.0, 0.10, 0.10),
    "normal": (100.0, 40.0, 0.15, 0.15),
    "fast": (300.0, 100.0, 0.20, 0.20),
}
SWINGS, TREMORS = 4, 3
MAX_TILT_DEG = 55.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Waves:
    """A sum of sine waves in one direction: sizes, angular speeds and phases, each (n,)."""

    size: Array
    rad_per_s: Array
    phase: Array

    def at(self, time_s: float) -> float:
        """Return the value at a time."""
        return float(np.sum(self.size * np.sin(self.rad_per_s * time_s + self.phase)))


class Hand:
    """The marker pose at any time: `pose_at(time_s)`."""

    def __init__(self, rig: Rig, speed: str, *, seed: int) -> None:
        random = np.random.default_rng([seed, 61])
        mm_per_s, deg_per_s, tremor_mm, tremor_deg = (value / np.sqrt(3.0) for value in SPEEDS[speed])
        near, far = rig.depth_mm
        depth = 0.5 * (near + far)
        width, height = rig.size_wh_px
        # Beyond this box the way bends back softly, so that the marker stays in the image.
        self._box_mm = np.array([0.36 * width, 0.34 * height, 0.0]) * depth / rig.focal_px
        self._box_mm[2] = 0.45 * (far - near)
        self._middle_mm = np.array([0.0, 0.0, depth])
        self._start_mm = random.uniform(-0.4, 0.4, 3) * self._box_mm
        self._roll_deg = random.uniform(-180.0, 180.0)
        about, tilt = random.uniform(0.0, 2.0 * np.pi), random.uniform(5.0, 35.0)
        self._lean_deg = np.array([np.cos(about), np.sin(about)]) * tilt
        self._moves = [_waves(random, mm_per_s, tremor_mm) for _ in range(3)]
        self._turns = [_waves(random, deg_per_s, tremor_deg) for _ in range(3)]

    def pose_at(self, time_s: float) -> Pose:
        """Return the marker pose."""
        moved = self._start_mm + [wave.at(time_s) for wave in self._moves]
        roll, *lean = (wave.at(time_s) for wave in self._turns)
        leaning = self._lean_deg + lean
        tilt = MAX_TILT_DEG * np.tanh(float(np.linalg.norm(leaning)) / MAX_TILT_DEG)
        return posed(
            self._middle_mm + self._box_mm * np.tanh(moved / self._box_mm),
            tilt_deg=float(tilt),
            about_deg=float(np.degrees(np.arctan2(leaning[1], leaning[0]))),
            roll_deg=self._roll_deg + roll,
        )


def _waves(random: np.random.Generator, speed_rms: float, tremor_rms: float) -> Waves:
    """Return swings at 0.2 to 1.8 Hz of this total speed, and a tremor at 7 to 11 Hz of this size."""
    swing = 2.0 * np.pi * np.exp(random.uniform(np.log(0.2), np.log(1.8), SWINGS))
    tremor = 2.0 * np.pi * random.uniform(7.0, 11.0, TREMORS)
    speeds, sizes = random.uniform(0.5, 1.0, SWINGS), random.uniform(0.5, 1.0, TREMORS)
    speeds *= speed_rms * np.sqrt(2.0) / np.linalg.norm(speeds)
    sizes *= tremor_rms * np.sqrt(2.0) / np.linalg.norm(sizes)
    return Waves(
        size=np.concatenate([speeds / swing, sizes]),
        rad_per_s=np.concatenate([swing, tremor]),
        phase=random.uniform(0.0, 2.0 * np.pi, SWINGS + TREMORS),
    )


def hand_scenes(
    rig: Rig,
    face: Face,
    speed: str,
    *,
    seed: int,
    count: int,
    condition: Condition = BASE,
    undisturbed_images: int = 0,
) -> Iterator[tuple[float, Scene]]:
    """Yield scenes at 60 Hz with their times; each has the motion blur of its exposure.

    The first `undisturbed_images` are in base condition, whatever the condition of the others.
    """
    rig = rig.bent() if condition.has_bent_lens else rig
    hand = Hand(rig, speed, seed=seed)
    for number in range(count):
        at_s = number / RATE_HZ
        ends = [rig.px_of(hand.pose_at(at_s + tau * SHUTTER_S), face.corners_mm) for tau in (-0.5, 0.5)]
        way_px = float(np.linalg.norm(ends[1] - ends[0], axis=1).max())
        poses = shutter_poses(hand.pose_at, way_px, at_s=at_s, opening_s=SHUTTER_S)
        now = BASE if number < undisturbed_images else condition
        yield at_s, scene_at(rig, face, now, poses, seed=seed, image_number=number)
