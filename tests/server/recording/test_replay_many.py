"""Many recordings are replayed side by side: each is a row, whatever happens to it."""

import json
import os
import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from distributed import LocalCluster
from typer.testing import CliRunner

from server.cli.commands import app
from server.errors import RecordingError
from server.recording.replay import Difference, ReplayReport
from server.recording.replay_many import Outcome, ReplayRow, ReplayTask, checked_row, cluster_rows, local_rows
from tests.server.recording_file.written import write_recording
from tracker.errors import InvalidInput

ROWS = {"L4/c.mcap": Outcome.FAILED, "a.mcap": Outcome.IDENTICAL, "b.mcap": Outcome.NOT_COMPARED}


@pytest.fixture
def folder(recorded: Path, tmp_path: Path) -> Path:
    """Return a folder with an identical recording, one without results, and a file that is none."""
    path = tmp_path / "recordings"
    (path / "L4").mkdir(parents=True)
    shutil.copy(recorded, path / "a.mcap")
    write_recording(path / "b.mcap", 3)
    (path / "L4" / "c.mcap").write_bytes(b"not a recording")
    return path


def run(*words: str) -> tuple[int, str]:
    """Return the exit status and the output, without logs if the output is JSON."""
    result = CliRunner().invoke(app, ["replay", *words, "--check"], env={"COLUMNS": "200"})
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result.exit_code, result.stdout if "--json" in words else result.output


def test_each_file_is_a_row_of_the_table(folder: Path, tmp_path: Path) -> None:
    table = tmp_path / "table.jsonl"
    code, text = run(str(folder), "--workers", "2", "--table", str(table))
    assert code == 1
    lines = {line.split()[0]: line for line in text.splitlines() if ".mcap" in line}
    assert list(lines) == ["L4/c.mcap", "a.mcap", "b.mcap"]
    assert lines["a.mcap"].split()[1:3] == ["11", "identical"]
    assert "RECORDING_NOT_READABLE" in lines["L4/c.mcap"]
    assert "1 identical, 1 not compared, 1 failed" in text
    rows = [ReplayRow.model_validate_json(line) for line in table.read_text().splitlines()]
    assert {row.file: row.outcome for row in rows} == ROWS
    assert all(len(row.sha256) == 64 for row in rows)


def test_a_process_that_dies_is_a_row_and_the_others_go_on(folder: Path) -> None:
    class Crash(str):
        __slots__ = ()

        def __reduce__(self) -> tuple[object, ...]:
            # Runs where the task is read.
            return os._exit, (7,)

    path = folder / "L4" / "c.mcap"
    crash = ReplayTask(path=Crash(path), name="crash", limits=None)
    other = ReplayTask(path=str(path), name="other", limits=None)
    rows = {row.file: row for row in local_rows([crash, other], workers=1)}
    assert rows["crash"].outcome is rows["other"].outcome is Outcome.FAILED
    assert "status 7" in rows["crash"].problem
    assert "RECORDING_NOT_READABLE" in rows["other"].problem


