"""Hand motion for tool calibration: pivoting and spinning with the tip in a divot."""

import numpy as np

from tracker.geometry import Array
from tracker.rehearsal.motion import CYCLE_S, Phase, Pose6

# Integer numbers of periods per cycle keep the motion periodic; different ones tilt the tool to all sides.
TILT_TURNS, TILT_DEG = (4, 7), (24.0, 26.0)
ROLL_TURNS, ROLL_DEG = 3, 10.0
SPIN_TURNS, SPIN_DEG = 3, 52.0
# Motion of a burr within the play of a divot.
REST_TURNS, REST_MM = np.array([311, 363, 407]), 0.015


class _CalibrationHand:
    """Base of the calibration motions: the tip rests in a divot."""

    cycle_s = CYCLE_S

    def __init__(self, seed: int) -> None:
        self._at_rest = _Rest(seed)

    def phase_at(self, _at_s: float) -> Phase:
        """Return the phase of the motion at this time."""
        return Phase.CALIBRATE

    def touched_at(self, _at_s: float) -> str:
        """Return an empty name: the tip rests on no landmark."""
        return ""


class PivotingHand(_CalibrationHand):
    """Pivot calibration: the tool tilts to all sides about its tip."""

    def at(self, at_s: float) -> Pose6:
        """Return the tool pose at this time."""
        turns = [
            size * np.sin(self._at_rest.phase(at_s, turns, start))
            for size, turns, start in zip(TILT_DEG, TILT_TURNS, (0, 1), strict=True)
        ]
        roll = ROLL_DEG * np.sin(self._at_rest.phase(at_s, ROLL_TURNS, 2))
        return self._at_rest.pose(at_s, np.array([*turns, roll]))


class SpinningHand(_CalibrationHand):
    """Axis calibration: the tool rotates back and forth about its own axis."""

    def at(self, at_s: float) -> Pose6:
        """Return the tool pose at this time."""
        roll = SPIN_DEG * np.sin(self._at_rest.phase(at_s, SPIN_TURNS, 0))
        wobble = [
            0.15 * np.sin(self._at_rest.phase(at_s, turns, start)) for turns, start in ((11, 1), (17, 2))
        ]
        return self._at_rest.pose(at_s, np.array([*wobble, roll]))


class _Rest:
    """A divot position, derived from the seed."""

    def __init__(self, seed: int) -> None:
        self._offsets = np.random.default_rng([seed, 0x5049564F]).uniform(0.0, 2.0 * np.pi, 6)

    def phase(self, at_s: float, turns: float, start: int) -> float:
        """Return the phase angle in rad of a component with `turns` periods per cycle."""
        return float(2.0 * np.pi * turns * at_s / CYCLE_S + self._offsets[start])

    def pose(self, at_s: float, rotation_deg: Array) -> Pose6:
        """Return the tool rotated about its tip, by a rotation vector applied after its roll."""
        rattle = REST_MM * np.sin(2.0 * np.pi * REST_TURNS * at_s / CYCLE_S + self._offsets[3:])
        return Pose6(across_mm=rattle[:2], depth_mm=float(rattle[2]), rotation_deg=rotation_deg)
