"""Writing a recording: what is on disk at which time, and when writing stops."""

import errno
import io
from pathlib import Path

import pytest

from server.errors import RecordingError
from server.recording_file import RecordingReader, RecordingWriter, Topic, WriterLimits
from tests.server.recording_file.written import NO_LIMITS, OFFSET_S, made_writer, write_images


def readable(path: Path) -> int:
    return sum(message.topic is Topic.IMAGE for message in RecordingReader(path).messages())


def test_a_killed_writer_has_lost_less_than_a_second(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    writer = made_writer(path)
    # Ten images a second; nothing is closed.
    write_images(writer, 35)
    assert 35 - readable(path) <= 5
    writer.close()
    assert readable(path) == 35


def test_a_recording_above_its_budget_stops_and_can_still_be_closed(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    writer = made_writer(path, WriterLimits(max_bytes=3000, min_free_bytes=0))
    with pytest.raises(RecordingError) as stopped:
        write_images(writer, 100)
    assert stopped.value.code == "RECORDING_BUDGET_EXCEEDED"
    writer.close()
    reader = RecordingReader(path)
    assert 0 < sum(message.topic is Topic.IMAGE for message in reader.messages()) < 100
    assert reader.is_whole


def test_a_recording_stops_before_the_disk_is_full(tmp_path: Path) -> None:
    free = [3_000_000_000, 1_900_000_000]
    writer = RecordingWriter(
        tmp_path / "a.mcap",
        limits=WriterLimits(max_bytes=1e12, min_free_bytes=2e9),
        unix_offset_s=OFFSET_S,
        library="test",
        free_bytes=lambda _: free.pop(0) if len(free) > 1 else free[0],
    )
    writer.register(Topic.NOTE)
    with pytest.raises(RecordingError) as stopped:
        write_images(writer, 100)
    assert stopped.value.code == "RECORDING_DISK_FULL"
    assert "1.90 GB are free" in stopped.value.message
    writer.close()


class FullDisk(io.FileIO):
    """A file on a disk that is full after some bytes."""

    left = 2500

    def write(self, content: object, /) -> int:
        data = memoryview(content)  # pyrefly: ignore[bad-argument-type]
        if self.left == 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        # A nearly full disk accepts a part of it.
        done = super().write(data[: min(self.left, len(data))])
        self.left -= done
        return done


def test_a_full_disk_stops_the_recording_and_what_was_written_is_readable(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    writer = RecordingWriter(
        path,
        limits=NO_LIMITS,
        unix_offset_s=OFFSET_S,
        library="test",
        open_file=lambda path: FullDisk(str(path), "xb"),
    )
    writer.register(Topic.NOTE)
    with pytest.raises(RecordingError) as stopped:
        write_images(writer, 100)
    assert stopped.value.code == "RECORDING_NOT_WRITTEN"
    assert "the disk is full" in stopped.value.message
    with pytest.raises(RecordingError):
        writer.close()
    assert 0 < readable(path) < 100


def test_a_file_that_exists_is_not_written_over(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    path.write_bytes(b"older")
    with pytest.raises(RecordingError, match="file exists"):
        made_writer(path)
    assert path.read_bytes() == b"older"
