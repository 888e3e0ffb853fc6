"""The image period follows from the image times, and the allowed gap from the period."""

import pytest

from tracker.pose.image_rate import GapLimit, image_period_s


@pytest.mark.parametrize(
    ("times_s", "period_s"),
    [
        pytest.param([], None, id="no-image"),
        pytest.param([1.0], None, id="one-image"),
        pytest.param([1.0, 1.2], 0.2, id="one-interval"),
        pytest.param([1.0, 1.1, 2.0], 0.1, id="of-two-intervals-the-shorter"),
        pytest.param([1.0, 1.1, 1.2, 2.0], 0.1, id="a-gap-is-not-the-period"),
        pytest.param([1.0, 1.0, 1.2], 0.2, id="the-same-image-twice"),
        pytest.param([2.0, 1.0], None, id="time-runs-backwards"),
    ],
)
def test_the_period_is_the_median_interval(times_s: list[float], period_s: float | None) -> None:
    assert image_period_s(times_s) == (None if period_s is None else pytest.approx(period_s))


def test_too_few_intervals_give_no_period() -> None:
    assert image_period_s([1.0, 1.2, 1.4], min_intervals=3) is None
    assert image_period_s([1.0, 1.2, 1.4, 1.6], min_intervals=3) == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("period_s", "allowed_s"),
    [
        pytest.param(None, 0.25, id="unknown"),
        pytest.param(1 / 60, 0.25, id="60-hz"),
        pytest.param(1 / 30, 0.25, id="30-hz"),
        pytest.param(0.1, 0.6, id="10-hz"),
        pytest.param(0.2, 1.0, id="5-hz"),
        pytest.param(0.5, 1.0, id="2-hz"),
    ],
)
def test_the_allowed_gap_follows_the_period_between_its_bounds(
    period_s: float | None, allowed_s: float
) -> None:
    assert GapLimit().allowed_s(period_s) == pytest.approx(allowed_s)


def test_a_stricter_maximum_holds_at_every_rate() -> None:
    assert GapLimit(max_s=0.1).allowed_s(1 / 60) == 0.1
    assert GapLimit(max_s=0.1).allowed_s(None) == 0.1
