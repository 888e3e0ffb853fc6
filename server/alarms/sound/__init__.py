"""The alarm sounds, made by arithmetic to the table that manuals quote of IEC 60601-1-8.

Each alarm is one buffer with its pause in it, looped by the browser's audio hardware: timers of a page
stall when it is busy or hidden, and the gaps of the table would not hold. A sound cannot change with the
distance.
"""

from server.alarms.sound.burst import BURSTS, RATE_HZ, Burst
from server.alarms.sound.synthesis import burst_wav, samples_of

__all__ = ["BURSTS", "RATE_HZ", "Burst", "burst_wav", "samples_of"]
