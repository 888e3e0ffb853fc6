"""A landmark is taken only when the tip was seen and still in every image."""

import numpy as np
import pytest

from tracker.errors import RegistrationError
from tracker.registration.capture import (
    CapturedLandmark,
    CaptureSettings,
    LandmarkCollector,
    TipSample,
    UnseenSample,
    captured,
)

AT = np.array([10.0, -20.0, 400.0])


def still_samples(
    count: int = 20, sd_mm: float = 0.1, seed: int = 0, rate_hz: float = 30.0
) -> list[TipSample]:
    rng = np.random.default_rng(seed)
    return [
        TipSample(
            at_s=5.0 + index / rate_hz,
            tip_in_anchor_mm=AT + rng.normal(size=3) * sd_mm,
            covariance_mm2=0.04 * np.eye(3),
        )
        for index in range(count)
    ]


def code_of(samples: list[TipSample | UnseenSample]) -> str:
    with pytest.raises(RegistrationError) as caught:
        captured(samples)
    return caught.value.code


def test_a_still_tip_is_taken_with_its_mean() -> None:
    found = captured(still_samples())
    assert np.allclose(found.tip_in_anchor_mm, AT, atol=0.1)
    assert found.images == 20
    assert found.lasted_s == pytest.approx(19 / 30)
    assert found.spread_mm == pytest.approx([0.1, 0.1, 0.1], abs=0.05)


def test_what_is_common_does_not_average_out_and_spread_does() -> None:
    common = np.diag([0.01, 0.02, 0.03])
    found = captured(still_samples(count=60), common_covariance_mm2=common)
    rest = found.covariance_mm2 - common
    assert np.trace(rest) == pytest.approx(3 * 0.01 / 60, rel=0.3)
    assert np.trace(captured(still_samples()).covariance_mm2) > 3 * 0.04


def test_the_error_of_the_mean_agrees_with_its_covariance() -> None:
    inside = 0
    for seed in range(300):
        found = captured(still_samples(seed=seed), common_covariance_mm2=np.zeros((3, 3)))
        off = found.tip_in_anchor_mm - AT
        inside += bool(off @ np.linalg.solve(found.covariance_mm2, off) < 9.5)
    # By Hotelling's T^2 of 20 images, whose 95 % lie at 10.7, and 93 % at 9.5.
    assert 0.89 <= inside / 300 <= 0.97


def test_one_image_without_the_tip_rejects_the_capture() -> None:
    samples: list[TipSample | UnseenSample] = [*still_samples()]
    samples[7] = UnseenSample(at_s=samples[7].at_s, reason="MARKER_UNSEEN")
    with pytest.raises(RegistrationError) as caught:
        captured(samples)
    assert caught.value.code == "CAPTURE_UNSEEN"
    assert "19 of 20 images" in caught.value.message
    assert "MARKER_UNSEEN" in caught.value.message


def test_too_few_too_short_or_out_of_order_is_rejected() -> None:
    assert code_of([]) == "CAPTURE_TOO_SHORT"
    assert code_of([*still_samples(count=5)]) == "CAPTURE_TOO_SHORT"
    assert code_of([*still_samples(count=20, rate_hz=120.0)]) == "CAPTURE_TOO_SHORT"
    assert code_of([*still_samples()[::-1]]) == "CAPTURE_TOO_SHORT"


def test_a_tip_that_moves_is_rejected() -> None:
    assert code_of([*still_samples(sd_mm=0.8)]) == "CAPTURE_MOVED"
    slid = [
        TipSample(at_s=one.at_s, tip_in_anchor_mm=AT + 0.06 * index, covariance_mm2=one.covariance_mm2)
        for index, one in enumerate(still_samples())
    ]
    assert code_of([*slid]) == "CAPTURE_MOVED"


def test_one_jump_is_rejected_though_the_spread_is_small() -> None:
    samples = still_samples(count=60, sd_mm=0.02)
    jump = TipSample(
        at_s=samples[30].at_s,
        tip_in_anchor_mm=AT + np.array([1.5, 0.0, 0.0]),
        covariance_mm2=0.04 * np.eye(3),
    )
    assert code_of([*samples[:30], jump, *samples[31:]]) == "CAPTURE_MOVED"


def test_a_tip_that_is_unsure_is_rejected() -> None:
    unsure = [
        TipSample(at_s=one.at_s, tip_in_anchor_mm=one.tip_in_anchor_mm, covariance_mm2=4.0 * np.eye(3))
        for one in still_samples()
    ]
    assert code_of([*unsure]) == "CAPTURE_UNCERTAIN"


def test_the_collector_ends_when_it_has_enough_or_waits_in_vain() -> None:
    collector = LandmarkCollector(CaptureSettings(min_images=10, min_s=0.29))
    over = []
    for sample in still_samples(count=10):
        over.append(collector.is_over)
        collector.take(sample)
    assert [*over, collector.is_over] == [False] * 10 + [True]
    assert isinstance(collector.result(), CapturedLandmark)
    lost = LandmarkCollector()
    lost.take(UnseenSample(at_s=0.0, reason="REFERENCE_UNSEEN"))
    assert lost.is_over
