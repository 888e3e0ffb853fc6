"""One line of the alarm log."""

from collections.abc import Mapping
from dataclasses import dataclass

from server.texts import alarm_text
from tracker.navigation import Absent, Deviation, NavigationSnapshot
from tracker.navigation.alarms import Alarm, AlarmEvent

Line = Mapping[str, object]


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """What is kept of one change.

    Attributes:
        line: as JSON has it.
        by: who did it; empty when nobody did.
    """

    line: Line
    by: str


def entry_of(
    event: AlarmEvent, *, at: str, unix_offset_s: float, snapshot: NavigationSnapshot | None
) -> Entry:
    """The log's line for a change: when, what, value and limit, who, where the drill was, and in words.

    Args:
        event: the change.
        at: the wall clock, UTC, ISO 8601.
        unix_offset_s: to be added to the event's times to have Unix time.
        snapshot: of the newest image at that moment.
    """
    line: dict[str, object] = {"at": at, "at_s": event.at_s, "change": event.change.value}
    if event.alarm is not None:
        line |= _alarm(event.alarm, unix_offset_s=unix_offset_s)
    if event.by:
        line["by"] = event.by
    if event.pause_s:
        line["pause_s"] = event.pause_s
    if snapshot is not None:
        line["image_number"] = snapshot.image_number
        line["tools"] = {name: _tool(snapshot, name) for name in snapshot.tools}
    return Entry(line=line, by=event.by)


def _alarm(alarm: Alarm, *, unix_offset_s: float) -> Line:
    """The alarm in numbers and in words, as page and video have them."""
    words = alarm_text(alarm, unix_offset_s=unix_offset_s, of_now=False)
    line: dict[str, object] = {
        "number": alarm.number,
        "condition": alarm.condition.value,
        "priority": alarm.priority.value,
        "kind": alarm.kind.value,
        "presence": alarm.presence.value,
        "title": dict(words.title),
        "sentence": dict(words.sentence),
    }
    if alarm.measure is not None:
        measure = alarm.measure
        line["value"], line["limit"], line["unit"] = measure.value, measure.limit, measure.unit
    if alarm.peak is not None:
        line["worst"] = alarm.peak.measure.value
        if (site := alarm.peak.site) is not None:
            line["worst_depth_mm"] = site.depth_mm
            line["worst_wall"] = None if site.wall is None else site.wall.value
    return line


def _tool(snapshot: NavigationSnapshot, name: str) -> Line:
    """Where the tool was: its pose in the camera's frame and its numbers, or why they are not known."""
    tool, deviation = snapshot.tools[name], snapshot.deviations[name]
    if isinstance(tool, Absent):
        return {"absent": tool.reason.value}
    said: dict[str, object] = {
        "camera_from_tool": {
            "rotation": tool.camera_from_tool.rotation.tolist(),
            "translation_mm": tool.camera_from_tool.translation_mm.tolist(),
        }
    }
    if isinstance(deviation, Deviation):
        said["depth_mm"] = deviation.depth_mm
        said["angle_deg"] = deviation.angle_deg
        said["tip_offset_mm"] = deviation.tip_offset_mm
    return said
