"""False alarms during good drilling, and repeated alarms of a drill at a limit."""

from tests.benchmarks.alarms.drilling_theatre import AlarmCounts, DrillingTheatre
from tests.benchmarks.tables import Table, number
from tracker.navigation.alarms import Condition

CYCLE_S = 40.0
SIMULATED_SEEDS = range(1, 26)
RENDERED_SEEDS = range(1, 6)
STATIONARY_SEEDS = range(1, 6)
SIMULATED_HZ, RENDERED_HZ = 30.0, 15.0
STATIONARY_S = 60.0


def good_drilling_table() -> Table:
    """Table of 1000 s of good drilling, partly rendered and tracked."""
    rows = []
    for name, seeds, rate_hz in (
        ("poses as unsure as stated", SIMULATED_SEEDS, SIMULATED_HZ),
        ("rendered and tracked", RENDERED_SEEDS, RENDERED_HZ),
    ):
        counts = AlarmCounts()
        for seed in seeds:
            theatre = DrillingTheatre(seed)
            conclude = theatre.simulated if rate_hz == SIMULATED_HZ else theatre.rendered()
            theatre.drill(conclude, seconds=CYCLE_S, rate_hz=rate_hz, counts=counts)
        rows.append(
            [
                name,
                str(len(seeds)),
                number(counts.images / rate_hz, 0),
                str(counts.images),
                number(counts.min_mm),
                str(sum(counts.raised_while_clear.values())),
                str(sum(counts.raised.values())),
            ]
        )
    return Table(
        title="Good drilling, registered by landmarks that were touched with 0.3 mm of error",
        columns=[
            "",
            "theatres",
            "seconds",
            "images",
            "least true clearance mm",
            "alarms with true clearance over the warning distance",
            "alarms at all",
        ],
        rows=rows,
    )


def stationary_drill_table() -> Table:
    """Table of the alarms raised by a drill that stands still at a limit, with pose noise."""
    rows = []
    for limit_mm, condition in ((1.0, Condition.CLEARANCE_LOW), (0.0, Condition.BREACH)):
        raised = [
            raised_while_stationary(seed, limit_mm, condition, seconds=STATIONARY_S)
            for seed in STATIONARY_SEEDS
        ]
        rows.append(
            [
                condition.value,
                number(limit_mm, 1),
                str(len(raised)),
                number(STATIONARY_S, 0),
                str(max(raised)),
            ]
        )
    return Table(
        title="A drill held exactly at a limit",
        columns=["alarm", "clearance mm", "theatres", "seconds each", "raised, most"],
        rows=rows,
        note=(
            "A breach is raised once, and stands. A warning is confirmed by half a second in a row, which a "
            "tremor at the very limit hardly gives."
        ),
    )


def raised_while_stationary(seed: int, limit_mm: float, condition: Condition, *, seconds: float) -> int:
    """Return how often an alarm is raised by a drill that stands still at its limit."""
    theatre, counts = DrillingTheatre(seed, skill="breaching"), AlarmCounts()
    theatre.drill(theatre.stationary_at(limit_mm), seconds=seconds, rate_hz=SIMULATED_HZ, counts=counts)
    return counts.raised[condition]
