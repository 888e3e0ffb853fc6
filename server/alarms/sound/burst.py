"""What each alarm sound is: so many pulses, so long, so far apart, and when all comes again.

Lengths of pulses and gaps lie inside the table for each way of measuring them: where the sound is over nine
tenths of its height, and where there is any sound at all.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from tracker.navigation.alarms import Priority

RATE_HZ = 16_000


@dataclass(frozen=True, slots=True, kw_only=True)
class Burst:
    """One sound.

    Attributes:
        fundamental_hz: of every pulse.
        pulse_s: from the first to the last of a pulse.
        rise_s: of it, until it is at its full height, and the same at its end.
        gaps_s: silence after each pulse but the last; one more pulse than gaps.
        repeat_every_s: from the beginning of a burst to the beginning of the next one.
    """

    fundamental_hz: float
    pulse_s: float
    rise_s: float
    gaps_s: tuple[float, ...]
    repeat_every_s: float

    @property
    def length_s(self) -> float:
        """From its first pulse to the end of its last."""
        return self.pulse_s * (len(self.gaps_s) + 1) + sum(self.gaps_s)


# Three and two: the gap between them is longer, as far as the table allows.
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
