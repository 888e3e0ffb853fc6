"""Adaptive size: reduced at once on a slow connection, raised on an idle one, without oscillation."""

import itertools

import pytest

from server.stream.scaling.adaptive_size import AdaptiveSize
from server.stream.scaling.sizes import ChoiceUnknown, PictureSize, SizeChoice, choice_from_text

RATE_HZ = 30.0
FULL_BYTES = 130_000.0
BYTES = {
    PictureSize.FULL: FULL_BYTES,
    PictureSize.HALF: FULL_BYTES / 3.0,
    PictureSize.QUARTER: FULL_BYTES / 9.0,
}


class Thin:
    """A connection of this bandwidth, over which pictures are sent one at a time, newest first."""

    def __init__(self, adaptive_size: AdaptiveSize) -> None:
        self.adaptive_size = adaptive_size
        self.now_s = 0.0
        self.sizes: list[tuple[float, PictureSize]] = []

    def carry(self, *, bytes_per_s: float, seconds: float) -> None:
        until_s = self.now_s + seconds
        while self.now_s < until_s:
            size = self.adaptive_size.size
            if not self.sizes or self.sizes[-1][1] is not size:
                self.sizes.append((self.now_s, size))
            took_s = BYTES[size] / bytes_per_s
            self.adaptive_size.sent(
                began_s=self.now_s, ended_s=self.now_s + took_s, missed=max(0, int(took_s * RATE_HZ) - 1)
            )
            # The next image is waited for.
            self.now_s += max(took_s, 1.0 / RATE_HZ)


@pytest.mark.parametrize(
    ("mbit_per_s", "carried"),
    [
        pytest.param(1.0, PictureSize.QUARTER, id="1 Mbit/s"),
        pytest.param(10.0, PictureSize.HALF, id="10 Mbit/s"),
        pytest.param(100.0, PictureSize.FULL, id="100 Mbit/s"),
    ],
)
def test_a_connection_gets_the_largest_size_at_half_the_rate_or_more(
    mbit_per_s: float, carried: PictureSize
) -> None:
    line = Thin(AdaptiveSize())
    line.carry(bytes_per_s=mbit_per_s * 125_000.0, seconds=60.0)
    assert line.adaptive_size.size is carried


def test_the_slowest_connection_is_at_the_smallest_size_within_a_few_seconds() -> None:
    line = Thin(AdaptiveSize())
    line.carry(bytes_per_s=125_000.0, seconds=30.0)
    assert [size for _, size in line.sizes] == [PictureSize.FULL, PictureSize.HALF, PictureSize.QUARTER]
    assert line.sizes[-1][0] < 3.5


def test_a_connection_that_gets_faster_gets_larger_pictures_again() -> None:
    line = Thin(AdaptiveSize())
    line.carry(bytes_per_s=125_000.0, seconds=10.0)
    line.carry(bytes_per_s=12_500_000.0, seconds=30.0)
    assert line.adaptive_size.size is PictureSize.FULL


def test_a_connection_between_two_sizes_does_not_oscillate() -> None:
    # Idle enough at half size to try full size, of which it carries less than half.
    adaptive_size = AdaptiveSize()
    now_s, sizes = 0.0, []
    while now_s < 600.0:
        size = adaptive_size.size
        sizes.append(size)
        took_s, missed = (0.08, 2) if size is PictureSize.FULL else (0.005, 0)
        adaptive_size.sent(began_s=now_s, ended_s=now_s + took_s, missed=missed)
        now_s += max(took_s, 1.0 / RATE_HZ)
    changes = sum(one is not other for one, other in itertools.pairwise(sizes))
    # Increasing intervals: 5, 10, 20, 40, 80, 80 ... s after each failed attempt.
    assert 10 <= changes <= 25


def test_a_viewer_that_is_idle_between_images_keeps_its_size() -> None:
    adaptive_size = AdaptiveSize()
    for second in range(60):
        # One request per second: 29 images are skipped, none of them because of the connection.
        adaptive_size.sent(began_s=float(second), ended_s=second + 0.03, missed=29)
    assert adaptive_size.size is PictureSize.FULL


def test_what_was_chosen_stays_whatever_the_connection_does() -> None:
    line = Thin(AdaptiveSize(SizeChoice.FULL))
    line.carry(bytes_per_s=125_000.0, seconds=20.0)
    sizes = [line.adaptive_size.size]
    for choice in (SizeChoice.HALF, SizeChoice.AUTO):
        line.adaptive_size.choose(choice)
        sizes.append(line.adaptive_size.size)
    line.carry(bytes_per_s=125_000.0, seconds=5.0)
    assert [*sizes, line.adaptive_size.size] == [
        PictureSize.FULL,
        PictureSize.HALF,
        PictureSize.HALF,
        PictureSize.QUARTER,
    ]


def test_an_unknown_size_is_rejected_with_the_known_ones() -> None:
    with pytest.raises(ChoiceUnknown, match="no size 'tiny', available are auto, full, half, quarter"):
        choice_from_text("size", "tiny", SizeChoice)


def test_a_viewer_that_cannot_show_more_gets_no_more_and_less_on_a_slow_connection() -> None:
    line = Thin(AdaptiveSize())
    line.adaptive_size.limit(PictureSize.HALF)
    line.carry(bytes_per_s=1e8, seconds=2.0)
    sizes = [line.adaptive_size.size]
    line.carry(bytes_per_s=1e6 / 8, seconds=10.0)
    sizes.append(line.adaptive_size.size)
    # An explicitly requested size is sent.
    line.adaptive_size.choose(SizeChoice.FULL)
    assert [*sizes, line.adaptive_size.size] == [PictureSize.HALF, PictureSize.QUARTER, PictureSize.FULL]
