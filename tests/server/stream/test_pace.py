"""Which size a line carries: down at once where it is too thin, up when it is idle, and no flapping."""

import itertools

import pytest

from server.stream.fitting.pace import Pace
from server.stream.fitting.sizes import Choice, Size, SizeUnknown, choice_from_text

RATE_HZ = 30.0
FULL_BYTES = 130_000.0
BYTES = {Size.FULL: FULL_BYTES, Size.HALF: FULL_BYTES / 3.0, Size.QUARTER: FULL_BYTES / 9.0}


class Thin:
    """A line of so many bytes a second, over which pictures go one at a time, newest first."""

    def __init__(self, pace: Pace) -> None:
        self.pace = pace
        self.now_s = 0.0
        self.sizes: list[tuple[float, Size]] = []

    def carry(self, *, bytes_per_s: float, seconds: float) -> None:
        until_s = self.now_s + seconds
        while self.now_s < until_s:
            size = self.pace.size
            if not self.sizes or self.sizes[-1][1] is not size:
                self.sizes.append((self.now_s, size))
            took_s = BYTES[size] / bytes_per_s
            self.pace.sent(
                began_s=self.now_s, ended_s=self.now_s + took_s, missed=max(0, int(took_s * RATE_HZ) - 1)
            )
            # The next image is waited for.
            self.now_s += max(took_s, 1.0 / RATE_HZ)


@pytest.mark.parametrize(
    ("mbit_per_s", "carried"),
    [
        pytest.param(1.0, Size.QUARTER, id="1 Mbit/s"),
        pytest.param(10.0, Size.HALF, id="10 Mbit/s"),
        pytest.param(100.0, Size.FULL, id="100 Mbit/s"),
    ],
)
def test_a_line_gets_the_largest_size_at_half_the_rate_or_more(mbit_per_s: float, carried: Size) -> None:
    line = Thin(Pace())
    line.carry(bytes_per_s=mbit_per_s * 125_000.0, seconds=60.0)
    assert line.pace.size is carried


def test_the_thinnest_line_is_at_the_smallest_size_within_a_few_seconds() -> None:
    line = Thin(Pace())
    line.carry(bytes_per_s=125_000.0, seconds=30.0)
    assert [size for _, size in line.sizes] == [Size.FULL, Size.HALF, Size.QUARTER]
    assert line.sizes[-1][0] < 3.5


def test_a_line_that_gets_wider_gets_larger_pictures_again() -> None:
    line = Thin(Pace())
    line.carry(bytes_per_s=125_000.0, seconds=10.0)
    line.carry(bytes_per_s=12_500_000.0, seconds=30.0)
    assert line.pace.size is Size.FULL


def test_a_line_between_two_sizes_does_not_flap() -> None:
    # Idle enough in the half size to hope for the full one, of which it carries less than half.
    pace = Pace()
    now_s, sizes = 0.0, []
    while now_s < 600.0:
        size = pace.size
        sizes.append(size)
        took_s, missed = (0.08, 2) if size is Size.FULL else (0.005, 0)
        pace.sent(began_s=now_s, ended_s=now_s + took_s, missed=missed)
        now_s += max(took_s, 1.0 / RATE_HZ)
    changes = sum(one is not other for one, other in itertools.pairwise(sizes))
    # Less and less often: 5, 10, 20, 40, 80, 80 ... s after each mistake.
    assert 10 <= changes <= 25


def test_a_viewer_that_is_idle_between_images_keeps_its_size() -> None:
    pace = Pace()
    for second in range(60):
        # Asks once a second only: 29 images are missed, and none of them for the line.
        pace.sent(began_s=float(second), ended_s=second + 0.03, missed=29)
    assert pace.size is Size.FULL


def test_what_was_chosen_stays_whatever_the_line_does() -> None:
    line = Thin(Pace(Choice.FULL))
    line.carry(bytes_per_s=125_000.0, seconds=20.0)
    sizes = [line.pace.size]
    for choice in (Choice.HALF, Choice.AUTO):
        line.pace.choose(choice)
        sizes.append(line.pace.size)
    line.carry(bytes_per_s=125_000.0, seconds=5.0)
    assert [*sizes, line.pace.size] == [Size.FULL, Size.HALF, Size.HALF, Size.QUARTER]


def test_an_unknown_size_is_refused_with_the_known_ones() -> None:
    with pytest.raises(SizeUnknown, match="no size 'tiny', only auto, full, half, quarter"):
        choice_from_text("tiny")


def test_a_viewer_that_cannot_show_more_gets_no_more_and_less_on_a_thin_line() -> None:
    line = Thin(Pace())
    line.pace.limit(Size.HALF)
    line.carry(bytes_per_s=1e8, seconds=2.0)
    sizes = [line.pace.size]
    line.carry(bytes_per_s=1e6 / 8, seconds=10.0)
    sizes.append(line.pace.size)
    # What was asked for by name comes.
    line.pace.choose(Choice.FULL)
    assert [*sizes, line.pace.size] == [Size.HALF, Size.QUARTER, Size.FULL]
