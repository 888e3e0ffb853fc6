"""Rejection of recordings that do not determine the time offset, with error codes.

TIME_SERIES_INVALID             (InvalidInput) wrong shape, non-finite number, or times that do not increase
TIME_OFFSET_NEEDS_ROTATIONS     (InvalidInput) a source has positions only
TIME_OFFSET_TOO_FEW_SAMPLES     too few poses in intervals without a gap
TIME_OFFSET_RATE_LOW            a source is sampled below twice the cut-off frequency
TIME_OFFSET_OVERLAP_SHORT       the recordings overlap too little at every offset within the search
TIME_OFFSET_NO_MOTION           the tool hardly moved
TIME_OFFSET_MOTION_UNIFORM      the tool moved at constant velocity
TIME_OFFSET_MOTIONS_DIFFER      the maximum correlation of the rates is too low
TIME_OFFSET_AT_SEARCH_LIMIT     the best offset is the first or last of the search
TIME_OFFSET_AMBIGUOUS           a second offset correlates nearly as well, as with periodic motion
TIME_OFFSET_UNCERTAIN           the standard deviation is too large
TIME_OFFSET_CHANGES             the offsets of both halves of the recording differ: drift, or lost images
"""

from collections.abc import Sequence

from tracker.errors import CalibrationError, InvalidInput
from tracker.pose.temporal_calibration.limits import TimeOffsetLimits
from tracker.pose.temporal_calibration.series import Motion, PoseSeries, RateSignal

MOVE_REMEDY = (
    "Record again: rotate and move the tool by hand, fast and irregularly, in view of both for over 10 s."
)
UNIT = {Motion.ROTATION: "deg/s", Motion.TRANSLATION: "mm/s"}
UNIT_NAME = {Motion.ROTATION: "deg_s", Motion.TRANSLATION: "mm_s"}


def reject_positions_only(sources: Sequence[PoseSeries], motion: Motion) -> None:
    """Reject a comparison of rotations with a source that has positions only."""
    without = [source.name for source in sources if source.rotations is None]
    if motion is Motion.ROTATION and without:
        names = ", ".join(without)
        raise InvalidInput(
            "TIME_OFFSET_NEEDS_ROTATIONS",
            f"sources with positions only: {names}",
            "Compare translations, if both sources track the same point of the tool.",
            {"sources": without, "names": names},
        )


def reject_unfit_source(signal: RateSignal, limits: TimeOffsetLimits) -> None:
    """Reject a source with too few poses or too low a pose rate."""
    if signal.samples < limits.min_samples:
        raise CalibrationError(
            "TIME_OFFSET_TOO_FEW_SAMPLES",
            f"{signal.name} has {signal.samples} different poses in intervals without a gap, "
            f"needed {limits.min_samples}",
            "Record longer, and keep the tool in view.",
            {"source": signal.name, "samples": signal.samples, "min_samples": limits.min_samples},
        )
    if signal.rate_hz < limits.min_rate_hz:
        raise CalibrationError(
            "TIME_OFFSET_RATE_LOW",
            f"{signal.name} has {signal.rate_hz:.1f} poses per second, needed {limits.min_rate_hz:g}",
            "Record at a higher rate, so that the motion of a hand is resolved.",
            {"source": signal.name, "rate_hz": signal.rate_hz, "min_rate_hz": limits.min_rate_hz},
        )


def reject_short_overlap(a: RateSignal, b: RateSignal, overlap_s: float, limits: TimeOffsetLimits) -> None:
    """Reject recordings that overlap too little at every offset within the search."""
    if overlap_s < limits.min_overlap_s:
        spans = " and ".join(
            f"{one.name} from {one.span_s[0]:.2f} to {one.span_s[1]:.2f} s" for one in (a, b)
        )
        raise CalibrationError(
            "TIME_OFFSET_OVERLAP_SHORT",
            f"both sources saw the tool for {max(overlap_s, 0.0):.1f} s at an offset within "
            f"{limits.max_offset_s:g} s, needed {limits.min_overlap_s:g} s ({spans})",
            "Record longer with both sources at once, start both clocks together, or reduce the search.",
            {
                "overlap_s": max(overlap_s, 0.0),
                "min_overlap_s": limits.min_overlap_s,
                "max_offset_s": limits.max_offset_s,
                "spans": spans,
            },
        )


