"""Detect mains flicker of lamps in camera images by a matched filter.

A lamp on mains current flickers at 100 Hz (50 Hz mains) or 120 Hz (60 Hz mains). With a rolling shutter this
appears as bands that travel over the rows from image to image, with a global shutter as a brightness that
beats with the image rate. Both are one wave, `cos(2 pi (f t + k v))` with the time `t` of an image, the
place `v` of a row (0..1) and `k` cycles over the image (0 of a global shutter). Motion in
front of the camera is distinguished by its location: flicker has the same wave in every part of the image.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

MAINS_HZ = (50, 60)

# Grid of the stored mean values of an image, and the number of sampled rows and pixels per cell.
BANDS, STRIPS, ROWS_A_BAND, PIXELS_A_STRIP = 32, 4, 2, 64
# Parts of the image that must show the same wave: strips x row groups.
ROW_GROUPS = 4
CELLS_A_GROUP = BANDS // ROW_GROUPS

# | threshold | unit | source | what breaks when it moves |
# |---|---|---|---|
# | WINDOW_S | s | three segments that each resolve 1.5 Hz | shorter: a slow motion counts as a beat |
# | SEGMENTS | 1 | mains drift within one stays under half a turn | fewer: an off-frequency grid is missed |
# | MIN_BEAT_HZ | Hz | main lobe of one segment's Hann window | lower: slow changes count as flicker |
# | MAINS_ERROR_HZ | Hz | twice a grid's normal +-0.2 Hz, twice as fast | lower: an island grid is missed |
# | MIN_DEPTH_RATIO | 1 | a few times an image's noise | lower: reported where nothing is to be gained |
# | CLEARS_AT_RATIO | 1 | hysteresis of MIN_DEPTH_RATIO | higher: the advisory comes and goes |
# | MIN_LINE_RATIO | 1 | power over the strongest neighbouring frequency | lower: motion counts as flicker |
# | MIN_AGREEMENT | 1 | sum over parts as vectors / as lengths | lower: a moving hand counts as flicker |
# | MIN_PART_RATIO, MIN_PARTS_RATIO | 1 | a part's wave / the mean; share of such parts | lower: likewise |
# | DARK_LEVEL, FULL_LEVEL | levels | black noise; a full pixel shows no wave | - |
WINDOW_S, SEGMENTS = 4.2, 3
MIN_BEAT_HZ, MAINS_ERROR_HZ = 1.5, 0.8
MIN_DEPTH_RATIO, CLEARS_AT_RATIO = 0.01, 0.006
MIN_LINE_RATIO, MIN_AGREEMENT = 8.0, 0.85
MIN_PART_RATIO, MIN_PARTS_RATIO = 0.4, 0.8
DARK_LEVEL, FULL_LEVEL = 8.0, 245.0
MIN_PARTS = 8
MIN_IMAGES_A_SEGMENT = 12
MAX_CYCLES = 8.0
CYCLE_STEP = 0.1
HZ_STEP = 0.2
NEIGHBOURS_HZ = np.array([2.4, 2.8, 3.2, 3.6, 4.0])


class FlickerState(StrEnum):
    """Result of flicker detection over a window of images."""

    FLICKERS = "flickers"
    STEADY = "steady"
    UNSURE = "unsure"  # the scene moves too much, is too dark, or the bands would stand still


@dataclass(frozen=True, slots=True, kw_only=True)
class LampFlicker:
    """Detected lamp flicker.

    Attributes:
        mains_hz: 50 or 60; both where images at this rate cannot distinguish them.
        depth_ratio: (brightest - darkest) / (brightest + darkest) of the wave in the image's levels.
    """

    mains_hz: tuple[int, ...]
    depth_ratio: float


@dataclass(frozen=True, slots=True, kw_only=True)
class FlickerVerdict:
    """Result of flicker detection; `flicker` is set where the state is FLICKERS."""

    state: FlickerState
    flicker: LampFlicker | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class _Wave:
    power: float
    depth_ratio: float
    floor_ratio: float
    is_a_lamp: bool


UNSURE = FlickerVerdict(state=FlickerState.UNSURE)


def brightness_grid(image: npt.NDArray[np.uint8]) -> Array:
    """Return mean grey levels (32, 4) of a grid of bands and strips, from a subsample of the image."""
    height, width = image.shape[:2]
    rows, columns = BANDS * ROWS_A_BAND, STRIPS * PIXELS_A_STRIP
    row_step, column_step = max(height // rows, 1), max(width // columns, 1)
    # The green channel, which has most pixels on a sensor with a Bayer pattern.
    channel = image if image.ndim == 2 else image[:, :, 1]
    sampled = channel[row_step // 2 :: row_step, column_step // 2 :: column_step][:rows, :columns]
    if sampled.shape != (rows, columns):
        return np.full((BANDS, STRIPS), np.nan)
    cells = sampled.reshape(BANDS, ROWS_A_BAND, STRIPS, PIXELS_A_STRIP)
    return np.asarray(cells.mean(axis=(1, 3), dtype=np.float64))


def detect_flicker(times_s: Sequence[float], means: Sequence[Array]) -> FlickerVerdict:
    """Detect lamp flicker in a window of images.

    A beat under 1.5 Hz, or as near to half the image rate, is not observable: the bands stand still (60 Hz at
    30 images/s, 50 Hz at 25). Such a pair of mains and rate counts as steady where the other is observable.

    Args:
        times_s: capture times, in order, over about `WINDOW_S`.
        means: `brightness_grid` of each image.
    """
    at_s = np.asarray(times_s) - times_s[0]
    levels = np.asarray(means)
    used = np.asarray((levels > DARK_LEVEL).all(axis=0) & (levels < FULL_LEVEL).all(axis=0))
    parts = _parts(used)
    segments = np.array_split(np.arange(len(at_s)), SEGMENTS)
    if len(parts) < MIN_PARTS or min(len(one) for one in segments) < MIN_IMAGES_A_SEGMENT:
        return UNSURE
    wave = np.where(used, np.log(np.where(used, levels, 1.0)), 0.0).reshape(len(at_s), -1)
    rate_hz = 1.0 / float(np.median(np.diff(at_s)))
    waves = {
        mains: _wave(at_s, wave, segments, parts, 2.0 * mains, rate_hz)
        for mains in MAINS_HZ
        if _is_seen(2.0 * mains, rate_hz)
    }
    if not waves:
        return UNSURE
    lamps = {mains: one for mains, one in waves.items() if one.is_a_lamp}
    if lamps:
        strongest = max(lamps.values(), key=lambda one: one.power)
        return FlickerVerdict(
            state=FlickerState.FLICKERS,
            flicker=LampFlicker(
                mains_hz=tuple(mains for mains, one in lamps.items() if one.power > 0.5 * strongest.power),
                depth_ratio=strongest.depth_ratio,
            ),
        )
    is_quiet = all(one.floor_ratio < MIN_DEPTH_RATIO for one in waves.values())
    return FlickerVerdict(state=FlickerState.STEADY) if is_quiet else UNSURE


def _is_seen(light_hz: float, rate_hz: float) -> bool:
    beat_hz = abs(light_hz - rate_hz * round(light_hz / rate_hz))
    return MIN_BEAT_HZ <= beat_hz <= 0.5 * rate_hz - MIN_BEAT_HZ


def _parts(used: npt.NDArray[np.bool_]) -> list[npt.NDArray[np.intp]]:
    """Return the cells (flat indexes) of each part of the image that is neither dark nor saturated."""
    index = np.arange(BANDS * STRIPS).reshape(BANDS, STRIPS)
    parts = []
    for group in range(ROW_GROUPS):
        rows = slice(group * CELLS_A_GROUP, (group + 1) * CELLS_A_GROUP)
        for strip in range(STRIPS):
            cells = index[rows, strip][used[rows, strip]]
            if len(cells) >= CELLS_A_GROUP // 2:
                parts.append(cells)
    return parts


def _wave(
    at_s: Array,
    levels: Array,
    segments: Sequence[npt.NDArray[np.intp]],
    parts: Sequence[npt.NDArray[np.intp]],
    light_hz: float,
    rate_hz: float,
) -> _Wave:
    """Return the strongest wave near this frequency, and whether it is lamp flicker."""
    cells = np.concatenate(parts)
    rows = (np.arange(BANDS * STRIPS) // STRIPS + 0.5) / BANDS
    max_cycles = min(light_hz / rate_hz, MAX_CYCLES)
    steps = int(max_cycles / CYCLE_STEP)
    cycles = CYCLE_STEP * np.arange(-steps, steps + 1)
    unrolled = np.exp(-2j * np.pi * cycles[:, None] * rows[None, cells]) / len(cells)

    def seen_at(hz: Array) -> npt.NDArray[np.complex128]:
        """Return the amplitudes (segments, frequencies, cells)."""
        return np.array([_amplitudes(at_s[one], levels[one], hz) for one in segments])

    tried_hz = light_hz + np.arange(-MAINS_ERROR_HZ, MAINS_ERROR_HZ + 0.5 * HZ_STEP, HZ_STEP)
    seen = seen_at(tried_hz)
    power = (np.abs(seen[:, :, cells] @ unrolled.T) ** 2).sum(axis=0)
    best_hz, best_cycles = np.unravel_index(int(power.argmax()), power.shape)
    near_hz = np.concatenate([tried_hz[best_hz] - NEIGHBOURS_HZ, tried_hz[best_hz] + NEIGHBOURS_HZ])
    # Beyond half the image rate and below its multiples lie aliases of the tested frequencies.
    near_hz = near_hz[[_is_seen(float(hz), rate_hz) for hz in near_hz]]
    around = (np.abs(seen_at(near_hz)[:, :, cells] @ unrolled.T) ** 2).sum(axis=0)
    floor = float(around.max()) if around.size else np.inf
    derotated = seen[:, best_hz, :] * np.exp(-2j * np.pi * cycles[best_cycles] * rows)
    depth_ratio, is_uniform = _amplitude_and_agreement(derotated, parts)
    strongest = float(power[best_hz, best_cycles])
    return _Wave(
        power=strongest,
        depth_ratio=depth_ratio,
        floor_ratio=float(np.sqrt(MIN_LINE_RATIO * floor / len(segments))),
        is_a_lamp=is_uniform and strongest >= MIN_LINE_RATIO * floor,
    )


def _amplitudes(at_s: Array, levels: Array, hz: Array) -> npt.NDArray[np.complex128]:
    """Return complex amplitudes (frequencies, cells) of relative brightness, with a Hann window in time."""
    place = (at_s - at_s[0]) / (at_s[-1] - at_s[0])
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * place)
    window /= window.sum()
    varying = levels - window @ levels
    return np.asarray(2.0 * (window * np.exp(-2j * np.pi * hz[:, None] * at_s)) @ varying)


def _amplitude_and_agreement(
    derotated: npt.NDArray[np.complex128], parts: Sequence[npt.NDArray[np.intp]]
) -> tuple[float, bool]:
    """Return the wave's amplitude from (segments, cells) without its travel, and whether all parts agree."""
    of_parts = np.array([derotated[:, cells].mean(axis=1) for cells in parts]).T
    of_segments = of_parts.mean(axis=1)
    sizes = np.abs(of_segments)
    along = np.real(of_parts * np.conj(of_segments)[:, None] / np.maximum(sizes, 1e-12)[:, None]).mean(axis=0)
    mean = float(sizes.mean())
    agreement = len(parts) * float(sizes.sum()) / max(float(np.abs(of_parts).sum()), 1e-12)
    is_uniform = (
        agreement >= MIN_AGREEMENT and float((along >= MIN_PART_RATIO * mean).mean()) >= MIN_PARTS_RATIO
    )
    return mean, is_uniform


