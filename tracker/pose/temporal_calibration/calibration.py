"""Calibrate the constant time offset between two sources that recorded the same motion."""

from dataclasses import dataclass, replace
from math import hypot

import numpy as np
import numpy.typing as npt
import scipy

from tracker.geometry import Array
from tracker.pose.temporal_calibration.correlation import Moments, correlation_ratio
from tracker.pose.temporal_calibration.limits import TimeOffsetLimits
from tracker.pose.temporal_calibration.rejections import (
    reject_ambiguous,
    reject_another_motion,
    reject_at_search_limit,
    reject_change,
    reject_positions_only,
    reject_short_overlap,
    reject_uncertain,
    reject_unfit_source,
    reject_uniform_motion,
)
from tracker.pose.temporal_calibration.series import Motion, PoseSeries, RateSignal, rate_signal

# Sampling of both signals. Each is shifted by half of the offset, so that swapping the sources only changes
# the sign of the result. The search uses every second step, six per shortest period that passes the low-pass.
STEP_S = 0.02
OFFSET_TOLERANCE_S = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class TimeOffset:
    """Offset between two sources' clocks.

    Attributes:
        offset_s: time stamp of the first source minus that of the second, for the same instant. Positive: the
            first stamps later. A time of the second source plus the offset is a time of the first.
        sd_s: standard deviation of the offset, by the jackknife over blocks of time.
        correlation_ratio: correlation of the rates at this offset.
        second_peak_ratio: ratio of the second highest peak within the search to this correlation.
        overlap_s: time for which both sources recorded the motion.
        change_s: offset of the second half minus that of the first.
        motion: the rates that were compared.
        variation: (2,) RMS of each source's rate about its mean, deg/s or mm/s.
        samples: (2,) number of poses used of each source.
        segments: (2,) number of intervals without a gap.
        rates_hz: (2,) pose rate of each source.
    """

    offset_s: float
    sd_s: float
    correlation_ratio: float
    second_peak_ratio: float
    overlap_s: float
    change_s: float
    motion: Motion
    variation: tuple[float, float]
    samples: tuple[int, int]
    segments: tuple[int, int]
    rates_hz: tuple[float, float]


