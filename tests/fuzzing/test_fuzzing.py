"""A short round of the fuzzing, always the same; and faults of each kind are found."""

import faulthandler
import random
import signal
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tests.fuzzing import campaign
from tests.fuzzing.campaign import outcome_of, run
from tests.fuzzing.mutation import mutated
from tests.fuzzing.targets import TARGETS, Target, in_memory
from tracker.errors import InvalidInput

# Those whose seeds or inputs take the most processor time are left to `make fuzz`.
SLOW = {"recording-messages", "certificate-signed", "labels-nifti", "labels-seg", "mesh-stl"}
INPUTS = 8


@pytest.mark.parametrize(
    "target", [one for one in TARGETS if one.name not in SLOW], ids=lambda target: target.name
)
def test_changed_bytes_are_read_or_rejected_with_an_error_for_people(target: Target, tmp_path: Path) -> None:
    rng, seeds = random.Random(3), list(target.seeds())
    with target.opened(tmp_path) as read:
        for content in (*seeds, *(mutated(rng.choice(seeds), seeds, rng) for _ in range(INPUTS))):
            assert not outcome_of(target, read, content).problem


def _is_seed(content: bytes) -> None:
    assert content == b"seed"


def crash() -> None:
    # The traceback of this crash would look like one of the tests.
    faulthandler.disable()
    signal.raise_signal(signal.SIGSEGV)


def hang() -> None:
    while True:
        pass


def fill_memory() -> None:
    # Written, because untouched pages take none.
    np.ones(2**23).sum()


def fail() -> None:
    raise KeyError("rows")


def reject_without_remedy() -> None:
    raise InvalidInput("X", "it is wrong", "")


def reject_with_half_a_character() -> None:
    raise InvalidInput("X", "the file has '\ud800'", "Give another one.")


@pytest.mark.parametrize(
    ("fault", "kind"),
    [
        pytest.param(crash, "crash (SIGSEGV)", id="crash"),
        pytest.param(hang, "hang", id="hang"),
        pytest.param(fill_memory, "memory", id="memory"),
        pytest.param(fail, "error", id="error-of-a-library"),
        pytest.param(reject_without_remedy, "error", id="no-remedy"),
        pytest.param(reject_with_half_a_character, "error", id="not-to-be-sent"),
    ],
)
def test_a_fault_is_found_with_its_input(
    fault: Callable[[], None], kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(campaign, "MAX_SECONDS", 0.2)
    monkeypatch.setattr(campaign, "MAX_RESIDENT_MB", 30.0)

    def read(content: bytes) -> None:
        if content != b"seed":
            fault()

    target = Target(name="faulty", seeds=lambda: [b"seed"], opened=in_memory(read))
    result = run(target, seconds=60.0, seed=1, max_findings=1)
    found = result.findings[0]
    assert (found.target, found.kind) == ("faulty", kind)
    assert outcome_of(target, _is_seed, found.content).problem


def test_an_input_that_ends_in_a_new_way_becomes_a_seed() -> None:
    def read(content: bytes) -> None:
        if len(content) > 4:
            raise InvalidInput("TOO_LONG", "it is too long", "Shorten it.")

    target = Target(name="short", seeds=lambda: [b"seed"], opened=in_memory(read))
    result = run(target, seconds=60.0, seed=1, max_inputs=200)
    assert len(result.corpus) == 3
    assert sum(len(one) > 4 for one in result.corpus) == 1
    assert result.findings == []


def test_changes_follow_from_the_seed_alone() -> None:
    first, second = (
        [mutated(b'{"a": [1, 2.5, "x"]}', [b"abc"], rng) for _ in range(300)]
        for rng in (random.Random(8), random.Random(8))
    )
    assert first == second
    assert len(set(first)) > 200
