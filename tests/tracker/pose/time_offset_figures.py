"""Prints how true temporal calibration is, and how far its limits are from chance.

PYTHONPATH=. python -m tests.tracker.pose.time_offset_figures --recordings 100
"""

import argparse
from collections import Counter
from dataclasses import replace

import numpy as np

from tests.tracker.pose.shared_motion import HandMotion, Source
from tracker.errors import CalibrationError
from tracker.pose.temporal_calibration import Motion, PoseSeries, TimeOffsetLimits, calibrate_time_offset

# Only the overlap is required, so that results that would be rejected count too.
OPEN = TimeOffsetLimits(
    min_rotation_deg_s=0.0,
    min_translation_mm_s=0.0,
    min_correlation_ratio=-1.0,
    max_second_peak_ratio=10.0,
    max_sd_s=np.inf,
    max_change_s=np.inf,
)
ARM_MM = {Motion.ROTATION: (0.0, -120.0, 5.0), Motion.TRANSLATION: (0.0, 0.0, 0.0)}
CASES = {
    "30 and 30 Hz": (Source(seed=0), Source(seed=1)),
    "30 and 60 Hz": (Source(seed=0), Source(seed=1, rate_hz=60.0, phase_s=0.007)),
    "30 and 9 Hz": (Source(seed=0), Source(seed=1, rate_hz=9.0, phase_s=0.03)),
    "9 and 9 Hz": (Source(seed=0, rate_hz=9.0), Source(seed=1, rate_hz=9.0, phase_s=0.03)),
    "30 and 60 Hz, 10 % unseen, jitter": (
        Source(seed=0, unseen_ratio=0.1, jitter_s=0.004),
        Source(seed=1, rate_hz=60.0, unseen_ratio=0.1),
    ),
    "30 and 60 Hz, gaps": (
        Source(seed=0, gaps_s=((3.0, 3.7), (6.0, 6.3))),
        Source(seed=1, rate_hz=60.0, gaps_s=((8.0, 8.5),)),
    ),
}


def print_accuracy(recordings: int) -> None:
    """Errors against the truth for sources of several kinds, 0.3 mm and 0.3 deg of noise, 12 s each."""
    for motion in Motion:
        for name, (first, second) in CASES.items():
            errors_s, sds_s = [], []
            rejected: Counter[str] = Counter()
            for seed in range(recordings):
                late_s = float(np.random.default_rng(seed).uniform(0.0, 0.5))
                hand = HandMotion(seed=seed)
                one = replace(first, seed=2 * seed, late_s=late_s).record(hand)
                other = replace(second, seed=2 * seed + 1, arm_mm=ARM_MM[motion]).record(hand)
                try:
                    offset = calibrate_time_offset(one, other, motion=motion)
                except CalibrationError as error:
                    rejected[error.code] += 1
                    continue
                errors_s.append(offset.offset_s - late_s)
                sds_s.append(offset.sd_s)
            error_ms, sd_ms = np.array(errors_s) * 1000.0, np.array(sds_s) * 1000.0
            scores = error_ms / sd_ms
            print(  # noqa: T201  what this is for
                f"{motion.value:12}{name:35}RMS {_rms(error_ms):.2f} ms, median sd {np.median(sd_ms):.2f} "
                f"ms, RMS z {_rms(scores):.2f}, largest z {np.abs(scores).max():.1f}, "
                f"rejected {dict(rejected)}"
            )


def print_probability(recordings: int) -> None:
    """Correlation of two different motions, and the second peak of one motion, in 9.5 s and 12 s."""
    for motion in Motion:
        different, second = [], []
        for seconds in (9.5, 12.0):
            for rates_hz in ((0.2, 1.8), (0.2, 1.0), (0.5, 1.5)):
                for seed in range(recordings):
                    hand = HandMotion(seed=seed, rates_hz=rates_hz)
                    one = Source(seed=2 * seed).record(hand, seconds=seconds)
                    other = Source(seed=2 * seed + 1)
                    stranger = replace(hand, seed=5000 + seed)
                    different.append(_ratios(one, other.record(stranger, seconds=seconds), motion)[0])
                    second.append(_ratios(one, other.record(hand, seconds=seconds), motion)[1])
        print(  # noqa: T201
            f"{motion.value:12}{len(second)} recordings: different motions correlate by {max(different):.2f} "
            f"at most (99 %: {np.percentile(different, 99):.2f}), second peaks reach {max(second):.2f} "
            f"(99 %: {np.percentile(second, 99):.2f})"
        )


def _ratios(one: PoseSeries, other: PoseSeries, motion: Motion) -> tuple[float, float]:
    try:
        offset = calibrate_time_offset(one, other, motion=motion, limits=OPEN)
    except CalibrationError as error:
        # The best offset is at the end of the search range: no result would be stated.
        if error.code != "TIME_OFFSET_AT_SEARCH_LIMIT":
            raise
        return 0.0, 0.0
    return offset.correlation_ratio, offset.second_peak_ratio


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt((values**2).mean()))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--recordings", type=int, default=100)
    count = parser.parse_args().recordings
    print_accuracy(count)
    print_probability(count)
