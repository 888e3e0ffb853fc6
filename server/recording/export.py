"""Tables of a recording, and their export as CSV: poses, deviations and alarms.

`image` counts the recorded results from 0; `image_number` is the number of the camera image. `time_s` is the
time since the first result, `unix_s` Unix time. Unknown values are absent, and `reason` states why. `COLUMNS`
describes the columns for every format; their names contain the units.
"""

import csv
import io
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any, Literal, TypeAlias

from server.disk import named_when_complete
from server.errors import RecordingError
from server.recording_file import OTHER_CONTENT, Topic
from server.recording_file.locations import MessageLocations, read_content
from server.recording_file.reader import parsed_json
from server.stream.judgement_messages import DeviationMessage

Json: TypeAlias = Any
Row: TypeAlias = Sequence[object]

UNITS = ("mm", "deg", "s")
# A spreadsheet executes a text that begins with one of these as a formula.
FORMULA_STARTS = ("=", "+", "-", "@", "\t", "\r")


class Table(StrEnum):
    """Table of an export."""

    POSES = "poses"  # poses of markers, tools and the vertebra in the camera frame
    DEVIATIONS = "deviations"  # deviations of each tool from the channel
    ALARMS = "alarms"  # all transitions, acknowledgements and pauses


@dataclass(frozen=True, slots=True)
class Column:
    """Column of a table.

    Attributes:
        name: Its name, with the unit as suffix.
        kind: Type of its values.
    """

    name: str
    kind: Literal["integer", "number", "text"] = "number"

    @property
    def unit(self) -> str:
        """Unit of its values; empty for values without one."""
        suffix = self.name.rpartition("_")[2]
        return suffix if suffix in UNITS else ""


def _columns(kind: Literal["integer", "number", "text"], *names: str) -> tuple[Column, ...]:
    return tuple(Column(name, kind) for name in names)


WHEN = _columns("number", "time_s", "unix_s")
OF_IMAGE = (*_columns("integer", "image", "image_number"), *WHEN)
POSITION = ("x_mm", "y_mm", "z_mm")
ROTATION = tuple(f"r{row}{column}" for row in (1, 2, 3) for column in (1, 2, 3))
# In the order of the live message.
DEVIATION = tuple(name for name in DeviationMessage.model_fields if name != "kind")
# The displayed figure, rounded.
WALL = (*_columns("number", "wall_mm", "wall_limit_mm"), Column("verdict", "text"))

COLUMNS: Mapping[Table, tuple[Column, ...]] = {
    Table.POSES: (
        *OF_IMAGE,
        *_columns("text", "object", "name", "reason"),
        *_columns("number", *POSITION, *ROTATION),
    ),
    Table.DEVIATIONS: (
        *OF_IMAGE,
        *_columns("text", "tool", "reason"),
        *_columns("number", *DEVIATION),
        *WALL,
    ),
    Table.ALARMS: (
        *WHEN,
        Column("image_number", "integer"),
        Column("change", "text"),
        Column("alarm", "integer"),
        *_columns("text", "condition", "by"),
    ),
}


def csv_lines(recording: Path, table: Table) -> Iterator[str]:
    """Return a table of a recording line by line, up to the end of an incomplete file.

    Raises:
        RecordingError: RECORDING_NOT_READABLE.
    """
    rows = table_rows(recording, table)
    return _lines(rows, table)


def write_csv(recording: Path, table: Table, target: Path) -> None:
    """Write a table of a recording as CSV (UTF-8); the file gets its name when it is complete.

    Raises:
        RecordingError: TABLE_NOT_WRITTEN, RECORDING_NOT_READABLE.
    """
    lines = csv_lines(recording, table)
    try:
        with (
            named_when_complete(target) as unfinished,
            unfinished.open("w", encoding="utf-8", newline="") as written,
        ):
            written.writelines(lines)
    except OSError as error:
        raise table_not_written(target, error) from error


