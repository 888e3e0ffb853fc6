"""Export of a recording as CSV: poses, deviations and alarms, with a header of column names and units.

`image` counts the recorded results from 0; `image_number` is the number of the camera image. `time_s` is the
time since the first result, `unix_s` Unix time. Unknown values are empty, and `reason` states why.
"""

import csv
import io
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from enum import StrEnum
from pathlib import Path
from typing import Any, TypeAlias

from server.recording_file import Topic
from server.recording_file.locations import MessageLocations, read_content
from server.stream.judgement_messages import DeviationMessage

Json: TypeAlias = Any
Row: TypeAlias = Sequence[object]

OF_IMAGE = ("image", "image_number", "time_s", "unix_s")
ROTATION = tuple(f"r{row}{column}" for row in (1, 2, 3) for column in (1, 2, 3))
# In the order of the live message.
DEVIATION = tuple(name for name in DeviationMessage.model_fields if name != "kind")
# The displayed figure, rounded.
WALL = ("wall_mm", "wall_limit_mm", "verdict")


class Table(StrEnum):
    """Table of an export."""

    POSES = "poses"  # poses of markers, tools and the vertebra in the camera frame
    DEVIATIONS = "deviations"  # deviations of each tool from the channel
    ALARMS = "alarms"  # all transitions, acknowledgements and pauses


COLUMNS: Mapping[Table, tuple[str, ...]] = {
    Table.POSES: (*OF_IMAGE, "object", "name", "reason", "x_mm", "y_mm", "z_mm", *ROTATION),
    Table.DEVIATIONS: (*OF_IMAGE, "tool", "reason", *DEVIATION, *WALL),
    Table.ALARMS: ("time_s", "unix_s", "image_number", "change", "alarm", "condition", "by"),
}


def csv_lines(recording: Path, table: Table) -> Iterator[str]:
    """Yield a table of a recording line by line, up to the end of an incomplete file.

    Raises:
        RecordingError: RECORDING_NOT_READABLE.
    """
    # Rejects the file before the first line is sent.
    locations = MessageLocations(recording)
    return _lines(recording, locations, table)


def _lines(recording: Path, locations: MessageLocations, table: Table) -> Iterator[str]:
    yield _line(COLUMNS[table])
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
                content = json.loads(read_content(file, location.offset, location.length))
                rows = _rows(table, content, image, when)
            except (ValueError, LookupError, TypeError, AttributeError):
                # A damaged result is counted, so that later numbers stay correct.
                continue
            for row in rows:
                yield _line(row)


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


def _line(row: Row) -> str:
    text = io.StringIO()
    csv.writer(text).writerow(row)
    return text.getvalue()
