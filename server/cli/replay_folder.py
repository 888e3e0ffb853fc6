"""`coaxial replay DIR --check`: check all recordings of a folder, with a table of the results."""

import json
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import typer
from pydantic import ValidationError
from rich.console import Console
from rich.table import Table
from rich.text import Text

from server.alarms import alarm_limits
from server.cli.progress import shown_steps
from server.config_file import load_config
from server.recording.replay_many import (
    MAX_TEXT_LENGTH,
    Outcome,
    ReplayRow,
    ReplayTask,
    cluster_rows,
    current_versions,
    is_finished,
    local_rows,
    replay_tasks,
)
from tracker.errors import InvalidInput, NavigationError

ALL_IDENTICAL, NOT_ALL = 0, 1
MAX_LINE_LENGTH = 200
# Each line of a table begins with the first field of `ReplayRow`.
ROW_START = b'{"file":'


@dataclass(frozen=True, slots=True, kw_only=True)
class FolderCheck:
    """How a folder is checked.

    Attributes:
        config: Settings file with other alarm limits; None for the recorded ones.
        workers: Number of processes at once.
        scheduler: Address of a Dask cluster in place of processes; None without one.
        table: File for the results; None without one.
        resume: Whether valid results in that file are kept.
        as_json: Whether the results are printed as JSON.
    """

    config: Path | None
    workers: int
    scheduler: str | None
    table: Path | None
    resume: bool
    as_json: bool


def check_folder(folder: Path, options: FolderCheck) -> int:
    """Check all recordings of a folder and print a table. Return the exit status.

    Raises:
        NavigationError: No recording in the folder, or settings, table file or cluster cannot be used.
    """
    config, table = options.config, options.table
    limits = None if config is None else alarm_limits(load_config(config))
    tasks = replay_tasks(folder, limits)
    if not tasks:
        name = str(folder)[:MAX_TEXT_LENGTH]
        raise InvalidInput(
            "NO_RECORDINGS",
            f"{name} and its subfolders have no recording (.mcap)",
            "Give a folder with recordings.",
            {"folder": name},
        )
    rows = _earlier_rows(table, tasks) if table is not None and options.resume else {}
    waiting = [task for task in tasks if task.name not in rows]
    with _appended(table, keeps=options.resume) as written, shown_steps() as steps:
        for _ in rows:
            steps.advance("replaying", len(tasks))
        found = (
            local_rows(waiting, workers=options.workers)
            if options.scheduler is None
            else cluster_rows(waiting, scheduler=options.scheduler)
        )
        for row in found:
            rows[row.file] = row
            if written is not None:
                _append(written, row)
            steps.advance("replaying", len(tasks))
    ordered = [rows[task.name] for task in tasks]
    if options.as_json:
        typer.echo(json.dumps([row.model_dump(mode="json") for row in ordered], ensure_ascii=False))
    else:
        _print(ordered, resumed=len(tasks) - len(waiting))
    return ALL_IDENTICAL if all(row.outcome is Outcome.IDENTICAL for row in ordered) else NOT_ALL


def _earlier_rows(table: Path, tasks: list[ReplayTask]) -> dict[str, ReplayRow]:
    """Return the rows of an earlier run that are still valid, the last one of each file."""
    try:
        lines = table.read_text(encoding="utf-8").splitlines()
    except FileNotFoundError:
        return {}
    except (OSError, ValueError) as error:
        raise _unusable(table, error) from error
    earlier: dict[str, ReplayRow] = {}
    for line in lines:
        try:
            row = ReplayRow.model_validate_json(line)
        except ValidationError:
            # The last line after a crash, or a line of another version.
            continue
        earlier[row.file] = row
    versions = current_versions()
    valid = {}
    for task in tasks:
        row_of_task = earlier.get(task.name)
        if row_of_task is not None and _is_finished(row_of_task, task, versions):
            valid[task.name] = row_of_task
    return valid


def _is_finished(row: ReplayRow, task: ReplayTask, versions: dict[str, str]) -> bool:
    try:
        return is_finished(row, task, versions)
    except NavigationError:
        # It cannot be read now; its row will state why.
        return False


@contextmanager
def _appended(table: Path | None, *, keeps: bool) -> Iterator[IO[bytes] | None]:
    """Yield the table file, opened for appending; None without one."""
    if table is None:
        yield None
        return
    _reject_other_file(table)
    try:
        file = table.open("ab" if keeps else "wb")
    except OSError as error:
        raise _unusable(table, error) from error
    try:
        if file.tell():
            # After a crash the last line may lack its end.
            file.write(b"\n")
        yield file
    finally:
        # Closing writes again what could not be written, which was raised then.
        with suppress(OSError):
            file.close()


def _reject_other_file(table: Path) -> None:
    """Reject a file that is not empty and no table, such as a recording, before it is overwritten."""
    if not table.is_file():
        return
    try:
        with table.open("rb") as file:
            begin = file.read(len(ROW_START))
    except OSError as error:
        raise _unusable(table, error) from error
    if not ROW_START.startswith(begin):
        raise _unusable(table, ValueError("it is another file, and not a table of results"))


def _append(file: IO[bytes], row: ReplayRow) -> None:
    try:
        file.write(row.model_dump_json().encode() + b"\n")
        file.flush()
        os.fsync(file.fileno())
    except OSError as error:
        raise _unusable(Path(file.name), error) from error


def _unusable(table: Path, error: Exception) -> InvalidInput:
    reason = (getattr(error, "strerror", None) or str(error)).lower()[:MAX_TEXT_LENGTH]
    return InvalidInput(
        "TABLE_FILE_UNUSABLE",
        f"the table file {str(table)[:MAX_TEXT_LENGTH]} cannot be used: {reason}",
        "Give a new file, or a table of results that can be written.",
        {"table": str(table)[:MAX_TEXT_LENGTH], "reason": reason},
    )


def _print(rows: list[ReplayRow], *, resumed: int) -> None:
    table = Table(box=None, pad_edge=False)
    table.add_column("file", overflow="fold")
    table.add_column("images", justify="right")
    table.add_column("result")
    table.add_column("first image that differs", justify="right")
    table.add_column("difference or problem", overflow="fold")
    for row in rows:
        first = "" if row.first is None else str(row.first.image_number)
        # As text, because a path may look like markup.
        table.add_row(Text(row.file), str(row.images), row.outcome.value, first, Text(_reason(row)))
    # A file or pipe has no width.
    Console(width=None if sys.stdout.isatty() else MAX_LINE_LENGTH).print(table)
    counts = {one: sum(row.outcome is one for row in rows) for one in Outcome}
    typer.echo(", ".join(f"{count} {one.value}" for one, count in counts.items() if count))
    if resumed:
        typer.echo(f"{resumed} of these from the table file")


def _reason(row: ReplayRow) -> str:
    """Return by how much the first different value differs, or why there is no result."""
    if row.first is None:
        return row.problem
    first, worst = row.first, row.worst
    text = f"{first.what}: {_apart(first.size)}"
    if worst is not None and worst != first:
        text += f"; largest in image {worst.image_number}, {worst.what}: {_apart(worst.size)}"
    return text


def _apart(size: float | None) -> str:
    return "another value" if size is None else f"{size:.3g}"
