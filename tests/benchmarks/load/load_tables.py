"""Tables of the cost of viewers to the server, and of what they receive."""

import itertools
from collections import Counter
from collections.abc import Sequence

from tests.benchmarks.load.run import LoadResult, TrackerTimes, ViewerResult, with_viewers, without_viewers
from tests.benchmarks.options import BenchmarkOptions
from tests.benchmarks.running_server import running_server
from tests.benchmarks.section_result import SectionResult
from tests.benchmarks.tables import NOTHING, Table, median, number, pair, percentile

RATE_HZ = 30.0
USUAL_SECONDS = 20.0
GOAL = "at most +20 %"
SIZE_WORDS = {1.0: "full", 0.5: "half", 0.25: "quarter"}
NOTE = (
    "The drill is held along its channel, in view all the time. "
    "Tracker: time of the tracking process for one image, waiting left out; growth is against no viewer, "
    "measured before and after each row in the same run. The viewers are processes on the same two cores, "
    "with lower priority (`nice 10`), and the theatre is rendered there too: a real server has what they "
    "take. In each row of 3 and more, one viewer is stalled and one reads 1 Mbit/s; of the rest most watch "
    "`/ws/view`, every fourth MJPEG, every sixth `/ws/live`. All request the size that their "
    "connection carries. "
    "Ages are those of the picture when its last byte is in the viewer's hands."
)


def measure_load(options: BenchmarkOptions) -> SectionResult:
    """The requested numbers of viewers, one interval after the other."""
    seconds = USUAL_SECONDS if options.seconds == BenchmarkOptions().seconds else options.seconds
    # A drill that stays in view, since a search takes longer regardless of viewers.
    stays = {"skill": "good"}
    with running_server(options, seed=options.seeds[0], live_rate_hz=RATE_HZ, rehearsal=stays) as server:
        tracker_times = TrackerTimes(server)
        tracker_times.await_first()
        alone, with_load = [without_viewers(tracker_times, seconds=seconds)], []
        for viewers in options.viewers:
            with_load.append(with_viewers(server, tracker_times, viewers, seconds=seconds))
            alone.append(without_viewers(tracker_times, seconds=seconds))
        tracker_times.close()
    return SectionResult(tables=load_tables(alone, with_load))


def load_tables(alone: Sequence[LoadResult], with_load: Sequence[LoadResult]) -> list[Table]:
    """Tables of the intervals with viewers, each between two of `alone`."""
    around = [[*before.tracker_ms, *after.tracker_ms] for before, after in itertools.pairwise(alone)]
    rows = list(zip(with_load, around, strict=True))
    return [
        Table(
            title="What viewers cost",
            columns=[
                "viewers",
                "tracker ms, p50 / p99",
                "with none",
                "growth of p50",
                f"growth of p99, goal {GOAL}",
                "web server, of a core",
                "memory MB, start / end",
                "disconnected",
                "the stalled one, after s",
            ],
            rows=[_cost_row(one, none_ms) for one, none_ms in rows],
            note=NOTE,
        ),
        Table(
            title="What they get",
            columns=[
                "viewers",
                "images/s each, median / least",
                "age ms, p50 / p99",
                "MB/s, all",
                "sizes",
                "1 Mbit/s: images/s",
                "its age ms, p50 / p99",
                "its sizes",
            ],
            rows=[_gain_row(one) for one in with_load],
        ),
    ]


def growth(values: Sequence[float], than: Sequence[float], percent: float) -> str:
    """Growth of a percentile: `+12 %`."""
    return f"{100.0 * (percentile(values, percent) / percentile(than, percent) - 1.0):+.0f} %"


def _cost_row(one: LoadResult, none_ms: Sequence[float]) -> list[str]:
    start, end = one.resident_mb
    return [
        str(one.viewers),
        pair(one.tracker_ms, 99.0, 1),
        pair(none_ms, 99.0, 1),
        growth(one.tracker_ms, none_ms, 50.0),
        growth(one.tracker_ms, none_ms, 99.0),
        f"{100.0 * one.cpu_ratio['web']:.0f} %" if "web" in one.cpu_ratio else NOTHING,
        f"{number(start, 0)} / {number(end, 0)}",
        str(one.disconnected),
        NOTHING if one.stalled_s is None else number(one.stalled_s, 1),
    ]


def _gain_row(one: LoadResult) -> list[str]:
    pictured = [received for received in one.received if received.kind != "live"]
    rates = [received.images_per_s for received in pictured]
    slow = [] if one.slow is None else [one.slow]
    return [
        str(one.viewers),
        f"{number(median(rates), 1)} / {number(min(rates), 1)}",
        pair([age for received in pictured for age in received.ages_ms], 99.0, 0),
        number(sum(received.total_bytes / received.seconds for received in one.received) / 1e6, 1),
        _sizes(pictured),
        number(slow[0].images_per_s, 1) if slow else NOTHING,
        pair([age for received in slow for age in received.ages_ms], 99.0, 0),
        _sizes(slow),
    ]


def _sizes(some: Sequence[ViewerResult]) -> str:
    counts = Counter(scale for received in some for scale in received.scales if scale is not None)
    total = sum(counts.values())
    shares = [
        f"{word} {100.0 * counts[scale] / total:.0f} %" for scale, word in SIZE_WORDS.items() if counts[scale]
    ]
    return ", ".join(shares) or NOTHING