def reject_uniform_motion(
    name: str, rms: tuple[float, float], motion: Motion, limits: TimeOffsetLimits
) -> None:
    """Reject a tool at rest, and a constant rate (small RMS about its mean)."""
    rotates = motion is Motion.ROTATION
    needed = limits.min_rotation_deg_s if rotates else limits.min_translation_mm_s
    unit, key = UNIT[motion], UNIT_NAME[motion]
    rate, variation = rms
    context = {
        "source": name,
        f"rate_{key}": rate,
        f"variation_{key}": variation,
        f"needed_{key}": needed,
        "motion": motion.value,
        "rate": rate,
        "variation": variation,
        "needed": needed,
        "rate_unit": unit,
    }
    if rate < needed:
        raise CalibrationError(
            "TIME_OFFSET_NO_MOTION",
            f"in {name} the tool has a {motion.value} of {rate:.1f} {unit} (RMS), needed {needed:g} {unit}",
            MOVE_REMEDY,
            context,
        )
    if variation < needed:
        raise CalibrationError(
            "TIME_OFFSET_MOTION_UNIFORM",
            f"in {name} the {motion.value} of {rate:.1f} {unit} varies by {variation:.1f} {unit} (RMS), "
            f"needed {needed:g} {unit}: a constant velocity does not determine the offset",
            MOVE_REMEDY,
            context,
        )


def reject_another_motion(peak_ratio: float, peak_s: float, limits: TimeOffsetLimits) -> None:
    """Reject two recordings whose rates correlate too little at every offset."""
    if peak_ratio < limits.min_correlation_ratio:
        raise CalibrationError(
            "TIME_OFFSET_MOTIONS_DIFFER",
            f"the rates of both sources correlate by {peak_ratio:.3f} at best (at {peak_s:+.2f} s), "
            f"needed {limits.min_correlation_ratio:g}",
            "Check that both sources track one rigid tool (the same point where translations are compared), "
            "and that the offset lies within the search range.",
            {
                "correlation_ratio": peak_ratio,
                "min_correlation_ratio": limits.min_correlation_ratio,
                "offset_s": peak_s,
            },
        )


def reject_at_search_limit(peak_s: float, at_limit: bool, limits: TimeOffsetLimits) -> None:
    """Reject an offset that is the first or the last of the search."""
    if at_limit:
        raise CalibrationError(
            "TIME_OFFSET_AT_SEARCH_LIMIT",
            f"the correlation still increases at {peak_s:+.2f} s, where the search ends",
            "Increase the search range, or start both clocks closer together.",
            {"offset_s": peak_s, "max_offset_s": limits.max_offset_s},
        )


def reject_ambiguous(peak_s: float, second_s: float, second_ratio: float, limits: TimeOffsetLimits) -> None:
    """Reject a motion with two nearly equal correlation peaks."""
    if second_ratio > limits.max_second_peak_ratio:
        raise CalibrationError(
            "TIME_OFFSET_AMBIGUOUS",
            f"an offset of {second_s:+.2f} s has {second_ratio:.2f} of the correlation at {peak_s:+.2f} s, "
            f"allowed {limits.max_second_peak_ratio:g}: the motion repeats itself",
            MOVE_REMEDY,
            {
                "offset_s": peak_s,
                "second_offset_s": second_s,
                "second_peak_ratio": second_ratio,
                "max_second_peak_ratio": limits.max_second_peak_ratio,
            },
        )


def reject_uncertain(offset_s: float, sd_s: float, limits: TimeOffsetLimits) -> None:
    """Reject an offset with too large a standard deviation."""
    if not sd_s <= limits.max_sd_s:
        raise CalibrationError(
            "TIME_OFFSET_UNCERTAIN",
            f"the offset of {offset_s * 1000.0:+.1f} ms has a standard deviation of {sd_s * 1000.0:.1f} ms, "
            f"allowed {limits.max_sd_s * 1000.0:g} ms",
            MOVE_REMEDY,
            {
                "offset_s": offset_s,
                "sd_s": sd_s,
                "max_sd_s": limits.max_sd_s,
                "offset_ms": offset_s * 1000.0,
                "sd_ms": sd_s * 1000.0,
                "max_sd_ms": limits.max_sd_s * 1000.0,
            },
        )


def reject_change(change_s: float, change_sd_s: float, limits: TimeOffsetLimits) -> None:
    """Reject an offset that differs between both halves by more than the limit and their noise."""
    allowed_s = max(limits.max_change_s, limits.max_change_deviations * change_sd_s)
    if abs(change_s) > allowed_s:
        raise CalibrationError(
            "TIME_OFFSET_CHANGES",
            f"the offset changes by {change_s * 1000.0:+.1f} ms from the first half of the recording to the "
            f"second, allowed {allowed_s * 1000.0:.1f} ms",
            "Check that both clocks count real time: no images timed by a nominal rate, and none lost.",
            {
                "change_s": change_s,
                "allowed_s": allowed_s,
                "change_ms": change_s * 1000.0,
                "allowed_ms": allowed_s * 1000.0,
            },
        )
