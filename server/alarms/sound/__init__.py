"""The alarm sounds, made by arithmetic to the table that manuals quote of IEC 60601-1-8."""

from server.alarms.sound.burst import BURSTS, RATE_HZ, Burst
from server.alarms.sound.synthesis import burst_wav, samples_of

__all__ = ["BURSTS", "RATE_HZ", "Burst", "burst_wav", "samples_of"]