def calibrate_time_offset(
    first: PoseSeries,
    second: PoseSeries,
    *,
    motion: Motion = Motion.ROTATION,
    limits: TimeOffsetLimits | None = None,
) -> TimeOffset:
    """Return the offset between the clocks of two sources, from a motion that both recorded.

    The rates of both are correlated over all offsets up to `limits.max_offset_s`, and the best one is refined
    by least squares. Frames, sampling and, with `Motion.ROTATION`, the tracked points may differ.

    Raises:
        InvalidInput: TIME_OFFSET_NEEDS_ROTATIONS.
        CalibrationError: the motion does not determine the offset; see `rejections.py` for the codes.
    """
    limits = limits or TimeOffsetLimits()
    reject_positions_only((first, second), motion)
    a, b = (rate_signal(series, motion, limits) for series in (first, second))
    for signal in (a, b):
        reject_unfit_source(signal, limits)
    search = _search(a, b, limits)
    for signal, rms in ((a, search.rms_a), (b, search.rms_b)):
        reject_uniform_motion(signal.name, rms, motion, limits)
    both = _Both.around(a, b, search)
    offset_s = both.best_s()
    peak_ratio = both.ratio_at(offset_s)
    reject_another_motion(peak_ratio, offset_s, limits)
    reject_at_search_limit(search.peak_s, search.at_limit, limits)
    reject_ambiguous(search.peak_s, search.second_s, search.second_peak_ratio, limits)
    sd_s = both.jackknife_sd_s(offset_s, limits.block_s)
    reject_uncertain(offset_s, sd_s, limits)
    change_s, change_sd_s = both.change_s(limits.block_s)
    reject_change(change_s, change_sd_s, limits)
    return TimeOffset(
        offset_s=offset_s,
        sd_s=sd_s,
        correlation_ratio=peak_ratio,
        second_peak_ratio=search.second_peak_ratio,
        overlap_s=len(both.times_s) * STEP_S,
        change_s=change_s,
        motion=motion,
        variation=(search.rms_a[1], search.rms_b[1]),
        samples=(a.samples, b.samples),
        segments=(a.segments, b.segments),
        rates_hz=(a.rate_hz, b.rate_hz),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Search:
    """The correlation over the offsets of the search window.

    Attributes:
        times_s: (n,) mean of both clocks at which both signals are defined at the peak.
        peak_s: offset of the highest peak.
        at_limit: whether that is the first or last offset of the window.
        second_s, second_peak_ratio: offset of the second peak and its ratio to the highest; 0 if there is
            none.
        rms_a, rms_b: (2,) RMS rate of each source at the peak, and RMS about its mean.
    """

    times_s: Array
    peak_s: float
    at_limit: bool
    second_s: float
    second_peak_ratio: float
    rms_a: tuple[float, float]
    rms_b: tuple[float, float]


def _search(a: RateSignal, b: RateSignal, limits: TimeOffsetLimits) -> _Search:
    """Compute the correlation at every even number of steps within the window.

    Raises:
        CalibrationError: TIME_OFFSET_OVERLAP_SHORT.
    """
    start_s, end_s = max(a.span_s[0], b.span_s[0]), min(a.span_s[1], b.span_s[1])
    reject_short_overlap(a, b, end_s - start_s, limits)
    reach = round(limits.max_offset_s / 2.0 / STEP_S)
    shifts = np.arange(-reach, reach + 1)
    # Mean of both clocks, for all times at which both signals can be defined at one of the offsets.
    grid_s = np.arange(start_s - reach * STEP_S, end_s + (reach + 1) * STEP_S, STEP_S)
    wide_s = grid_s[0] + STEP_S * np.arange(-reach, len(grid_s) + reach)
    wide_a, wide_b = a.at(wide_s), b.at(wide_s)

    def shifted(shift: int) -> tuple[Array, Array, npt.NDArray[np.bool_]]:
        """Return both rates (n, 3) shifted by a number of steps, and the mask where both are defined."""
        one = wide_a[reach + shift : len(wide_a) - reach + shift]
        other = wide_b[reach - shift : len(wide_b) - reach - shift]
        return one, other, np.isfinite(one[:, 0]) & np.isfinite(other[:, 0])

    moments = []
    for shift in shifts.tolist():
        one, other, seen = shifted(shift)
        reject_short_overlap(a, b, float(seen.sum()) * STEP_S, limits)
        moments.append(Moments.of(one[seen], other[seen]))
    offsets_s = 2.0 * STEP_S * shifts
    ratio = correlation_ratio(Moments(*map(np.array, zip(*moments, strict=True))))
    peak = int(np.argmax(ratio))
    padded = np.concatenate([[-np.inf], ratio, [-np.inf]])
    is_peak = (ratio >= padded[:-2]) & (ratio >= padded[2:])
    is_peak[peak] = False
    second = int(np.argmax(np.where(is_peak, ratio, -np.inf)))
    return _Search(
        times_s=grid_s[shifted(int(shifts[peak]))[2]],
        peak_s=float(offsets_s[peak]),
        at_limit=peak in {0, len(ratio) - 1},
        second_s=float(offsets_s[second]),
        second_peak_ratio=float(ratio[second] / ratio[peak]) if is_peak.any() else 0.0,
        rms_a=moments[peak].rms_a(),
        rms_b=moments[peak].rms_b(),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Both:
    """Both signals near one offset, at times at which both are defined for all offsets of the bracket."""

    a: RateSignal
    b: RateSignal
    times_s: Array
    centre_s: float

    @classmethod
    def around(cls, a: RateSignal, b: RateSignal, search: _Search) -> "_Both":
        """Return the signals near the peak of a search."""
        times_s = search.times_s
        for offset_s in (search.peak_s - 3.0 * STEP_S, search.peak_s + 3.0 * STEP_S):
            shifted = np.hstack([a.at(times_s + offset_s / 2.0), b.at(times_s - offset_s / 2.0)])
            times_s = times_s[np.isfinite(shifted).all(axis=1)]
        return cls(a=a, b=b, times_s=times_s, centre_s=search.peak_s)

    def change_s(self, block_s: float) -> tuple[float, float]:
        """Return the offset of the second half minus that of the first, and its standard deviation."""
        halves = [replace(self, times_s=times_s) for times_s in np.array_split(self.times_s, 2)]
        offsets_s = [half.best_s() for half in halves]
        sds_s = [
            half.jackknife_sd_s(offset_s, block_s) for half, offset_s in zip(halves, offsets_s, strict=True)
        ]
        return offsets_s[1] - offsets_s[0], hypot(*sds_s)

    def rates_at(self, offset_s: float) -> tuple[Array, Array]:
        """Return the rates (n, 3) of a, and of b at an offset."""
        return self.a.at(self.times_s + offset_s / 2.0), self.b.at(self.times_s - offset_s / 2.0)

    def ratio_at(self, offset_s: float) -> float:
        """Return the correlation at an offset."""
        return float(correlation_ratio(Moments.of(*self.rates_at(offset_s))))

    def best_s(self) -> float:
        """Return the offset of the largest correlation within two steps of the search."""
        found = scipy.optimize.minimize_scalar(
            lambda offset_s: -self.ratio_at(offset_s),
            bounds=(self.centre_s - 2.0 * STEP_S, self.centre_s + 2.0 * STEP_S),
            method="bounded",
            options={"xatol": OFFSET_TOLERANCE_S},
        )
        return float(found.x)

    def jackknife_sd_s(self, offset_s: float, block_s: float) -> float:
        """Return the standard deviation of the offset by the delete-one-block jackknife.

        Valid for errors whose correlation time is below a block. Infinite where the correlation has no
        maximum.
        """
        blocks = max(2, round(len(self.times_s) * STEP_S / block_s))
        left, middle, right = (
            correlation_ratio(Moments.of_blocks(*self.rates_at(offset_s + shift_s), blocks).without_each())
            for shift_s in (-STEP_S, 0.0, STEP_S)
        )
        curvature = left - 2.0 * middle + right
        if (curvature >= 0.0).any():
            return float("inf")
        summits_s = STEP_S * (left - right) / (2.0 * curvature)
        return float(np.sqrt((blocks - 1) * summits_s.var()))
