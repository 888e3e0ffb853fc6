"""`kill -9` of a whole server that records: its file is readable and replayed exactly.

How much is lost depends on the load of the machine; the command of `killed_recordings` measures it.
"""

from pathlib import Path

import pytest

from tests.procedure.killed_recordings import RecordedOperation


@pytest.mark.timeout(900)
def test_a_killed_server_leaves_a_recording_that_is_replayed_exactly(tmp_path: Path) -> None:
    operation = RecordedOperation(tmp_path / "operation")
    try:
        one = operation.kill_once("all", images=20)
    finally:
        operation.end()
    assert one.broken == []
    assert one.steps > 0
