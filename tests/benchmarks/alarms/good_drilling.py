"""No alarm while all is well, and no chatter of a drill that is held at a limit."""

from tests.benchmarks.alarms.drilled import DrilledTheatre, Told
from tests.benchmarks.tables import Table, number
from tracker.navigation.alarms import Condition

CYCLE_S = 40.0
SIMULATED_SEEDS = range(1, 26)
RENDERED_SEEDS = range(1, 6)
HELD_SEEDS = range(1, 6)
SIMULATED_HZ, RENDERED_HZ = 30.0, 15.0
HELD_S = 60.0


def good_drilling_table() -> Table:
    """A thousand seconds of good drilling, and a part of them rendered and tracked."""
    rows = []
    for name, seeds, rate_hz in (
        ("poses as unsure as stated", SIMULATED_SEEDS, SIMULATED_HZ),
        ("rendered and tracked", RENDERED_SEEDS, RENDERED_HZ),
    ):
        told = Told()
        for seed in seeds:
            theatre = DrilledTheatre(seed)
            conclude = theatre.simulated if rate_hz == SIMULATED_HZ else theatre.rendered()
            theatre.drill(conclude, seconds=CYCLE_S, rate_hz=rate_hz, told=told)
        rows.append(
            [
                name,
                str(len(seeds)),
                number(told.images / rate_hz, 0),
                str(told.images),
                number(told.min_mm),
                str(sum(told.raised_in_roomy.values())),
                str(sum(told.raised.values())),
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


def held_table() -> Table:
    """A drill that stands still at a limit, its pose trembling: how often each alarm is raised."""
    rows = []
    for limit_mm, condition in ((1.0, Condition.CLEARANCE_LOW), (0.0, Condition.BREACH)):
        raised = [raised_while_held(seed, limit_mm, condition, seconds=HELD_S) for seed in HELD_SEEDS]
        rows.append(
            [condition.value, number(limit_mm, 1), str(len(raised)), number(HELD_S, 0), str(max(raised))]
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


def raised_while_held(seed: int, limit_mm: float, condition: Condition, *, seconds: float) -> int:
    """How often an alarm is raised by a drill that is held at its limit."""
    theatre, told = DrilledTheatre(seed, skill="breaching"), Told()
    theatre.drill(theatre.held_at(limit_mm), seconds=seconds, rate_hz=SIMULATED_HZ, told=told)
    return told.raised[condition]
