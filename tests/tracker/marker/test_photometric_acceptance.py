"""Acceptance limits of photometric verification by sharpness and size."""

import numpy as np
import pytest

from tests.tracker.scenes import code_model
from tracker.marker import PhotometricFit
from tracker.marker.photometric_fit.acceptance import NoiseCorrectedFit

NOTHING_HIDDEN = np.zeros((30, 30), np.bool_)


def _fit(
    *, side_px: float, blur_ratio: tuple[float, float], correlation: float = 0.9, beside: float = 0.96
) -> PhotometricFit:
    return PhotometricFit(
        side_px=side_px,
        correlation=correlation,
        inner_correlation=correlation,
        occluded_ratio=0.0,
        inner_occluded_ratio=0.0,
        inner_unobserved_ratio=0.0,
        inside_ratio=0.0,
        corners_px=code_model().corners_mm[:, :2],
        moved_px=0.0,
        blur_px=(blur_ratio[0] * side_px, blur_ratio[1] * side_px),
        occluded=NOTHING_HIDDEN,
        noise_corrected=NoiseCorrectedFit(correlation=beside, inner_correlation=beside, inverted_ratio=0.0),
    )


@pytest.mark.parametrize(
    ("side_px", "blur_ratio", "accepted"),
    [
        (27.0, (0.05, 0.055), True),
        (27.0, (0.056, 0.075), False),
        (21.0, (0.05, 0.055), False),
        (27.0, (0.03, 0.10), True),
        (27.0, (0.03, 0.11), False),
    ],
    ids=["sharp", "soft", "small", "motion blur", "too much motion blur"],
)
def test_sharper_and_wider_squares_may_have_more_noise(
    side_px: float, blur_ratio: tuple[float, float], accepted: bool
) -> None:
    assert _fit(side_px=side_px, blur_ratio=blur_ratio).is_accepted is accepted


def test_acceptance_is_monotonic_in_sharpness() -> None:
    for side_px in (18.0, 20.0, 22.0, 25.0, 30.0, 60.0):
        for both in np.arange(1.80, 2.0, 0.01):
            taken = [
                _fit(side_px=side_px, blur_ratio=(one, one), correlation=both - 0.97, beside=0.97).is_accepted
                for one in (0.02, 0.05, 0.054, 0.057, 0.0595, 0.061)
            ]
            assert taken == sorted(taken, reverse=True), (side_px, both, taken)


def test_defocus_with_motion_blur_is_rejected() -> None:
    for blur_ratio, accepted in (((0.06, 0.08), True), ((0.06, 0.095), False)):
        one = _fit(side_px=27.0, blur_ratio=blur_ratio, correlation=0.97, beside=0.99)
        assert one.is_accepted is accepted
