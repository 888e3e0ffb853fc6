"""A power cut at any sync of the store: confirmed data exists, deleted cases do not, the start is clean."""

import sys
from pathlib import Path

import pytest

from tests.server.store.disk_model import can_record
from tests.server.store.power_cut import cut_power, fault_of

pytestmark = pytest.mark.skipif(
    sys.platform != "linux" or not can_record(), reason="SQLite is not a library of its own here"
)
# Its changes are cases, documents and files, and a case that is deleted.
SEED, CHANGES = 29, 9
# Its few cuts are at syncs that each of the faults leaves out.
SEED_OF_FAULTS = 3


def test_after_a_power_cut_what_was_confirmed_is_there_and_what_was_deleted_is_not(tmp_path: Path) -> None:
    result = cut_power(tmp_path, changes=CHANGES, seed=SEED, share_ratio=0.4)
    assert result.broken == []
    assert result.cuts > CHANGES


@pytest.mark.parametrize("fault", ["no-sync", "no-folder-sync", "no-commit-sync"])
def test_a_store_that_does_not_wait_for_the_disk_is_found(tmp_path: Path, fault: str) -> None:
    with fault_of(fault):
        assert cut_power(tmp_path, changes=6, seed=SEED_OF_FAULTS, share_ratio=0.3).broken != []
