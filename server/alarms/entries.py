"""Lines of the alarm log."""

from collections.abc import Mapping
from dataclasses import dataclass

from server.texts import alarm_text
from tracker.navigation import Absent, Deviation, NavigationSnapshot
from tracker.navigation.alarms import Alarm, AlarmEvent

Line = Mapping[str, object]


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """One change in the alarm log.

    Attributes:
        line: JSON object.
        by: Who caused it; empty if nobody.
    """

    line: Line
    by: str


def guiding_entry(*, screen: str, by: str, is_on: bool, at: str, at_s: float) -> Entry:
    """Return the log line of a guiding sound that was turned on or off."""
    change = "guiding_on" if is_on else "guiding_off"
    return Entry(line={"at": at, "at_s": at_s, "change": change, "screen": screen, "by": by}, by=by)


def entry_of(
    event: AlarmEvent, *, at: str, unix_offset_s: float, snapshot: NavigationSnapshot | None
) -> Entry:
    """Return the log line of a change: time, condition, value, limit, person, tool poses and texts.

    Args:
        event: The change.
        at: Wall clock, UTC, ISO 8601.
        unix_offset_s: Unix time minus monotonic time.
        snapshot: Result of the newest image.
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
    """Return numbers and texts of an alarm, as displayed."""
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
    """Return pose (camera frame) and deviations of a tool, or the reason for their absence."""
    tool, deviation = snapshot.tools[name], snapshot.deviations[name]
    if isinstance(tool, Absent):
        return {"absent": tool.reason.value}
    values: dict[str, object] = {
        "camera_from_tool": {
            "rotation": tool.camera_from_tool.rotation.tolist(),
            "translation_mm": tool.camera_from_tool.translation_mm.tolist(),
        }
    }
    if isinstance(deviation, Deviation):
        values["depth_mm"] = deviation.depth_mm
        values["angle_deg"] = deviation.angle_deg
        values["tip_offset_mm"] = deviation.tip_offset_mm
    return values
