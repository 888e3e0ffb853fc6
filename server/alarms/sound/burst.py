"""Timing of the alarm sounds: number and length of the pulses, gaps, and repetition.

Pulses and gaps meet the table whether a pulse is measured above 90 % of its amplitude or where it is audible.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from tracker.navigation.alarms import Priority

RATE_HZ = 16_000


@dataclass(frozen=True, slots=True, kw_only=True)
class Burst:
    """One burst of pulses.

    Attributes:
        fundamental_hz: Fundamental frequency of the pulses.
        pulse_s: Length of a pulse, including its rise and fall.
        rise_s: Rise time of a pulse, equal to its fall time.
        gaps_s: Silence after each pulse except the last one.
        repeat_every_s: Time from the start of a burst to the start of the next one.
    """

    fundamental_hz: float
    pulse_s: float
    rise_s: float
    gaps_s: tuple[float, ...]
    repeat_every_s: float

    @property
    def length_s(self) -> float:
        """Time from the start of the first pulse to the end of the last one."""
        return self.pulse_s * (len(self.gaps_s) + 1) + sum(self.gaps_s)


# Three pulses and two pulses, separated by the longest gap that the table allows.
_FIVE_S = (0.052, 0.052, 0.076, 0.052)

BURSTS: Mapping[Priority, Burst] = MappingProxyType(
    {
        Priority.HIGH: Burst(
            fundamental_hz=523.25,
            pulse_s=0.184,
            rise_s=0.026,
            gaps_s=(*_FIVE_S, 0.5, *_FIVE_S),
            repeat_every_s=7.0,
        ),
        Priority.MEDIUM: Burst(
            fundamental_hz=440.0, pulse_s=0.224, rise_s=0.032, gaps_s=(0.14, 0.14), repeat_every_s=8.0
        ),
        Priority.LOW: Burst(
            fundamental_hz=349.23, pulse_s=0.224, rise_s=0.032, gaps_s=(0.16,), repeat_every_s=20.0
        ),
    }
)
