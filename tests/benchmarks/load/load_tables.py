"""What viewers cost, and what they get, as tables."""

import itertools
from collections import Counter
from collections.abc import Sequence

from tests.benchmarks.asked import Asked
from tests.benchmarks.load.run import Gauge, Got, Loaded, with_viewers, without_viewers
from tests.benchmarks.measured import Measured
from tests.benchmarks.running_server import running_server
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
    "`/ws/view`, every fourth MJPEG, every sixth `/ws/live`. All ask for the size that their line carries. "
    "Ages are those of the picture when its last byte is in the viewer's hands."
)


def measure_load(asked: Asked) -> Measured:
    """So many viewers as were asked for, one stretch after the other."""
    seconds = USUAL_SECONDS if asked.seconds == Asked().seconds else asked.seconds
    # A drill that stays in view: a search for one that is gone takes longer, whoever watches.
    stays = {"skill": "good"}
    with running_server(asked, seed=asked.seeds[0], live_rate_hz=RATE_HZ, rehearsal=stays) as server:
        gauge = Gauge(server)
        gauge.await_first()
        alone, loaded = [without_viewers(gauge, seconds=seconds)], []
        for viewers in asked.viewers:
            loaded.append(with_viewers(server, gauge, viewers, seconds=seconds))
            alone.append(without_viewers(gauge, seconds=seconds))
        gauge.close()
    return Measured(tables=load_tables(alone, loaded))


def load_tables(alone: Sequence[Loaded], loaded: Sequence[Loaded]) -> list[Table]:
    """The tables of stretches with viewers, each between two of `alone`."""
    around = [[*before.tracker_ms, *after.tracker_ms] for before, after in itertools.pairwise(alone)]
    rows = list(zip(loaded, around, strict=True))
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
                "let go",
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
            rows=[_gain_row(one) for one in loaded],
        ),
    ]


def growth(values: Sequence[float], than: Sequence[float], percent: float) -> str:
    """By how much a percentile grew: `+12 %`."""
    return f"{100.0 * (percentile(values, percent) / percentile(than, percent) - 1.0):+.0f} %"


def _cost_row(one: Loaded, none_ms: Sequence[float]) -> list[str]:
    start, end = one.resident_mb
    return [
        str(one.viewers),
        pair(one.tracker_ms, 99.0, 1),
        pair(none_ms, 99.0, 1),
        growth(one.tracker_ms, none_ms, 50.0),
        growth(one.tracker_ms, none_ms, 99.0),
        f"{100.0 * one.cpu_ratio['web']:.0f} %" if "web" in one.cpu_ratio else NOTHING,
        f"{number(start, 0)} / {number(end, 0)}",
        str(one.let_go),
        NOTHING if one.stalled_s is None else number(one.stalled_s, 1),
    ]


def _gain_row(one: Loaded) -> list[str]:
    pictured = [got for got in one.got if got.kind != "live"]
    rates = [got.images_per_s for got in pictured]
    thin = [] if one.thin is None else [one.thin]
    return [
        str(one.viewers),
        f"{number(median(rates), 1)} / {number(min(rates), 1)}",
        pair([age for got in pictured for age in got.ages_ms], 99.0, 0),
        number(sum(got.total_bytes / got.seconds for got in one.got) / 1e6, 1),
        _sizes(pictured),
        number(thin[0].images_per_s, 1) if thin else NOTHING,
        pair([age for got in thin for age in got.ages_ms], 99.0, 0),
        _sizes(thin),
    ]


def _sizes(some: Sequence[Got]) -> str:
    counts = Counter(scale for got in some for scale in got.scales if scale is not None)
    total = sum(counts.values())
    shares = [
        f"{word} {100.0 * counts[scale] / total:.0f} %" for scale, word in SIZE_WORDS.items() if counts[scale]
    ]
    return ", ".join(shares) or NOTHING