class FlickerMonitor:
    """Detects flicker in successive windows of images. Times are those of the images.

    A result is valid until a later window differs; an uncertain window changes nothing.

    Args:
        rest_s: pause between two windows; lamps change only when they are switched.
    """

    def __init__(self, *, rest_s: float = 15.0) -> None:
        self._rest_s = rest_s
        self._begins_at_s = -np.inf
        self._times_s: list[float] = []
        self._means: list[Array] = []
        self._flicker: LampFlicker | None = None

    @property
    def flicker(self) -> LampFlicker | None:
        """Return the last detected flicker; None where the light was steady, or before the first window."""
        return self._flicker

    def take(self, image: npt.NDArray[np.uint8], at_s: float) -> None:
        """Add an image (h, w) or (h, w, 3) captured at this time."""
        if at_s < self._begins_at_s:
            return
        if self._times_s and not 0.0 < at_s - self._times_s[-1] < 0.5:
            # After a pause or a change of the clock, discard the window.
            self._times_s, self._means = [], []
        self._times_s.append(at_s)
        self._means.append(brightness_grid(image))
        if at_s - self._times_s[0] < WINDOW_S:
            return
        verdict = detect_flicker(self._times_s, self._means)
        self._times_s, self._means, self._begins_at_s = [], [], at_s + self._rest_s
        limit = CLEARS_AT_RATIO if self._flicker is not None else MIN_DEPTH_RATIO
        if verdict.flicker is not None and verdict.flicker.depth_ratio >= limit:
            self._flicker = verdict.flicker
        elif verdict.state is not FlickerState.UNSURE:
            self._flicker = None
