"""Temporal calibration: the offset with a calibrated standard deviation, or a rejection."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.tracker.pose.shared_motion import (
    HandMotion,
    Movement,
    Source,
    at_rest,
    circling,
    steady,
    waving,
)
from tracker.errors import CalibrationError, InvalidInput
from tracker.pose.temporal_calibration import (
    Motion,
    PoseSeries,
    TimeOffset,
    TimeOffsetLimits,
    calibrate_time_offset,
)

HAND = HandMotion(seed=3)
FIRST, SECOND = Source(seed=1), Source(seed=2)


def found(
    first: Source,
    second: Source,
    motion: Motion = Motion.ROTATION,
    *,
    movement: Movement = HAND,
    seconds: float = 12.0,
) -> TimeOffset:
    return calibrate_time_offset(
        first.record(movement, seconds=seconds), second.record(movement, seconds=seconds), motion=motion
    )


@pytest.mark.parametrize("motion", Motion)
@pytest.mark.parametrize(
    ("first", "second"),
    [
        pytest.param(Source(seed=1, late_s=0.137), Source(seed=2), id="first-late"),
        pytest.param(Source(seed=1), Source(seed=2, late_s=0.482), id="second-late"),
        pytest.param(Source(seed=1), Source(seed=2, rate_hz=60.0, phase_s=0.007), id="30-and-60-hz"),
        pytest.param(Source(seed=1, late_s=0.2), Source(seed=2, rate_hz=9.0, phase_s=0.03), id="30-and-9-hz"),
        pytest.param(Source(seed=1, rate_hz=9.0), Source(seed=2, rate_hz=9.0, late_s=0.3), id="9-and-9-hz"),
        pytest.param(
            Source(seed=1, late_s=0.9, unseen_ratio=0.15),
            Source(seed=2, rate_hz=60.0, unseen_ratio=0.15, jitter_s=0.003),
            id="dropouts-and-jitter",
        ),
        pytest.param(
            Source(seed=1, gaps_s=((3.0, 3.8), (9.0, 9.5))),
            Source(seed=2, late_s=0.3, gaps_s=((6.0, 6.7),)),
            id="gaps",
        ),
    ],
)
def test_the_offset_is_found(first: Source, second: Source, motion: Motion) -> None:
    offset = found(first, second, motion)
    error_s = offset.offset_s - (first.late_s - second.late_s)
    assert abs(error_s) < min(3.5 * offset.sd_s, 0.003)
    assert offset.motion is motion


def test_markers_at_different_places_of_the_tool_have_one_rotation() -> None:
    offset = found(FIRST, replace(SECOND, arm_mm=(0.0, -150.0, 40.0), late_s=0.1))
    assert offset.offset_s == pytest.approx(-0.1, abs=3.5 * offset.sd_s)


def test_points_that_are_far_apart_have_no_common_translation() -> None:
    with pytest.raises(CalibrationError) as caught:
        found(FIRST, replace(SECOND, arm_mm=(0.0, -150.0, 40.0)), Motion.TRANSLATION)
    assert caught.value.code == "TIME_OFFSET_MOTIONS_DIFFER"


@pytest.mark.parametrize(
    ("motion", "second_hz"),
    [
        pytest.param(Motion.ROTATION, 30.0, id="rotation"),
        pytest.param(Motion.TRANSLATION, 9.0, id="translation"),
    ],
)
def test_the_standard_deviation_covers_the_error(motion: Motion, second_hz: float) -> None:
    scores = []
    for seed in range(40):
        late_s = float(np.random.default_rng(seed).uniform(0.0, 0.5))
        first = Source(seed=2 * seed, late_s=late_s)
        second = Source(seed=2 * seed + 1, rate_hz=second_hz, phase_s=0.01)
        offset = found(first, second, motion, movement=HandMotion(seed=seed))
        scores.append((offset.offset_s - late_s) / offset.sd_s)
    rms = float(np.sqrt(np.mean(np.square(scores))))
    assert 0.6 < rms < 1.5
    assert max(np.abs(scores)) < 4.0


@pytest.mark.parametrize("motion", Motion)
def test_more_noise_is_a_larger_standard_deviation(motion: Motion) -> None:
    quiet, noisy = (
        found(
            replace(FIRST, turn_sd_deg=sd, shift_sd_mm=sd),
            replace(SECOND, turn_sd_deg=sd, shift_sd_mm=sd),
            motion,
        )
        for sd in (0.1, 0.4)
    )
    assert 2.0 < noisy.sd_s / quiet.sd_s < 8.0


def test_swapped_sources_change_the_sign_alone() -> None:
    one = FIRST.record(HAND)
    other = replace(SECOND, rate_hz=60.0, late_s=0.2).record(HAND)
    offset, swapped = calibrate_time_offset(one, other), calibrate_time_offset(other, one)
    assert swapped.offset_s == pytest.approx(-offset.offset_s, abs=1e-6)
    assert swapped.sd_s == pytest.approx(offset.sd_s, rel=1e-3)
    assert swapped.samples == offset.samples[::-1]


def test_clocks_that_count_from_1970_give_the_same_offset() -> None:
    series = [source.record(HAND) for source in (replace(FIRST, late_s=0.2), SECOND)]
    moved = [replace(one, times_s=one.times_s + 1.7e9) for one in series]
    offset = calibrate_time_offset(*series)
    assert calibrate_time_offset(*moved).offset_s == pytest.approx(offset.offset_s, abs=2e-5)


@pytest.mark.parametrize("motion", Motion)
def test_a_gap_is_not_interpolated_across(motion: Motion) -> None:
    # While the first source sees nothing, the tool moves violently.
    def thrown(times_s: np.ndarray) -> tuple[Rotation, np.ndarray]:
        turned, places_mm = HandMotion(seed=4, rotation_deg=60.0, shift_mm=300.0, rates_hz=(1.0, 3.0))(
            times_s
        )
        calm, calm_mm = HAND(times_s)
        weight = np.clip(1.0 - np.abs(times_s - 6.0) / 0.9, 0.0, None) ** 2
        return Rotation.from_rotvec(weight[:, None] * turned.as_rotvec()) * calm, calm_mm + (
            weight[:, None] * places_mm
        )

    offset = found(replace(FIRST, late_s=0.25, gaps_s=((5.0, 7.0),)), SECOND, motion, movement=thrown)
    assert offset.segments == (2, 1)
    assert offset.overlap_s < 10.0
    assert offset.offset_s == pytest.approx(0.25, abs=3.5 * offset.sd_s)


def test_a_pose_that_a_lost_tracker_repeats_is_a_gap() -> None:
    series = FIRST.record(HAND)
    assert series.rotations is not None
    lost = (series.times_s > 5.0) & (series.times_s < 6.0)
    last = int(np.argmax(lost))
    repeated = np.where(lost, last, np.arange(len(lost)))
    stuck = replace(
        series, translations_mm=series.translations_mm[repeated], rotations=series.rotations[repeated]
    )
    offset = calibrate_time_offset(stuck, SECOND.record(HAND))
    assert offset.segments == (2, 1)
    assert offset.samples[0] == len(lost) - lost.sum() + 1


@pytest.mark.parametrize("motion", Motion)
@pytest.mark.parametrize(
    ("movement", "code"),
    [
        pytest.param(at_rest, "TIME_OFFSET_NO_MOTION", id="at-rest"),
        pytest.param(steady, "TIME_OFFSET_MOTION_UNIFORM", id="one-velocity"),
        pytest.param(waving(0.8), "TIME_OFFSET_AMBIGUOUS", id="waving"),
        # Half a period too: reversed, one direction equals the other.
        pytest.param(waving(1.6), "TIME_OFFSET_AMBIGUOUS", id="waving-at-half-a-period"),
        pytest.param(circling(1.5), "TIME_OFFSET_AMBIGUOUS", id="circling"),
        pytest.param(circling(4.0), "TIME_OFFSET_AMBIGUOUS", id="circling-slowly"),
    ],
)
def test_a_motion_that_leaves_the_offset_open_is_rejected(
    movement: Movement, code: str, motion: Motion
) -> None:
    with pytest.raises(CalibrationError) as caught:
        found(replace(FIRST, late_s=0.1), SECOND, motion, movement=movement)
    assert caught.value.code == code
    assert "irregularly" in caught.value.remedy


@pytest.mark.parametrize(
    ("first", "seconds", "code", "words"),
    [
        pytest.param(FIRST, 7.0, "TIME_OFFSET_OVERLAP_SHORT", ["for 6.9 s", "needed 8 s"], id="short"),
        pytest.param(
            replace(FIRST, gaps_s=((2.0, 6.0),)),
            12.0,
            "TIME_OFFSET_OVERLAP_SHORT",
            ["needed 8 s"],
            id="long-gap",
        ),
        pytest.param(
            replace(FIRST, late_s=500.0), 12.0, "TIME_OFFSET_OVERLAP_SHORT", ["for 0.0 s"], id="other-epoch"
        ),
        pytest.param(
            replace(FIRST, unseen_ratio=0.8),
            12.0,
            "TIME_OFFSET_TOO_FEW_SAMPLES",
            ["needed 30"],
            id="seldom-seen",
        ),
        pytest.param(
            replace(FIRST, rate_hz=5.0),
            12.0,
            "TIME_OFFSET_RATE_LOW",
            ["5.0 poses per second", "needed 8"],
            id="slow",
        ),
        pytest.param(
            replace(FIRST, late_s=1.02),
            12.0,
            "TIME_OFFSET_AT_SEARCH_LIMIT",
            ["at +1.00 s"],
            id="search-limit",
        ),
        pytest.param(
            replace(FIRST, late_s=1.6), 14.0, "TIME_OFFSET_MOTIONS_DIFFER", ["needed 0.9"], id="outside"
        ),
        pytest.param(
            replace(FIRST, turn_sd_deg=1.6),
            12.0,
            "TIME_OFFSET_UNCERTAIN",
            ["allowed 2 ms"],
            id="noisy",
        ),
    ],
)
def test_a_recording_that_does_not_determine_the_offset_is_rejected(
    first: Source, seconds: float, code: str, words: list[str]
) -> None:
    with pytest.raises(CalibrationError) as caught:
        found(first, SECOND, seconds=seconds)
    assert caught.value.code == code
    for word in words:
        assert word in caught.value.message
    assert caught.value.context


@pytest.mark.parametrize("motion", Motion)
def test_two_different_motions_are_rejected(motion: Motion) -> None:
    for seed in range(5):
        with pytest.raises(CalibrationError) as caught:
            calibrate_time_offset(
                FIRST.record(HAND), SECOND.record(HandMotion(seed=100 + seed)), motion=motion
            )
        assert caught.value.code == "TIME_OFFSET_MOTIONS_DIFFER"


def test_a_clock_that_gains_a_part_in_a_thousand_is_rejected() -> None:
    series = FIRST.record(HAND, seconds=20.0)
    with pytest.raises(CalibrationError) as caught:
        calibrate_time_offset(
            replace(series, times_s=series.times_s * 1.001), SECOND.record(HAND, seconds=20.0)
        )
    assert caught.value.code == "TIME_OFFSET_CHANGES"
    change_s = caught.value.context["change_s"]
    assert change_s == pytest.approx(0.010, abs=0.003)


def test_an_ambiguity_beyond_the_search_does_not_count() -> None:
    one, other = (source.record(waving(1.8)) for source in (replace(FIRST, late_s=0.1), SECOND))
    offset = calibrate_time_offset(one, other, limits=TimeOffsetLimits(max_offset_s=0.4))
    assert offset.offset_s == pytest.approx(0.1, abs=3.5 * offset.sd_s)


def test_positions_alone_are_compared_by_translation_only() -> None:
    positions = replace(FIRST.record(HAND), rotations=None)
    other = SECOND.record(HAND)
    assert abs(calibrate_time_offset(positions, other, motion=Motion.TRANSLATION).offset_s) < 0.002
    with pytest.raises(InvalidInput) as caught:
        calibrate_time_offset(positions, other)
    assert caught.value.code == "TIME_OFFSET_NEEDS_ROTATIONS"


@pytest.mark.parametrize(
    ("times_s", "shape", "word"),
    [
        pytest.param([0.0, 0.2, 0.1], (3, 3), "after 0.200000 s is 0.100000 s", id="backwards"),
        pytest.param([0.0, 0.1, 0.1], (3, 3), "not later", id="twice"),
        pytest.param([0.0, 0.1, np.nan], (3, 3), "finite", id="no-number"),
        pytest.param([0.0, 0.1], (3, 3), "(2, 3)", id="another-count"),
    ],
)
def test_a_series_that_is_none_is_invalid(times_s: list[float], shape: tuple[int, int], word: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        PoseSeries(name="a", times_s=np.array(times_s), translations_mm=np.zeros(shape))
    assert caught.value.code == "TIME_SERIES_INVALID"
    assert word in caught.value.message
