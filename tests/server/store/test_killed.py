"""`kill -9` while the store is writing: confirmed data exists, and the next start is clean."""

import random
from pathlib import Path

from tests.server.store.killed import Promised, Writers, broken_promises

KILLS = 12


def test_killed_at_any_moment_nothing_that_was_confirmed_is_lost(tmp_path: Path) -> None:
    promised, rng = Promised(), random.Random(7)
    with Writers() as writers:
        for number in range(KILLS):
            changes, after_s = rng.randrange(5), rng.uniform(0.0, 0.05)
            writers.kill_once(tmp_path, promised, after_changes=changes, after_s=after_s, seed=number)
            assert list(broken_promises(tmp_path, promised)) == [], number
    assert promised.count > KILLS
