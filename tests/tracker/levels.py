"""What the tests near the limit assert beside the goal, and the scenes on which they do."""

from typing import NamedTuple

# `make benchmark` measures with other seeds.
SEED = 500


class Level(NamedTuple):
    """What is asserted, and the goal. Where the goal is reached, both are the same, and it stays so."""

    asserted: float
    goal: float
