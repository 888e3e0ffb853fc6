"""The rehearsal on one machine without a graphics card for server and browser, with the default limits.

`python -m tests.benchmarks.first_page` measures it on an idle machine.

"""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser

from tests.benchmarks.first_page.processes import OTHER_WORK
from tests.benchmarks.first_page.report import MIN_WIDTH_PX, PageMeasurement
from tests.benchmarks.first_page.screen import measured_screen
from tests.benchmarks.options import BenchmarkOptions
from tests.benchmarks.running_server import RunningServer, running_server

pytestmark = pytest.mark.browser

# The goal is 99 % and 15 images/s. A slow machine reaches less: its pictures become fewer, down to 6 per
# second, before its figures become old. Earlier faults left 30 to 60 %.
MIN_LIVE_RATIO, MIN_IMAGES_PER_S = 0.75, 5.0
# Share of a core used by others, above which nothing can be concluded. `make test` runs this test alone.
MAX_OTHER_WORK = 0.3
WINDOW_S, SETTLING_S, WINDOWS = 6.0, 6.0, 3
# The screen with the most pixels; the benchmark measures a tablet's and a phone's too.
SIZE_PX = (1920, 1080)


@pytest.fixture(scope="module")
def rehearsal() -> Iterator[RunningServer]:
    """`coaxial run` with the rehearsal."""
    with running_server(BenchmarkOptions(), seed=1, live_rate_hz=30.0) as server:
        yield server


def test_figures_are_live_and_the_picture_moves_on_two_cores(
    browser: Browser, rehearsal: RunningServer
) -> None:
    seen: list[PageMeasurement] = []
    while len(seen) < WINDOWS and not any(_is_good(one) for one in seen):
        one = measured_screen(browser, rehearsal, SIZE_PX, seconds=WINDOW_S, settling_s=SETTLING_S)
        assert one.min_width_px >= MIN_WIDTH_PX
        seen.append(one)
    other_work = [one.processor_use[OTHER_WORK] for one in seen]
    is_good = any(_is_good(one) for one in seen)
    if not is_good and min(other_work) > MAX_OTHER_WORK:
        pytest.skip(f"other programs took at least {min(other_work):.0%} of a core")
    assert is_good, [(one.live_ratio, one.images_per_s, one.processor_use) for one in seen]


def _is_good(one: PageMeasurement) -> bool:
    return one.live_ratio >= MIN_LIVE_RATIO and one.images_per_s >= MIN_IMAGES_PER_S
