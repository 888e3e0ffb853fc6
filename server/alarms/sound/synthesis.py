"""Samples and WAV files of the alarm sounds."""

import io
import wave
from functools import cache

import numpy as np
import numpy.typing as npt

from server.alarms.sound.burst import BURSTS, RATE_HZ, Burst
from tracker.navigation.alarms import Priority

# Amplitudes of the fundamental and its harmonics. They are within 10 dB of each other, because small
# loudspeakers lack low frequencies and elderly listeners do not hear high ones.
HARMONICS = (1.0, 0.8, 0.65, 0.5, 0.4, 0.32)
PEAK = 0.8
LARGEST_SAMPLE = 32767


def samples_of(burst: Burst) -> npt.NDArray[np.float64]:
    """Return one burst as samples between -1 and 1 at `RATE_HZ`."""
    pulse = _pulse(burst)
    parts = []
    for gap_s in burst.gaps_s:
        parts += [pulse, np.zeros(round(gap_s * RATE_HZ))]
    return np.concatenate([*parts, pulse])


@cache
def burst_wav(priority: Priority) -> bytes:
    """Return one burst of this priority as a WAV file, mono, 16 bit."""
    samples = np.rint(samples_of(BURSTS[priority]) * LARGEST_SAMPLE).astype("<i2")
    file = io.BytesIO()
    with wave.open(file, "wb") as written:
        written.setnchannels(1)
        written.setsampwidth(2)
        written.setframerate(RATE_HZ)
        written.writeframes(samples.tobytes())
    return file.getvalue()


def _pulse(burst: Burst) -> npt.NDArray[np.float64]:
    count = round(burst.pulse_s * RATE_HZ)
    time_s = np.arange(count) / RATE_HZ
    tone = np.zeros(count)
    for number, amplitude in enumerate(HARMONICS, start=1):
        # Different phases, so that the peaks of the harmonics do not coincide.
        phase = 0.7 * number * number
        tone += amplitude * np.sin(2.0 * np.pi * number * burst.fundamental_hz * time_s + phase)
    rise = round(burst.rise_s * RATE_HZ)
    envelope = np.minimum(1.0, np.minimum(np.arange(count) + 0.5, np.arange(count)[::-1] + 0.5) / rise)
    shaped = tone * envelope
    return np.asarray(shaped * (PEAK / np.abs(shaped).max()))
