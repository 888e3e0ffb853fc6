"""One line of the alarm log."""

from collections.abc import Mapping
from dataclasses import dataclass

from tracker.navigation import Absent, Deviation, NavigationSnapshot
from tracker.navigation.alarms import TRAITS, AlarmEvent

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


def entry_of(event: AlarmEvent, *, at: str, snapshot: NavigationSnapshot | None) -> Entry:
    """The log's line for a change: when, what, value and limit, who, and where the drill was.

    Args:
        event: the change.
        at: the wall clock, UTC, ISO 8601.
        snapshot: of the newest image at that moment.
    """
    condition, measure = event.condition, event.measure
    line: dict[str, object] = {"at": at, "at_s": event.at_s, "change": event.change.value}
    if condition is not None:
        line["number"] = event.number
        line["condition"] = condition.value
        line["priority"] = TRAITS[condition].priority.value
        line["kind"] = TRAITS[condition].kind.value
    if measure is not None:
        line["value"], line["limit"], line["unit"] = measure.value, measure.limit, measure.unit
    if event.by:
        line["by"] = event.by
    if event.pause_s:
        line["pause_s"] = event.pause_s
    if snapshot is not None:
        line["image_number"] = snapshot.image_number
        line["tools"] = {name: _tool(snapshot, name) for name in snapshot.tools}
    return Entry(line=line, by=event.by)


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