def test_a_row_names_the_first_image_that_differs_and_the_largest_difference(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    report = ReplayReport(images=9, steps=4, is_whole=True)
    for kind, number, replayed in ((report.poses, 7, 1.5), (report.poses, 5, 1.25), (report.alarms, 6, 3.0)):
        kind.add([Difference(image_number=number, what="x", recorded=1.0, replayed=replayed)])
    monkeypatch.setattr("server.recording.replay_many.check_recording", lambda *_, **__: report)
    row = checked_row(ReplayTask(path=str(folder / "a.mcap"), name="a.mcap", limits=None))
    assert (row.outcome, row.images, row.steps) == (Outcome.DIFFERENT, 9, 4)
    assert row.first is not None
    assert row.worst is not None
    # Each kind keeps its first one in the order of the file: image 7 of the poses, 6 of the alarms.
    assert (row.first.image_number, row.worst.image_number, row.worst.size) == (6, 6, 2.0)


class Runs:
    """Counts which recordings are replayed."""

    def __init__(self) -> None:
        self.names: list[str] = []

    def __call__(self, tasks: Sequence[ReplayTask], **_: object) -> Iterator[ReplayRow]:
        self.names = [task.name for task in tasks]
        return iter([checked_row(task) for task in tasks])


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> Runs:
    """Replay in this process."""
    found = Runs()
    monkeypatch.setattr("server.cli.replay_folder.local_rows", found)
    return found


def test_a_resumed_check_skips_what_is_finished_and_unchanged(
    folder: Path, tmp_path: Path, runs: Runs, monkeypatch: pytest.MonkeyPatch
) -> None:
    table = tmp_path / "table.jsonl"
    resumed = (str(folder), "--table", str(table), "--resume")
    run(*resumed)
    assert runs.names == list(ROWS)
    # A crash while a line was written; and what failed is tried again.
    table.write_text(table.read_text() + '{"file": "b.mc')
    code, text = run(*resumed)
    assert runs.names == ["L4/c.mcap"]
    assert "2 of these from the table file" in text
    assert "1 identical, 1 not compared, 1 failed" in text
    assert code == 1
    with (folder / "b.mcap").open("ab") as file:
        file.write(b"x")
    run(*resumed)
    assert runs.names == ["L4/c.mcap", "b.mcap"]
    monkeypatch.setattr("server.recording.replay_many.product_version", lambda: "another")
    run(*resumed)
    assert runs.names == list(ROWS)
    # Without --resume everything is checked, and the file begins anew.
    run(str(folder), "--table", str(table))
    assert runs.names == list(ROWS)
    assert len(table.read_text().splitlines()) == 3


def test_a_name_that_is_not_utf_8_is_a_row(folder: Path, tmp_path: Path, runs: Runs) -> None:
    name = os.fsdecode(b"z\xff.mcap")
    (folder / name).write_bytes(b"not a recording")
    table = tmp_path / "table.jsonl"
    for _ in "table", "resumed":
        _, text = run(str(folder), "--table", str(table), "--resume", "--json")
        assert [row["file"] for row in json.loads(text)] == [*ROWS, "z\\udcff.mcap"]
    assert runs.names == ["L4/c.mcap", "z\\udcff.mcap"]


def test_a_table_file_that_is_another_file_is_not_overwritten(folder: Path, runs: Runs) -> None:
    recording = folder / "a.mcap"
    before = recording.read_bytes()
    assert "it is another file" in unusable_table(folder, recording)
    assert recording.read_bytes() == before
    assert not runs.names


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
def test_a_full_disk_is_named_once(folder: Path, runs: Runs) -> None:
    assert "no space left" in unusable_table(folder, Path("/dev/full"))
    assert runs.names == list(ROWS)


def unusable_table(folder: Path, table: Path) -> str:
    found = CliRunner().invoke(app, ["replay", str(folder), "--check", "--table", str(table)]).exception
    assert isinstance(found, InvalidInput), found
    assert found.code == "TABLE_FILE_UNUSABLE"
    return found.message


def test_other_alarm_limits_are_another_result(folder: Path, tmp_path: Path, runs: Runs) -> None:
    config, table = tmp_path / "config.yaml", tmp_path / "table.jsonl"
    config.write_text("alarms: {drill_unseen_after_ms: 1000}")
    run(str(folder), "--table", str(table), "--resume")
    _, text = run(str(folder), "--table", str(table), "--resume", "--config", str(config), "--json")
    assert runs.names == list(ROWS)
    rows = {row["file"]: row for row in json.loads(text)}
    assert (rows["a.mcap"]["outcome"], rows["a.mcap"]["first"]["image_number"]) == ("different", 10)


def test_a_cluster_gives_the_same_rows(folder: Path) -> None:
    with LocalCluster(
        n_workers=1,
        threads_per_worker=1,
        processes=False,
        protocol="tcp",
        host="127.0.0.1",
        dashboard_address=None,
    ) as cluster:
        code, text = run(str(folder), "--scheduler", cluster.scheduler_address, "--json")
    assert code == 1
    assert {row["file"]: row["outcome"] for row in json.loads(text)} == ROWS


def test_a_cluster_that_does_not_answer_is_named() -> None:
    with pytest.raises(RecordingError) as found:
        list(cluster_rows([], scheduler="tcp://127.0.0.1:9", timeout_s=0.2))
    assert found.value.code == "CLUSTER_UNREACHABLE"


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (("{}", "--resume", "--check"), "--table"),
        (("{}",), "--check"),
        (("{}", "--check", "--workers=2", "--scheduler=tcp://h:1"), "--workers"),
        (("{}/a.mcap", "--check", "--workers=2"), "folder"),
    ],
)
def test_options_that_do_not_fit_together_are_rejected(
    folder: Path, words: Sequence[str], reason: str
) -> None:
    result = CliRunner().invoke(app, ["replay", *(word.format(folder) for word in words)])
    assert result.exit_code == 2
    assert reason in result.output
