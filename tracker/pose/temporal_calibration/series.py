"""Recorded poses of one source, and their rates as a low-passed signal with gaps."""

from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

import numpy as np
import numpy.typing as npt
import scipy

from tracker.errors import InvalidInput
from tracker.geometry import Array
from tracker.pose.temporal_calibration.limits import TimeOffsetLimits

# A segment of six poses has five rates.
MIN_SEGMENT_SAMPLES = 6


class Motion(StrEnum):
    """The rate that is compared.

    ROTATION: angular velocity, deg/s. Equal for all markers on a rigid tool, up to the rotation between the
        two sources' frames.
    TRANSLATION: velocity, mm/s. Equal only for the same point of the tool.
    """

    ROTATION = "rotation"
    TRANSLATION = "translation"


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseSeries:
    """Poses of a moving body recorded by one source, without the times at which it was not seen.

    Attributes:
        name: name of the source in messages.
        times_s: (n,) increasing times on the source's own clock; steps may differ.
        translations_mm: (n, 3), a point of the body in the source's frame.
        rotations: (n, 3, 3), source from body; None where the source has positions only.
    """

    name: str
    times_s: Array
    translations_mm: Array
    rotations: Array | None = None

    def __post_init__(self) -> None:
        """Validate the shapes and the times.

        Raises:
            InvalidInput: TIME_SERIES_INVALID.
        """
        count = len(self.times_s)
        shapes = {"times_s": (count,), "translations_mm": (count, 3), "rotations": (count, 3, 3)}
        for field, shape in shapes.items():
            values = getattr(self, field)
            if values is None:
                continue
            if np.shape(values) != shape or not np.isfinite(values).all():
                raise self._invalid(f"{field} is not an array {shape} of finite numbers")
        steps_s = np.diff(self.times_s)
        if (steps_s <= 0.0).any():
            at = int(np.argmax(steps_s <= 0.0))
            raise self._invalid(
                f"the time after {self.times_s[at]:.6f} s is {self.times_s[at + 1]:.6f} s, which is not later"
            )

    def _invalid(self, what: str) -> InvalidInput:
        return InvalidInput(
            "TIME_SERIES_INVALID",
            f"{self.name}: {what}",
            "Give increasing times in seconds with one pose each, and omit times without a pose.",
            {"source": self.name, "series_problem": what},
        )

    def without_repeats(self) -> "PoseSeries":
        """Return the series without exact repeats of the previous pose, as after a loss of tracking."""
        parts = [self.translations_mm]
        if self.rotations is not None:
            parts.append(self.rotations.reshape(-1, 9))
        new = np.ones(len(self.times_s), dtype=np.bool_)
        new[1:] = (np.diff(np.hstack(parts), axis=0) != 0.0).any(axis=1)
        return PoseSeries(
            name=self.name,
            times_s=self.times_s[new],
            translations_mm=self.translations_mm[new],
            rotations=None if self.rotations is None else self.rotations[new],
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class RateSignal:
    """Rates of one source over its time, NaN in gaps and outside.

    Attributes:
        name: name of the source.
        samples: number of poses in segments.
        segments: number of intervals without a gap.
        rate_hz: pose rate from the median step.
        curve: piecewise cubic of time in s, (3,) in deg/s or mm/s; None if there is no segment.
    """

    name: str
    samples: int
    segments: int
    rate_hz: float
    curve: "scipy.interpolate.PPoly | None"

    def at(self, times_s: Array) -> Array:
        """Return the rates (n, 3) at times (n,)."""
        if self.curve is None:
            return np.full((len(times_s), 3), np.nan)
        return np.asarray(self.curve(times_s))

    @property
    def span_s(self) -> tuple[float, float]:
        """Return the first and the last time."""
        return (float(self.curve.x[0]), float(self.curve.x[-1])) if self.curve is not None else (0.0, 0.0)


def rate_signal(series: PoseSeries, motion: Motion, limits: TimeOffsetLimits) -> RateSignal:
    """Return the rates between successive poses, low-passed at `limits.cutoff_hz` without delay.

    A step is a gap if it is longer than half a period of the cut-off, up to which the low-pass interpolates
    anyway, and longer than the source's jitter. Each segment between gaps has its own spline.
    """
    fresh = series.without_repeats()
    steps_s = np.diff(fresh.times_s)
    median_s = float(np.median(steps_s)) if len(steps_s) else np.inf
    max_step_s = max(0.5 / limits.cutoff_hz, limits.max_step_ratio * median_s)
    cuts = np.flatnonzero(steps_s > max_step_s) + 1
    bounds = np.concatenate([[0], cuts, [len(fresh.times_s)]])
    curves = []
    samples = 0
    for start, end in pairwise(bounds.tolist()):
        if end - start >= MIN_SEGMENT_SAMPLES:
            curves.append(_curve(fresh, slice(start, end), motion, limits.cutoff_hz))
            samples += end - start
    return RateSignal(
        name=series.name,
        samples=samples,
        segments=len(curves),
        rate_hz=1.0 / median_s,
        curve=_joined(curves) if curves else None,
    )


def _curve(series: PoseSeries, part: slice, motion: Motion, cutoff_hz: float) -> "scipy.interpolate.PPoly":
    times_s = series.times_s[part]
    steps_s = np.diff(times_s)
    if motion is Motion.ROTATION and series.rotations is not None:
        # In the source's frame, the rates of two sources differ only by the constant rotation between the
        # frames.
        orientations = scipy.spatial.transform.Rotation.from_matrix(series.rotations[part])
        moved = np.degrees((orientations[1:] * orientations[:-1].inv()).as_rotvec())
    else:
        moved = np.diff(series.translations_mm[part], axis=0)
    rates = moved / steps_s[:, None]
    # With each rate weighted by its step, the smoothing spline is a zero-phase Butterworth low-pass with this
    # cut-off at any sampling, so both sources are filtered equally.
    penalty = (2.0 * np.pi * cutoff_hz) ** -4
    middles_s = (times_s[1:] + times_s[:-1]) / 2.0
    smoothed = smoothing_spline_values(middles_s, rates, weights=steps_s, penalty=penalty)
    return scipy.interpolate.CubicSpline(middles_s, smoothed, bc_type="natural", extrapolate=False)


def smoothing_spline_values(x: Array, y: Array, *, weights: Array, penalty: float) -> Array:
    """Return the values (n, k) at x (n,) of cubic smoothing splines of y (n, k), by Reinsch's equations.

    They minimise sum(weights * (y - f)^2) + penalty * integral(f''^2). SciPy's make_smoothing_spline computes
    the same column by column, many times slower.
    """
    steps = np.diff(x)
    count = len(x)
    below, above = 1.0 / steps[:-1], 1.0 / steps[1:]
    # Second divided differences, (n, n - 2), and the inner products of the second derivative's hat functions.
    differences = scipy.sparse.diags_array(
        [below, -below - above, above], offsets=[0, -1, -2], shape=(count, count - 2)
    )
    hats = scipy.sparse.diags_array(
        [steps[1:-1] / 6.0, (steps[:-1] + steps[1:]) / 3.0, steps[1:-1] / 6.0], offsets=[-1, 0, 1]
    )
    scaled = scipy.sparse.diags_array(penalty / weights) @ differences
    curvature = scipy.sparse.linalg.spsolve((hats + differences.T @ scaled).tocsc(), differences.T @ y)
    return np.asarray(y - scaled @ curvature)


def _joined(curves: "list[scipy.interpolate.PPoly]") -> "scipy.interpolate.PPoly":
    """Join curves to one that is NaN between them."""
    gap = np.full((4, 1, 3), np.nan)
    coefficients: list[npt.NDArray[np.float64]] = []
    for curve in curves:
        coefficients += [curve.c, gap]
    return scipy.interpolate.PPoly(
        np.concatenate(coefficients[:-1], axis=1),
        np.concatenate([curve.x for curve in curves]),
        extrapolate=False,
    )
