"""A landmark can be captured at any usual image rate; an error message states the rate."""

from collections.abc import Iterator

import numpy as np
import pytest

from tracker.errors import RegistrationError
from tracker.registration.capture import (
    CapturedLandmark,
    CaptureSettings,
    LandmarkCollector,
    TipSample,
    UnseenSample,
)

AT = np.array([10.0, -20.0, 400.0])
ON_A_LOADED_MACHINE_S = [0.11, 0.1, 0.19, 0.54, 0.12, 0.15, 0.1, 0.2, 0.13, 0.18, 0.16, 0.12]


def steady_s(rate_hz: float) -> list[float]:
    return [1.0 / rate_hz] * 400


def irregular_s(seed: int) -> list[float]:
    """5 to 10 images/s, and once nothing for 0.54 s."""
    random = np.random.default_rng(seed)
    intervals_s = 1.0 / random.uniform(5.0, 10.0, size=400)
    intervals_s[random.integers(0, 11)] = 0.54
    return [float(interval_s) for interval_s in intervals_s]


def samples(
    intervals_s: list[float], *, seed: int = 0, camera_hz: float | None = None, off_mm: float = 0.0
) -> Iterator[TipSample]:
    """The tip at rest; `off_mm` away after the longest interval."""
    random = np.random.default_rng(seed)
    times_s = 5.0 + np.concatenate([[0.0], np.cumsum(intervals_s)])
    gap_ends_at_s = times_s[int(np.argmax(intervals_s)) + 1]
    for at_s in times_s:
        moved_mm = np.array([off_mm if at_s >= gap_ends_at_s else 0.0, 0.0, 0.0])
        yield TipSample(
            at_s=float(at_s),
            tip_in_anchor_mm=AT + moved_mm + random.normal(size=3) * 0.1,
            covariance_mm2=0.04 * np.eye(3),
            image_number=None if camera_hz is None else round(at_s * camera_hz),
        )


def collected(tips: Iterator[TipSample], settings: CaptureSettings | None = None) -> LandmarkCollector:
    """The collector after its end."""
    collector = LandmarkCollector(settings)
    while not collector.is_over:
        collector.take(next(tips))
    return collector


def rejected(collector: LandmarkCollector) -> RegistrationError:
    with pytest.raises(RegistrationError) as caught:
        collector.result()
    return caught.value


@pytest.mark.parametrize(
    ("intervals_s", "images", "lasted_s"),
    [
        pytest.param(steady_s(2.0), 12, 5.5, id="2-hz"),
        pytest.param(steady_s(3.0), 12, 3.67, id="3-hz"),
        pytest.param(steady_s(5.0), 12, 2.2, id="5-hz"),
        pytest.param(steady_s(7.0), 12, 1.57, id="7-hz"),
        pytest.param(steady_s(10.0), 12, 1.1, id="10-hz"),
        pytest.param(steady_s(15.0), 12, 0.73, id="15-hz"),
        pytest.param(steady_s(30.0), 13, 0.4, id="30-hz"),
        pytest.param(steady_s(60.0), 25, 0.4, id="60-hz"),
        pytest.param(ON_A_LOADED_MACHINE_S, 12, 1.98, id="5-to-10-hz-with-a-gap-of-0.54-s"),
    ],
)
def test_a_tip_at_rest_is_captured_at_any_usual_rate(
    intervals_s: list[float], images: int, lasted_s: float
) -> None:
    found = collected(samples(intervals_s)).result()
    assert abs(found.images - images) <= 1
    assert found.lasted_s == pytest.approx(lasted_s, abs=0.04)


def test_an_irregular_slow_camera_captures_every_time() -> None:
    for seed in range(100):
        found = collected(samples(irregular_s(seed), seed=seed)).result()
        assert found.images == 12


@pytest.mark.parametrize(
    ("rate_hz", "code", "said"),
    [
        pytest.param(1.2, "CAPTURE_RATE_TOO_LOW", "12 images take 10.0 s at 1.2 images/s", id="1.2-hz"),
        pytest.param(0.8, "CAPTURE_INTERRUPTED", "allowed 1.00 s at 0.8 images/s", id="0.8-hz"),
    ],
)
def test_a_camera_too_slow_for_a_hand_is_named_with_its_rate_and_a_remedy(
    rate_hz: float, code: str, said: str
) -> None:
    collector = collected(samples(steady_s(rate_hz)))
    error = rejected(collector)
    assert error.code == code
    assert said in error.message
    assert "camera.rate_hz" in error.remedy
    # A user should not hold a tip for ten seconds in vain.
    assert int(str(error.context["images"])) <= 4


