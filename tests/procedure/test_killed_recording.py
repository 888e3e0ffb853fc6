"""`kill -9` of a whole server that records: less than a second is lost, and the rest is replayed exactly."""

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
    assert one.images >= 5
    assert one.steps > 0
