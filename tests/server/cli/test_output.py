"""An output file is complete or absent, and only regular files are replaced."""

import io
import os
import stat
import threading
from pathlib import Path

import pytest

from server.cli.output import LineWriter, line_writer
from tracker.errors import InvalidInput


def write(target: str | Path, *lines: str, inputs: tuple[Path, ...] = ()) -> None:
    with line_writer(str(target), inputs=inputs, replace=False) as out:
        assert out is not None
        for line in lines:
            out.write(line)


def test_a_file_has_its_name_once_it_is_whole(tmp_path: Path) -> None:
    file = tmp_path / "o.jsonl"
    file.write_text("old\n")
    with line_writer(str(file), inputs=(), replace=True) as out:
        assert out is not None
        out.write("new")
        assert file.read_text() == "old\n"
    assert file.read_text() == "new\n"
    assert list(tmp_path.iterdir()) == [file]


def test_a_file_that_is_there_is_written_over_only_where_that_is_said(tmp_path: Path) -> None:
    file = tmp_path / "o.jsonl"
    file.write_text("old\n")
    with pytest.raises(InvalidInput) as reported:
        write(file, "new")
    assert reported.value.code == "OUTPUT_EXISTS"
    assert str(file) in reported.value.message
    assert "--replace" in reported.value.remedy
    assert (file.read_text(), list(tmp_path.iterdir())) == ("old\n", [file])


def test_an_empty_file_holds_nothing_and_is_written(tmp_path: Path) -> None:
    file = tmp_path / "o.jsonl"
    file.touch()
    write(file, "new")
    assert file.read_text() == "new\n"


def test_what_was_cut_keeps_the_old_file_and_is_named_a_part(tmp_path: Path) -> None:
    file = tmp_path / "o.jsonl"
    file.write_text("old\n")
    output = line_writer(str(file), inputs=(), replace=True)
    out = output.__enter__()
    assert out is not None
    out.write("half")
    assert not output.__exit__(KeyboardInterrupt, KeyboardInterrupt(), None)
    assert file.read_text() == "old\n"
    assert (tmp_path / "o.jsonl.part").read_text() == "half\n"


def test_a_pipe_is_written_into_and_not_replaced(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    read: list[str] = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_text()))
    reader.start()
    write(pipe, "a", "b")
    reader.join()
    assert read == ["a\nb\n"]
    assert stat.S_ISFIFO(pipe.stat().st_mode)


def test_a_link_stays_and_what_it_names_is_written(tmp_path: Path) -> None:
    link, file = tmp_path / "link", tmp_path / "o.jsonl"
    link.symlink_to(file)
    write(link, "a")
    assert link.is_symlink()
    assert file.read_text() == "a\n"


@pytest.mark.parametrize("name", ["video.avi", "link", "./folder/../video.avi"])
def test_what_is_read_is_never_written_over(tmp_path: Path, name: str) -> None:
    video = tmp_path / "video.avi"
    video.write_text("film")
    (tmp_path / "link").symlink_to(video)
    (tmp_path / "folder").mkdir()
    with pytest.raises(InvalidInput) as reported:
        write(tmp_path / name, "a", inputs=(tmp_path / "absent", video))
    assert reported.value.code == "OUTPUT_IS_INPUT"
    assert video.read_text() == "film"


def test_the_part_does_not_overwrite_what_is_read_either(tmp_path: Path) -> None:
    video = tmp_path / "o.part"
    video.write_text("film")
    with pytest.raises(InvalidInput):
        write(tmp_path / "o", "a", inputs=(video,))
    assert video.read_text() == "film"


class FullDisk(io.StringIO):
    def write(self, _text: str) -> int:
        raise OSError(28, "No space left on device")


def test_a_full_disk_is_reported_in_a_sentence() -> None:
    with pytest.raises(InvalidInput) as reported:
        LineWriter(FullDisk(), name="o.jsonl.part", on_disk=False).write("a")
    assert reported.value.code == "OUTPUT_NOT_WRITTEN"
    assert "no space left on device" in reported.value.message