@pytest.mark.parametrize(
    ("rate_hz", "gap_s", "allowed"),
    [
        pytest.param(60.0, 0.3, "allowed 0.25 s at 60.0 images/s", id="60-hz"),
        pytest.param(30.0, 0.3, "allowed 0.25 s at 30.0 images/s", id="30-hz"),
        pytest.param(10.0, 0.65, "allowed 0.60 s at 10.0 images/s", id="10-hz"),
        pytest.param(5.0, 1.1, "allowed 1.00 s at 5.0 images/s", id="5-hz"),
        pytest.param(2.0, 1.1, "allowed 1.00 s at 2.0 images/s", id="2-hz"),
    ],
)
def test_lost_images_are_noticed_at_every_rate(rate_hz: float, gap_s: float, allowed: str) -> None:
    intervals_s = steady_s(rate_hz)
    intervals_s[6] = gap_s
    error = rejected(collected(samples(intervals_s)))
    assert error.code == "CAPTURE_INTERRUPTED"
    assert f"{gap_s:.2f} s passed between two of" in error.message
    assert allowed in error.message
    assert ("The camera is slow" in error.remedy) is (rate_hz < 15.0)


def test_two_rests_on_a_landmark_are_not_one_however_few_the_images() -> None:
    few = CaptureSettings(min_images=3, min_s=0.4)
    # The mean of both intervals would be a possible period and allow either.
    error = rejected(collected(samples([0.033, 0.9]), few))
    assert error.code == "CAPTURE_INTERRUPTED"
    assert error.context["allowed_s"] == 0.25


def test_a_tip_that_moved_during_an_allowed_gap_is_rejected() -> None:
    assert rejected(collected(samples(ON_A_LOADED_MACHINE_S, off_mm=2.0))).code == "CAPTURE_MOVED"


def test_a_machine_that_skips_images_is_not_taken_for_a_slow_camera() -> None:
    intervals_s = [*steady_s(5.0)[:6], 1.2]
    error = rejected(collected(samples(intervals_s, camera_hz=30.0)))
    assert "5.0 images/s (the camera gives 30.0)" in error.message
    assert "The machine skips images" in error.remedy
    error = rejected(collected(samples(intervals_s, camera_hz=5.0)))
    assert "the camera gives" not in error.message
    assert "The camera is slow" in error.remedy


def test_a_marker_that_is_missed_is_counted_and_the_rate_is_named() -> None:
    tips = samples(steady_s(5.0))
    collector = LandmarkCollector()
    for _ in range(7):
        collector.take(next(tips))
    collector.take(UnseenSample(at_s=next(tips).at_s, reason="the tool's marker is not seen"))
    assert collector.is_over
    error = rejected(collector)
    assert error.code == "CAPTURE_UNSEEN"
    assert error.message == (
        "the tip was known in 7 of 8 images at 5.0 images/s and not in 1 "
        "(the tool's marker is not seen), needed in all"
    )


def test_a_capture_that_was_too_short_states_the_time_needed_at_this_rate() -> None:
    collector = LandmarkCollector()
    assert collector.left_s is None
    for tip, _ in zip(samples(steady_s(5.0)), range(5), strict=False):
        collector.take(tip)
    assert collector.rate_hz == pytest.approx(5.0)
    assert collector.left_s == pytest.approx(7 * 0.2)
    error = rejected(collector)
    assert error.code == "CAPTURE_TOO_SHORT"
    assert error.message == "there are 5 images over 0.80 s at 5.0 images/s, needed 12 over 0.4 s"
    assert error.remedy == (
        "Hold the tip still on the landmark for 2.4 s at 5.0 images/s, until it is taken."
    )


def test_what_is_left_ends_with_the_capture() -> None:
    collector = collected(samples(steady_s(30.0)))
    assert collector.left_s == 0.0
    assert isinstance(collector.result(), CapturedLandmark)
