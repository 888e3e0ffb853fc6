"""Estimate how far the displayed tip lags behind a moving one: its speed times the measured latency.

A snapshot shows the state at its capture and is displayed one latency later. At constant speed the tip has
moved on by this distance. The margin is displayed beside the 95 % error and does not affect the verdict:
otherwise every approach to the bone would be "uncertain", which would hide the other verdicts.
"""

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import nan

import numpy as np

from tracker.geometry import Array
from tracker.navigation.assessment import Assessment, Lag
from tracker.navigation.snapshot import Absent, NavigationSnapshot

# | threshold | unit | source | what breaks when it moves |
# |---|---|---|---|
# | WINDOW_S | s | half a period of a fast oscillation | longer: a stroke is averaged out; shorter: noise |
# | MIN_IMAGES | 1 | 9 residuals to estimate the noise | lower: noise of four images counts as a speed |
# | MAX_WINDOW_S | s | five images of a camera of 6 Hz | longer: speeds of slow cameras are outdated |
# | MAX_GAP_S | s | restart for a tool that was out of view | higher: its unseen motion counts as a speed |
# | MIN_SPEED_SD | sd | F(3, 9) at 99.9 % is 13.9, x3, root | lower: a tool at rest has a margin at times |
# | MIN_SPEED_MM_S | mm/s | 0.1 mm in 100 ms | lower: drift of a pose counts as motion |
# | MAX_PERIOD_RATIO | 1 | 10 ms at 30 images/s, a tenth of a latency | higher: the latency is understated |
# | PERIOD_IMAGES | 1 | a second at 30 images/s | lower: a few skipped images withhold the latency |
WINDOW_S, MAX_WINDOW_S, MAX_GAP_S = 0.2, 0.8, 0.5
MIN_IMAGES = 5
MIN_SPEED_SD, MIN_SPEED_MM_S = 6.5, 1.0
MAX_PERIOD_RATIO, PERIOD_IMAGES = 1.3, 30


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasuredLatency:
    """A measured latency, and the size and period of the images of the measurement.

    Attributes:
        p99_ms: 99th percentile of the delay from exposure to display.
        size_wh_px: size of the images.
        image_period_ms: time between two of them; 0 if unknown.
    """

    p99_ms: float
    size_wh_px: tuple[int, int]
    image_period_ms: float

    def applies_to(self, size_wh_px: tuple[int, int], *, period_ms: float) -> bool:
        """Return whether the latency is valid for images of this size and period; NaN: unknown period.

        The time to read, transfer, track and draw depends on the image size. Images at a lower rate are older
        on average when they are displayed.
        """
        is_slower = self.image_period_ms > 0.0 and period_ms > MAX_PERIOD_RATIO * self.image_period_ms
        return size_wh_px == self.size_wh_px and not is_slower


class TipSpeedEstimator:
    """Estimate the speed of one tip from its recent positions. Mutable."""

    def __init__(self) -> None:
        self._places: deque[tuple[float, Array]] = deque()

    def forget(self) -> None:
        """Discard the recent positions."""
        self._places.clear()

    def take(self, tip_mm: Array, *, at_s: float) -> float:
        """Add a position (3,) and return the speed in mm/s: 0 at rest, NaN while positions are too few."""
        if self._places and not 0.0 < at_s - self._places[-1][0] <= MAX_GAP_S:
            self.forget()
        self._places.append((at_s, tip_mm))
        while len(self._places) > MIN_IMAGES and at_s - self._places[0][0] > WINDOW_S:
            self._places.popleft()
        if len(self._places) < MIN_IMAGES or at_s - self._places[0][0] > MAX_WINDOW_S:
            return nan
        times_s = np.array([time_s for time_s, _ in self._places])
        tips_mm = np.array([tip for _, tip in self._places])
        from_mean_s = times_s - times_s.mean()
        spread_s2 = float(from_mean_s @ from_mean_s)
        velocity = from_mean_s @ tips_mm / spread_s2
        residual = tips_mm - tips_mm.mean(axis=0) - np.outer(from_mean_s, velocity)
        sd_mm_s = float(np.sqrt((residual**2).sum() / (3 * (len(times_s) - 2)) / spread_s2))
        speed_mm_s = float(np.linalg.norm(velocity))
        is_at_rest = speed_mm_s < max(MIN_SPEED_MM_S, MIN_SPEED_SD * sd_mm_s)
        return 0.0 if is_at_rest else speed_mm_s + 2.0 * sd_mm_s


class LagEstimator:
    """Add the lag to each assessment of a snapshot. Mutable: one `TipSpeedEstimator` per tool."""

    def __init__(self) -> None:
        self._tips: dict[str, TipSpeedEstimator] = {}
        self._times_s: deque[float] = deque(maxlen=PERIOD_IMAGES + 1)

    def take(self, snapshot: NavigationSnapshot, *, latency: MeasuredLatency | None) -> NavigationSnapshot:
        """Return the snapshot with the lag of each assessed tool.

        Args:
            snapshot: of the next image.
            latency: of this camera and a screen; None if not measured. Unused for images that it does not
                apply to.
        """
        self._times_s.append(snapshot.captured_at_s)
        latency_ms = None
        if latency is not None and latency.applies_to(snapshot.size_wh_px, period_ms=self._period_ms()):
            latency_ms = latency.p99_ms
        assessments: Mapping[str, Assessment | Absent] = {
            name: self._with_lag(snapshot, name, one, latency_ms)
            for name, one in snapshot.assessments.items()
        }
        return replace(snapshot, assessments=assessments)

    def _period_ms(self) -> float:
        images = len(self._times_s) - 1
        return 1000.0 * (self._times_s[-1] - self._times_s[0]) / images if images > 0 else nan

    def _with_lag(
        self, snapshot: NavigationSnapshot, name: str, one: Assessment | Absent, latency_ms: float | None
    ) -> Assessment | Absent:
        tip = self._tips.setdefault(name, TipSpeedEstimator())
        vertebra_from_tool = snapshot.vertebra_from_tool(name)
        if isinstance(one, Absent) or isinstance(vertebra_from_tool, Absent):
            tip.forget()
            return one
        speed_mm_s = tip.take(vertebra_from_tool.translation_mm, at_s=snapshot.captured_at_s)
        return replace(one, lag=Lag.of(speed_mm_s, latency_ms))
