"""Hand motion along the channel: smoothed keyframes with sway and tremor."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from tracker.geometry import Array

CYCLE_S = 40.0
TABLE_HZ = 50
SMOOTHING_S = 0.3


class Phase(StrEnum):
    """Phase of the hand motion."""

    APPROACH = "approach"  # from above the bone towards the entry point
    ALIGN = "align"  # the burr on the entry point, the axis turned into the channel's
    DRILL = "drill"  # down the channel, with a hand's small deviations
    DRIFT = "drift"  # still in the bone, wandering off by millimetres and degrees
    WITHDRAW = "withdraw"  # back out along the channel
    AWAY = "away"  # out of the picture
    RETURN = "return"  # back into it
    CALIBRATE = "calibrate"  # the tip in a divot, or a board before the camera
    TOUCH = "touch"  # the tip rests on a landmark
    SWEEP = "sweep"  # the tip sweeps over the bone
    MOVE = "move"  # from one place on the bone to the next


PHASE_STARTS_S = (
    (0.0, Phase.APPROACH),
    (7.0, Phase.ALIGN),
    (11.5, Phase.DRILL),
    (22.0, Phase.DRIFT),
    (27.0, Phase.WITHDRAW),
    (31.0, Phase.AWAY),
    (36.0, Phase.RETURN),
)

# time s | across x mm, across y mm, depth mm | turn x deg, turn y deg, roll deg: of the drill against the
# channel, about its own axes at rest (x right in the picture, y towards the camera, z down the channel).
KEYFRAMES = np.array(
    [
        [0.0, 62.0, 8.0, -38.0, -6.0, -15.0, 12.0],
        [2.5, 24.0, 6.0, -27.0, -5.0, -8.0, 7.0],
        [5.0, 3.0, 1.5, -9.0, -2.5, -3.5, 3.0],
        [6.5, 0.8, 0.5, -1.0, -1.8, -1.6, 1.0],
        [8.0, 0.55, 0.35, -0.2, -1.4, 0.9, 0.0],
        [11.5, 0.5, 0.3, -0.1, -1.0, 0.7, -1.0],
        [14.0, 0.55, 0.35, 5.5, -0.8, -1.0, -2.0],
        [18.0, 0.35, -0.6, 16.0, 0.9, -1.0, 1.0],
        [21.5, 0.7, -0.35, 25.0, 1.1, 0.9, 2.0],
        [23.5, 2.6, -0.4, 28.5, -1.2, 4.0, 3.0],
        [25.0, 4.8, 0.8, 30.0, -2.0, 6.6, 4.0],
        [26.5, 4.2, 0.6, 28.5, -1.8, 5.6, 3.0],
        [29.0, 0.9, 0.3, -3.0, -2.0, 1.5, 0.0],
        [30.0, 16.0, 4.0, -24.0, -4.0, -4.0, -5.0],
        [32.0, 355.0, 30.0, -40.0, -8.0, -22.0, -12.0],
        [36.0, 355.0, 30.0, -40.0, -8.0, -22.0, -12.0],
        [38.5, 125.0, 14.0, -42.0, -7.0, -20.0, 14.0],
    ]
)

# Integer numbers of periods per cycle keep the motion periodic.
WOBBLE_TURNS = np.array([5, 9, 14, 22])
WOBBLE_SIZE = np.array([0.10, 0.08, 0.06, 0.03])
TREMOR_TURNS = np.array([327, 371, 411, 437])  # 8.2, 9.3, 10.3, 10.9 Hz
TREMOR_SIZE = np.array([0.035, 0.05, 0.045, 0.03])


@dataclass(frozen=True, slots=True, kw_only=True)
class Pose6:
    """Drill pose relative to the channel.

    Attributes:
        across_mm: (2,) of the tip, along the drill's x and y at rest.
        depth_mm: of the tip along the channel, negative outside.
        rotation_deg: (3,) rotation vector about the drill's x, y, z at rest.
    """

    across_mm: Array
    depth_mm: float
    rotation_deg: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Script:
    """Keyframes and variation of a hand motion.

    Attributes:
        keyframes: (n, 7), as `KEYFRAMES`.
        phases: start time of each phase.
        sway_ratio: amplitude of the sway.
        shake_ratio: amplitude of the tremor.
        variety_ratio: variation by the seed of the path through the air.
    """

    keyframes: Array
    phases: tuple[tuple[float, Phase], ...]
    sway_ratio: float = 1.0
    shake_ratio: float = 1.0
    variety_ratio: float = 1.0


WANDERING = Script(keyframes=KEYFRAMES, phases=PHASE_STARTS_S)


class Hand:
    """A hand that repeats a cycle of 40 seconds, varied by the seed."""

    def __init__(self, seed: int, script: Script = WANDERING) -> None:
        random = np.random.default_rng([seed, 0x48414E44])
        self.cycle_s = CYCLE_S
        self._phases = script.phases
        self._table = _smooth_table(_varied(script.keyframes, random, script.variety_ratio))
        sway = WOBBLE_SIZE * random.uniform(0.7, 1.3, (6, 4)) * script.sway_ratio
        shake = TREMOR_SIZE * random.uniform(0.7, 1.3, (6, 4)) * script.shake_ratio
        # A pressing hand is steadier along the drill's axis than across it; roll is least steady.
        shake[2] *= 0.5
        sway[3:5] *= 2.5
        sway[5] *= 6.0
        self._sizes = np.concatenate([sway, shake], axis=1)
        self._rates = 2.0 * np.pi / CYCLE_S * np.concatenate([WOBBLE_TURNS, TREMOR_TURNS])
        self._offsets = random.uniform(0.0, 2.0 * np.pi, (6, 8))

    def at(self, at_s: float) -> Pose6:
        """Return the drill pose at this time."""
        time_s = at_s % CYCLE_S
        slow = catmull_rom(self._table, time_s * TABLE_HZ)
        values = slow + (self._sizes * np.sin(self._rates * time_s + self._offsets)).sum(axis=1)
        return Pose6(across_mm=values[:2], depth_mm=float(values[2]), rotation_deg=values[3:])

    def phase_at(self, at_s: float) -> Phase:
        """Return the phase of the motion at this time."""
        time_s = at_s % CYCLE_S
        return [phase for start_s, phase in self._phases if start_s <= time_s][-1]

    def touched_at(self, _at_s: float) -> str:
        """Return an empty name: the tip rests on no landmark."""
        return ""


def _varied(keyframes: Array, random: np.random.Generator, ratio: float) -> Array:
    """Return keyframes varied by the seed, most in free air."""
    out = keyframes.copy()
    room = ratio * np.clip(-out[:, 3] / 60.0, 0.0, 1.0)[:, None]
    out[:, 1:4] += room * random.normal(0.0, 5.0, (len(out), 3))
    out[:, 4:7] += room * random.normal(0.0, 2.0, (len(out), 3))
    return out


def _smooth_table(keyframes: Array) -> Array:
    """Return the keyframes as a smooth periodic table (cycle x 50 Hz, 6)."""
    count = int(CYCLE_S * TABLE_HZ)
    times = np.arange(count) / TABLE_HZ
    columns = [np.interp(times, keyframes[:, 0], keyframes[:, i], period=CYCLE_S) for i in range(1, 7)]
    away = np.minimum(times, CYCLE_S - times)
    kernel = np.exp(-0.5 * (away / SMOOTHING_S) ** 2)
    spectrum = np.fft.rfft(kernel / kernel.sum())
    return np.stack([np.fft.irfft(np.fft.rfft(column) * spectrum, n=count) for column in columns], axis=1)


def catmull_rom(table: Array, position: float) -> Array:
    """Interpolate a periodic table with continuous velocity (Catmull-Rom spline)."""
    row = int(np.floor(position))
    f = position - row
    a, b, c, d = (table[(row + i) % len(table)] for i in (-1, 0, 1, 2))
    slope = 0.5 * (c - a) + f * (a - 2.5 * b + 2.0 * c - 0.5 * d + f * (0.5 * (d - a) + 1.5 * (b - c)))
    return np.asarray(b + f * slope, dtype=np.float64)
