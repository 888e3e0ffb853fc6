"""`kill -9` of the web process, the tracking process, and both, during navigation: everything is restored."""

import random
from pathlib import Path

import pytest

from tests.procedure.killed import TARGETS, Theatre


@pytest.mark.timeout(900)
def test_killed_in_a_procedure_it_comes_back_into_case_and_step_and_waits_for_a_person(
    tmp_path: Path,
) -> None:
    rng = random.Random(5)
    theatre = Theatre(tmp_path / "theatre", reference=True, rng=rng, empty=False)
    try:
        reported = {target: theatre.kill_once(target, after_s=rng.uniform(0.2, 2.0)) for target in TARGETS}
    finally:
        theatre.end()
    assert {target: one.broken for target, one in reported.items()} == {target: [] for target in TARGETS}
    assert sum(one.confirmed for one in reported.values()) > 0
    # A registration relative to the patient marker continues if only tracking restarted.
    assert reported["web"].stopped_by == reported["both"].stopped_by == "server_started"
    assert reported["tracking"].stopped_by == "-"
