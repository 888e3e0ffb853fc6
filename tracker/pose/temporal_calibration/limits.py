"""Every threshold of temporal calibration: its unit, its source, and what breaks when it moves.

max_offset_s           s      Two processes on one machine, or two recordings started at one word. Too small:
                              the offset is not found. Too large: more must be recorded, and more offsets
                              can fit by chance.
cutoff_hz              Hz     A hand moves a tool below 3 Hz, and a spline needs two samples a period, which
                              the slowest camera in use (9 Hz) gives. Too low: fast motion, which determines
                              the offset best, is lost. Too high: the rates' noise grows with its power 1.5.
max_step_ratio         1      Steps of a source with jitter, in medians of its steps. Too low: jitter is
                              taken for a gap. Too high: unseen stretches are interpolated across.
min_samples            1      Five of the shortest stretches that a spline can follow (6). Lower: a curve
                              through noise.
min_overlap_s          s      16 blocks, which give a standard deviation to 18 %. Lower: it is optimistic,
                              and different motions correlate by chance (0.67 at most in 1,200 pairs of 9.5
                              and 12 s).
block_s                s      Twice the correlation time of the low-pass. Too short: one error is counted as
                              many, and the standard deviation is too small. Too long: too few blocks.
min_rotation_deg_s     deg/s  Three times the noise of 0.3 deg at 30 Hz after the low-pass (3.5 deg/s).
min_translation_mm_s   mm/s   Six times the noise of 0.3 mm at 30 Hz after it (3.4 mm/s); depth is noisier.
                              Both lower: a tool at rest counts as moving. Higher: calm hands are rejected.
min_correlation_ratio  1      Noise of a tenth of the power in each source; far above chance (0.67). Lower:
                              points 100 mm apart on a turning tool pass for one. Higher: noise is rejected.
max_second_peak_ratio  1      Irregular motion reaches 0.82 at most (1,200 recordings), a periodic one
                              0.93 and more. Higher: an offset that is wrong by a period. Lower: good
                              recordings are rejected.
max_sd_s               s      2 ms at 100 mm/s are 0.2 mm, a quarter of the limit of a tip's calibration.
                              Higher: a correction that moves the tool more than it mends.
max_change_s           s      2.5 times max_sd_s, between the halves of the recording. Higher: a clock that
                              gains 1 part in 1,000 passes for constant. Lower: noise passes for drift.
max_change_deviations  1      Normal noise exceeds it in 1 of 16,000 recordings. Higher: drift passes for
                              noise. Lower: noise passes for drift.
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
