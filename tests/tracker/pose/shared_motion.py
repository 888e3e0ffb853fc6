"""A randomly moving tool, recorded by sources with their own clocks, frames and markers."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

from tracker.geometry import Array
from tracker.pose.temporal_calibration import PoseSeries

SECONDS = 12.0
# Times (n,) in s to orientations (n) and positions (n, 3) in mm of the tool in the room.
Movement = Callable[[Array], tuple[Rotation, Array]]


@dataclass(frozen=True, slots=True, kw_only=True)
class HandMotion:
    """Sums of sines with random rates: smooth, never at rest, and never periodic.

    Attributes:
        shift_mm: RMS of each coordinate.
        rotation_deg: RMS of each component of the rotation vector.
        rates_hz: slowest and fastest sine.

    """

    seed: int
    shift_mm: float = 15.0
    rotation_deg: float = 6.0
    rates_hz: tuple[float, float] = (0.2, 1.8)

    def __call__(self, times_s: Array) -> tuple[Rotation, Array]:
        """Pose of the tool."""
        random = np.random.default_rng(self.seed)
        rates = random.uniform(*self.rates_hz, size=(8, 6))
        starts = random.uniform(0.0, 2.0 * np.pi, size=(8, 6))
        # Larger motion is slower.
        sizes = 1.0 / rates / np.sqrt((rates**-2.0).sum(axis=0) / 2.0)
        waves = (sizes * np.sin(2.0 * np.pi * rates * times_s[:, None, None] + starts)).sum(axis=1)
        turned = Rotation.from_rotvec(np.radians(self.rotation_deg) * waves[:, 3:])
        return turned, self.shift_mm * waves[:, :3]


@dataclass(frozen=True, slots=True, kw_only=True)
class Source:
    """A camera or tracker that observes a marker on the tool.

    Attributes:
        rate_hz: of its images.
        late_s: offset of its timestamps from the true time.
        phase_s: time of its first image.
        arm_mm: position of the marker on the tool.
        shift_sd_mm, turn_sd_deg: noise of each component.
        unseen_ratio: share of images without the marker, at random.
        gaps_s: intervals without the marker.
        jitter_s: standard deviation of the image times, which are stamped truly.

    """

    seed: int
    rate_hz: float = 30.0
    late_s: float = 0.0
    phase_s: float = 0.0
    arm_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)
    shift_sd_mm: float = 0.3
    turn_sd_deg: float = 0.3
    unseen_ratio: float = 0.0
    gaps_s: tuple[tuple[float, float], ...] = field(default=())
    jitter_s: float = 0.0

    def record(self, motion: Movement, *, seconds: float = SECONDS) -> PoseSeries:
        """Record a motion."""
        random = np.random.default_rng(1000 + self.seed)
        times_s = np.arange(self.phase_s, seconds, 1.0 / self.rate_hz)
        times_s = times_s + self.jitter_s * random.uniform(-1.7, 1.7, size=len(times_s))
        seen = random.uniform(size=len(times_s)) >= self.unseen_ratio
        for start_s, end_s in self.gaps_s:
            seen &= (times_s < start_s) | (times_s > end_s)
        times_s = times_s[seen]
        turned, places_mm = motion(times_s)
        room = Rotation.random(random_state=self.seed)
        marker = Rotation.random(random_state=self.seed + 1)
        points_mm = places_mm + turned.apply(self.arm_mm)
        noise = random.normal(size=(2, len(times_s), 3))
        turned = Rotation.from_rotvec(np.radians(self.turn_sd_deg) * noise[0]) * room * turned * marker
        return PoseSeries(
            name=f"source {self.seed}",
            times_s=times_s + self.late_s,
            translations_mm=room.apply(points_mm) + np.array([0.0, 0.0, 500.0]) + self.shift_sd_mm * noise[1],
            rotations=turned.as_matrix(),
        )


def at_rest(times_s: Array) -> tuple[Rotation, Array]:
    """No motion."""
    return moved(np.zeros((len(times_s), 3)))


def steady(times_s: Array) -> tuple[Rotation, Array]:
    """Constant velocity: 31 deg/s and 81 mm/s."""
    return moved(np.outer(times_s, [1.0, 0.1, 0.0]))


def waving(period_s: float) -> Movement:
    """To and fro along one line, and about one axis."""
    return lambda times_s: moved(np.outer(np.sin(2.0 * np.pi * times_s / period_s), [0.6, 0.4, 0.0]))


def circling(period_s: float) -> Movement:
    """Rotation at constant speed: at any two times the motion differs by a rotation only."""

    def movement(times_s: Array) -> tuple[Rotation, Array]:
        angle = 2.0 * np.pi * times_s / period_s
        return moved(0.7 * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(len(angle))]))

    return movement


def moved(way: Array) -> tuple[Rotation, Array]:
    """A path (n, 3) as rotation vectors (30 deg per unit) and positions (80 mm per unit)."""
    return Rotation.from_rotvec(np.radians(30.0) * way), 80.0 * way