def table_not_written(target: Path, error: OSError) -> RecordingError:
    """Return the error of a table that cannot be written."""
    reason = (error.strerror or str(error)).lower()[:200]
    return RecordingError(
        "TABLE_NOT_WRITTEN",
        f"the table {target.name} cannot be written: {reason}",
        "Check that its folder exists and its disk has free space, then export again.",
        {"name": target.name, "reason": reason},
    )


def table_rows(recording: Path, table: Table) -> Iterator[Row]:
    """Return the rows of a table with the values of `COLUMNS`, up to the end of an incomplete file.

    Raises:
        RecordingError: RECORDING_NOT_READABLE.
    """
    # Rejects the file before the first row is read.
    locations = MessageLocations(recording)
    return _read_rows(recording, locations, table)


def _lines(rows: Iterator[Row], table: Table) -> Iterator[str]:
    yield _line([column.name for column in COLUMNS[table]])
    for row in rows:
        yield _line([_cell(value) for value in row])


def _read_rows(recording: Path, locations: MessageLocations, table: Table) -> Iterator[Row]:
    wanted = Topic.ALARM_STEP if table is Table.ALARMS else Topic.SNAPSHOT
    image, begin_s = -1, None
    with recording.open("rb") as file:
        for location in locations:
            if location.topic is Topic.SNAPSHOT:
                image += 1
                begin_s = location.unix_s if begin_s is None else begin_s
            if location.topic is not wanted:
                continue
            time_s = location.unix_s - (location.unix_s if begin_s is None else begin_s)
            when = (round(time_s, 6), round(location.unix_s, 6))
            try:
                content = parsed_json(read_content(file, location.offset, location.length))
                rows = _rows(table, content, image, when)
            except OTHER_CONTENT:
                # A damaged result is counted, so that later numbers stay correct.
                continue
            yield from rows


def _rows(table: Table, content: Json, image: int, when: Row) -> list[Row]:
    if table is Table.ALARMS:
        return [(*when, *row) for row in _alarms(content)]
    return [(image, content["image_number"], *when, *row) for row in ROWS[table](content)]


def _poses(snapshot: Json) -> Iterator[Row]:
    for marker in snapshot["markers"]:
        sighting = marker["sighting"]
        yield "marker", marker["name"], sighting.get("reason"), *_pose(sighting.get("camera_from_marker"))
    for tool in snapshot["tools"]:
        pose = tool["pose"]
        yield "tool", tool["name"], pose.get("reason"), *_pose(pose.get("camera_from_tool"))
    vertebra = snapshot["vertebra"]
    yield "vertebra", "", vertebra.get("reason"), *_pose(vertebra.get("camera_from_vertebra"))


def _pose(pose: Json | None) -> Row:
    if pose is None:
        return [None] * 12
    return [*pose["translation_mm"], *(one for row in pose["rotation"] for one in row)]


def _deviations(snapshot: Json) -> Iterator[Row]:
    for tool in snapshot["tools"]:
        deviation, assessment = tool["deviation"], tool["assessment"]
        wall = assessment.get("figures", {}).get("wall", {})
        yield (
            tool["name"],
            deviation.get("reason") or assessment.get("reason"),
            *(deviation.get(name) for name in DEVIATION),
            wall.get("value"),
            wall.get("limit"),
            assessment.get("verdict"),
        )


def _alarms(step: Json) -> Iterator[Row]:
    for event in step["events"]:
        yield step["image_number"], event["change"], event["number"], event["condition"], event["by"]


ROWS: Mapping[Table, Callable[[Json], Iterator[Row]]] = {
    Table.POSES: _poses,
    Table.DEVIATIONS: _deviations,
}


def _cell(value: object) -> object:
    """Return a value for CSV; free text that a spreadsheet would take for a formula begins with '."""
    return f"'{value}" if isinstance(value, str) and value.startswith(FORMULA_STARTS) else value


def _line(row: Row) -> str:
    text = io.StringIO()
    csv.writer(text).writerow(row)
    return text.getvalue()
