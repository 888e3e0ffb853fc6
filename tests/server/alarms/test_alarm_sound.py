"""The sound samples compared with the table of alarms.md: pulses, gaps, rise, tone, level."""

import io
import itertools
import wave
from dataclasses import dataclass

import numpy as np
import pytest
import scipy

from server.alarms.sound import BURSTS, burst_wav
from tracker.navigation.alarms import Priority


@dataclass(frozen=True, slots=True, kw_only=True)
class Allowed:
    pulses: tuple[int, ...]
    pulse_ms: tuple[float, float]
    gap_ms: tuple[float, float]
    again_s: tuple[float, float]


TABLE = {
    Priority.HIGH: Allowed(pulses=(10,), pulse_ms=(75, 200), gap_ms=(50, 125), again_s=(2.5, 15)),
    Priority.MEDIUM: Allowed(pulses=(3,), pulse_ms=(125, 250), gap_ms=(125, 250), again_s=(2.5, 30)),
    Priority.LOW: Allowed(pulses=(1, 2), pulse_ms=(125, 250), gap_ms=(125, 250), again_s=(15.001, 60)),
}


def heard(priority: Priority) -> tuple[np.ndarray, int]:
    with wave.open(io.BytesIO(burst_wav(priority))) as file:
        assert (file.getnchannels(), file.getsampwidth()) == (1, 2)
        rate_hz = file.getframerate()
        samples = np.frombuffer(file.readframes(file.getnframes()), dtype="<i2") / 32768.0
    return samples, rate_hz


def envelope_of(samples: np.ndarray, rate_hz: int, fundamental_hz: float) -> np.ndarray:
    """Level of the tone without its ripple: power of the analytic signal over two periods."""
    power = np.abs(scipy.signal.hilbert(np.concatenate([np.zeros(2000), samples, np.zeros(2000)]))) ** 2
    width = round(2 * rate_hz / fundamental_hz)
    smooth = np.convolve(power, np.ones(width) / width, mode="same")[2000:-2000]
    return np.sqrt(smooth)


def runs(above: np.ndarray) -> list[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate([[0], above.astype(int), [0]])))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))


@pytest.mark.parametrize("level", [0.1, 0.5, 0.9], ids=lambda level: f"measured at {level:.0%}")
@pytest.mark.parametrize("priority", Priority)
def test_pulses_and_gaps_are_those_of_the_table(priority: Priority, level: float) -> None:
    samples, rate_hz = heard(priority)
    envelope, allowed = envelope_of(samples, rate_hz, BURSTS[priority].fundamental_hz), TABLE[priority]
    pulses = runs(envelope > level * np.median(envelope[envelope > 0.5 * envelope.max()]))
    assert len(pulses) in allowed.pulses
    lengths_ms = [(end - start) / rate_hz * 1e3 for start, end in pulses]
    assert all(allowed.pulse_ms[0] <= length <= allowed.pulse_ms[1] for length in lengths_ms), lengths_ms
    gaps_ms = [(b[0] - a[1]) / rate_hz * 1e3 for a, b in itertools.pairwise(pulses)]
    if priority is Priority.HIGH:
        between = gaps_ms.pop(4)
        assert 350 <= between <= 1300
        assert min(gaps_ms[2], gaps_ms[6]) > max(gaps_ms[:2] + gaps_ms[3:6] + gaps_ms[7:]) + 15, "3 + 2"
    assert all(allowed.gap_ms[0] <= gap <= allowed.gap_ms[1] for gap in gaps_ms), gaps_ms


@pytest.mark.parametrize("priority", Priority)
def test_bursts_repeat_as_in_the_table(priority: Priority) -> None:
    samples, rate_hz = heard(priority)
    min_s, max_s = TABLE[priority].again_s
    every_s, length_s = BURSTS[priority].repeat_every_s, len(samples) / rate_hz
    assert min_s <= every_s - length_s < every_s <= max_s
    assert length_s == pytest.approx(BURSTS[priority].length_s, abs=1e-3)


@pytest.mark.parametrize("priority", Priority)
def test_pulses_rise_in_their_share_of_the_pulse(priority: Priority) -> None:
    burst = BURSTS[priority]
    assert 0.10 <= burst.rise_s / burst.pulse_s <= 0.20, "from nothing to full, of the whole pulse"
    samples, rate_hz = heard(priority)
    count = round(burst.pulse_s * rate_hz)
    peaks = np.array([np.abs(part).max() for part in np.array_split(samples[:count], 60)])
    top = np.median(peaks[20:40])
    rising_s = (np.argmax(peaks > 0.9 * top) - np.argmax(peaks > 0.1 * top)) * burst.pulse_s / 60
    lasting_s = (60 - np.argmax(peaks[::-1] > 0.9 * top) - np.argmax(peaks > 0.9 * top)) * burst.pulse_s / 60
    assert 0.10 <= rising_s / lasting_s <= 0.20


@pytest.mark.parametrize("priority", Priority)
def test_the_tone_has_four_harmonics_that_are_all_heard(priority: Priority) -> None:
    samples, rate_hz = heard(priority)
    burst = BURSTS[priority]
    count = round(burst.pulse_s * rate_hz)
    spectrum = np.abs(np.fft.rfft(samples[:count] * np.hanning(count), n=2**16))
    frequency_hz = np.fft.rfftfreq(2**16, 1 / rate_hz)
    strongest = spectrum.max()
    assert 150 <= burst.fundamental_hz <= 1000
    loud = []
    for number in range(1, 12):
        near = np.abs(frequency_hz - number * burst.fundamental_hz) < 0.25 * burst.fundamental_hz
        level_db = 20 * np.log10(spectrum[near].max() / strongest)
        peak_hz = frequency_hz[near][np.argmax(spectrum[near])]
        if level_db >= -15 and 300 <= peak_hz <= 4000:
            loud.append(number)
            assert peak_hz == pytest.approx(number * burst.fundamental_hz, abs=5)
    assert len([number for number in loud if number > 1]) >= 4, "harmonics beside the fundamental"
    assert 1 in loud


@pytest.mark.parametrize("priority", Priority)
def test_pulses_are_equally_loud_and_none_is_clipped(priority: Priority) -> None:
    samples, rate_hz = heard(priority)
    envelope = envelope_of(samples, rate_hz, BURSTS[priority].fundamental_hz)
    heights = [envelope[start:end].max() for start, end in runs(envelope > 0.5 * envelope.max())]
    assert 20 * np.log10(max(heights) / min(heights)) < 10
    assert 0.5 < np.abs(samples).max() < 0.9


def test_priorities_are_distinguished_by_ear() -> None:
    assert len({burst.fundamental_hz for burst in BURSTS.values()}) == 3
    assert len({len(burst.gaps_s) for burst in BURSTS.values()}) == 3
