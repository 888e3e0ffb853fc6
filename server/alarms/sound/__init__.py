"""Synthesis of the alarm sounds, with the timing that manuals quote from IEC 60601-1-8.

Each alarm is one buffer that includes its pause and is looped by the browser's audio hardware. Timers of a
page stall when it is busy or hidden, and could not keep the specified gaps. A sound does not change with the
distance to the wall.
"""

from server.alarms.sound.burst import BURSTS, RATE_HZ, Burst
from server.alarms.sound.synthesis import burst_wav, samples_of

__all__ = ["BURSTS", "RATE_HZ", "Burst", "burst_wav", "samples_of"]
