"""How much must be explained of a square in poor light, by how sharp and how wide it is."""

import numpy as np
import pytest

from tests.tracker.scenes import code_model
from tracker.marker import Explanation
from tracker.marker.explanation.acceptance import BesideNoise

NOTHING_HIDDEN = np.zeros((30, 30), np.bool_)


def _explanation(
    *, side_px: float, blur_ratio: tuple[float, float], correlation: float = 0.9, beside: float = 0.96
) -> Explanation:
    return Explanation(
        side_px=side_px,
        correlation=correlation,
        inner_correlation=correlation,
        hidden_ratio=0.0,
        inner_hidden_ratio=0.0,
        inner_untold_ratio=0.0,
        inside_ratio=0.0,
        corners_px=code_model().corners_mm[:, :2],
        moved_px=0.0,
        blur_px=(blur_ratio[0] * side_px, blur_ratio[1] * side_px),
        hidden=NOTHING_HIDDEN,
        beside_noise=BesideNoise(correlation=beside, inner_correlation=beside, flipped_ratio=0.0),
    )


@pytest.mark.parametrize(
    ("side_px", "blur_ratio", "explains"),
    [
        (27.0, (0.05, 0.055), True),
        (27.0, (0.056, 0.075), False),
        (21.0, (0.05, 0.055), False),
        (27.0, (0.03, 0.10), True),
        (27.0, (0.03, 0.11), False),
    ],
    ids=["sharp", "soft", "small", "smeared", "too smeared"],
)
def test_the_sharper_and_wider_a_square_is_the_more_noise_may_be_on_it(
    side_px: float, blur_ratio: tuple[float, float], explains: bool
) -> None:
    assert _explanation(side_px=side_px, blur_ratio=blur_ratio).explains is explains


def test_a_sharper_square_is_never_refused_where_a_softer_one_is_taken() -> None:
    for side_px in (18.0, 20.0, 22.0, 25.0, 30.0, 60.0):
        for both in np.arange(1.80, 2.0, 0.01):
            taken = [
                _explanation(
                    side_px=side_px, blur_ratio=(one, one), correlation=both - 0.97, beside=0.97
                ).explains
                for one in (0.02, 0.05, 0.054, 0.057, 0.0595, 0.061)
            ]
            assert taken == sorted(taken, reverse=True), (side_px, both, taken)


def test_of_what_is_soft_one_way_and_smeared_the_other_none_is_believed() -> None:
    for blur_ratio, explains in (((0.06, 0.08), True), ((0.06, 0.095), False)):
        one = _explanation(side_px=27.0, blur_ratio=blur_ratio, correlation=0.97, beside=0.99)
        assert one.explains is explains
