"""Every threshold of temporal calibration: its unit, its source, and what breaks when it moves.

max_offset_s           s      Two processes on one machine, or two recordings started at one command. Too
                              small: the offset is not found. Too large: more must be recorded, and more
                              offsets can fit by chance. cutoff_hz              Hz     A hand moves a tool
                              below 3 Hz, and a spline needs two samples per period, which the slowest camera
                              in use (9 Hz) provides. Too low: fast motion, which determines the offset best,
                              is lost. Too high: the noise of the rates grows with its power 1.5.
                              max_step_ratio         1      Maximum step of a source with jitter, in median
                              steps. Too low: jitter counts as a gap. Too high: the rates are interpolated
                              across gaps. min_samples            1      Five of the shortest intervals that a
                              spline can fit (6). Lower: the spline follows noise. min_overlap_s          s
                              16 blocks, which give a standard deviation to 18 %. Lower: it is too small, and
                              different motions correlate by chance (0.67 at most in 1,200 pairs of 9.5 and 12
                              s). block_s                s      Twice the correlation time of the low-pass.
                              Too short: one error counts as several, and the standard deviation is too small.
                              Too long: too few blocks. min_rotation_deg_s     deg/s  Three times the noise of
                              0.3 deg at 30 Hz after the low-pass (3.5 deg/s). min_translation_mm_s   mm/s
                              Six times the noise of 0.3 mm at 30 Hz after it (3.4 mm/s); depth is noisier.
                              Both lower: a tool at rest counts as moving. Higher: calm hands are rejected.
min_correlation_ratio  1      Noise of a tenth of the power in each source; far above chance (0.67). Lower:
points 100 mm apart on a rotating tool count as one. Higher: noisy recordings are rejected.
max_second_peak_ratio  1      Irregular motion reaches 0.82 at most (1,200 recordings), periodic motion 0.93
and more. Higher: the offset can be wrong by a period. Lower: good recordings are rejected. max_sd_s
s      2 ms at 100 mm/s are 0.2 mm, a quarter of the limit of a tip calibration. Higher: the correction adds
more error than it removes. max_change_s           s      2.5 times max_sd_s, between the halves of the
recording. Higher: a clock drift of 1 part in 1,000 is not detected. Lower: noise counts as drift.
max_change_deviations  1      Normal noise exceeds it in 1 of 16,000 recordings. Higher: drift counts as
noise.
                              Lower: noise counts as drift.
"""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class TimeOffsetLimits:
    """Acceptance limits of a time offset calibration; see the table above."""

    max_offset_s: float = 1.0
    cutoff_hz: float = 4.0
    max_step_ratio: float = 1.5
    min_samples: int = 30
    min_overlap_s: float = 8.0
    block_s: float = 0.5
    min_rotation_deg_s: float = 10.0
    min_translation_mm_s: float = 20.0
    min_correlation_ratio: float = 0.9
    max_second_peak_ratio: float = 0.9
    max_sd_s: float = 0.002
    max_change_s: float = 0.005
    max_change_deviations: float = 4.0

    @property
    def min_rate_hz(self) -> float:
        """Return the minimum pose rate of a source: two per period at the cut-off."""
        return 2.0 * self.cutoff_hz
