"""Messages of one instant: known values with their times, and the reasons for unknown values.

A pose that the page would not show is not sent: both use the same fields of the snapshot, in which unknown or
withheld values are `Absent`. The age of a value is checked when it is sent (`feed.py`).
"""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from server.config import OpenIgtLinkConfig
from server.live import Instant, ProcessState, SourceState
from server.openigtlink_wire import (
    Point,
    Status,
    StatusCode,
    is_device_name,
    points_content,
    status_content,
    string_content,
    transform_content,
)
from server.texts import STATES, Language, headline_of
from tracker.geometry import Array
from tracker.navigation import Absent, AbsentReason, NavigationSnapshot

PROGRAM, HEADLINE, PLAN = "Coaxial", "Headline", "Plan"
TOO_OLD, NO_IMAGE = "TOO_OLD", "NO_IMAGE"
# Converts LPS to RAS, and is its own inverse. It is a rotation, so that a rigid pose stays rigid.
LPS_RAS = np.diag([-1.0, -1.0, 1.0, 1.0])
CODES: Mapping[AbsentReason, StatusCode] = {
    AbsentReason.MARKER_UNSEEN: StatusCode.NOT_PRESENT,
    AbsentReason.REFERENCE_UNSEEN: StatusCode.NOT_PRESENT,
    AbsentReason.CAMERA_NOT_CALIBRATED: StatusCode.NOT_READY,
    AbsentReason.TOOL_NOT_DEFINED: StatusCode.NOT_READY,
    AbsentReason.NOT_REGISTERED: StatusCode.NOT_READY,
    AbsentReason.NO_PLAN: StatusCode.NOT_READY,
    AbsentReason.NOT_CHECKED: StatusCode.NOT_READY,
    AbsentReason.NOT_CONFIRMED: StatusCode.NOT_READY,
    AbsentReason.NOT_COSIGNED: StatusCode.NOT_READY,
    AbsentReason.MARKER_TWICE: StatusCode.UNKNOWN_ERROR,
    AbsentReason.CAMERA_CHANGED: StatusCode.UNKNOWN_ERROR,
    AbsentReason.CAMERA_MOVED: StatusCode.UNKNOWN_ERROR,
    AbsentReason.REFERENCE_MOVED: StatusCode.UNKNOWN_ERROR,
    AbsentReason.POSE_UNCERTAIN: StatusCode.UNKNOWN_ERROR,
    AbsentReason.POSE_JUMPED: StatusCode.UNKNOWN_ERROR,
}
WELL = Status(code=StatusCode.OK, name="OK", text="OK: images are tracked")
IS_TOO_OLD = Status(code=StatusCode.TIME_OUT, name=TOO_OLD, text=f"{TOO_OLD}: no newer image has arrived")


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceContent:
    """Message of a device for one image.

    Attributes:
        device: Its name.
        type: TRANSFORM, POINT, STRING or STATUS.
        content: Bytes of the content.
        has_figures: Whether it expires with the figures of the page; a reason expires with the picture.
        coordinates: "RAS", "LPS" or "camera"; empty without coordinates.
    """

    device: str
    type: str
    content: bytes
    has_figures: bool = False
    coordinates: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class InstantContents:
    """The messages of one instant.

    Attributes:
        captured_at_s: Monotonic time of the image; None without one.
        image: Messages that change with each image; without an image, the headline only.
        plan: The planned channel.
        program: State of the program.
    """

    captured_at_s: float | None
    image: tuple[DeviceContent, ...]
    plan: DeviceContent
    program: DeviceContent


def contents_of(instant: Instant, settings: OpenIgtLinkConfig, *, language: Language) -> InstantContents:
    """Return the messages of an instant."""
    snapshot = _shown(instant)
    headline = headline_of(snapshot, instant.alarms)
    lines = (headline.title[language], headline.detail[language], headline.event[language])
    text = DeviceContent(
        device=HEADLINE,
        type="STRING",
        content=string_content(" · ".join(line for line in lines if line)),
        has_figures=headline.verdict is not None,
    )
    if snapshot is None:
        return InstantContents(
            captured_at_s=None,
            image=(text,),
            plan=_unplanned(),
            program=status_of_device(PROGRAM, _cause(instant)),
        )
    names, unnamed = _names(snapshot.setup.tools, settings)
    tools = tuple(one for tool in names for one in _of_tool(snapshot, tool, names[tool], settings))
    return InstantContents(
        captured_at_s=snapshot.captured_at_s,
        image=(*tools, text),
        plan=_plan(snapshot, settings),
        program=status_of_device(PROGRAM, _unsent(unnamed) if unnamed else WELL),
    )


def status_of_device(device: str, status: Status) -> DeviceContent:
    """Return the STATUS of a device."""
    return DeviceContent(device=device, type="STATUS", content=status_content(status))


def _shown(instant: Instant) -> NavigationSnapshot | None:
    """Return the snapshot; None while capture or tracking is stopped, as on the page."""
    runs = instant.process.state is ProcessState.RUNNING and instant.source.state is SourceState.RUNNING
    return instant.snapshot if runs else None


def _cause(instant: Instant) -> Status:
    problem = instant.process.problem or instant.source.problem
    text = f"tracking is {instant.process.state.value}, the source is {instant.source.state.value}"
    if problem is not None:
        text += f"; {problem.code}: {problem.message}"
    return Status(code=StatusCode.TIME_OUT, name=NO_IMAGE, text=f"{NO_IMAGE}: {text}")


def _names(tools: Iterable[str], settings: OpenIgtLinkConfig) -> tuple[dict[str, str], list[str]]:
    """Return the name of each tool in messages, and the tools whose messages cannot have their own names."""
    wanted = {tool: settings.tool_names.get(tool, tool) for tool in tools}
    taken = Counter(device for name in wanted.values() for device in _devices(name, settings))
    fitting = {
        tool: name
        for tool, name in wanted.items()
        if all(taken[device] == 1 and is_device_name(device) for device in _devices(name, settings))
    }
    return fitting, [tool for tool in wanted if tool not in fitting]


def _devices(name: str, settings: OpenIgtLinkConfig) -> tuple[str, str, str]:
    return f"{name}To{settings.camera_frame}", f"{name}To{settings.vertebra_frame}", f"{name}Tip"


def _unsent(tools: Sequence[str]) -> Status:
    return Status(
        code=StatusCode.CONFIG_ERROR,
        name="NAME_UNUSABLE",
        text=f"NAME_UNUSABLE: {', '.join(tools)[:200]} not sent: the name has more than 10 "
        "characters or is used by another tool; set openigtlink.tool_names",
    )


def _of_tool(
    snapshot: NavigationSnapshot, tool: str, name: str, settings: OpenIgtLinkConfig
) -> tuple[DeviceContent, ...]:
    to_camera, to_vertebra, tip = _devices(name, settings)
    seen, placed = snapshot.tools[tool], snapshot.vertebra_from_tool(tool)
    in_camera = (
        _absent(to_camera, seen)
        if isinstance(seen, Absent)
        else _transform(to_camera, seen.camera_from_tool.matrix, "camera")
    )
    if isinstance(placed, Absent):
        return in_camera, _absent(to_vertebra, placed), _absent(tip, placed)
    matrix = _turned(settings) @ placed.matrix
    return (
        in_camera,
        _transform(to_vertebra, matrix, settings.coordinates),
        DeviceContent(
            device=tip,
            type="POINT",
            content=points_content([Point(name="tip", group=PROGRAM, position_mm=matrix[:3, 3])]),
            has_figures=True,
            coordinates=settings.coordinates,
        ),
    )


def _plan(snapshot: NavigationSnapshot, settings: OpenIgtLinkConfig) -> DeviceContent:
    channel = snapshot.setup.channel
    if isinstance(channel, Absent):
        return _absent(PLAN, channel)
    turned = _turned(settings)[:3, :3]
    ends = {"entry": channel.entry_in_vertebra_mm, "target": channel.target_in_vertebra_mm}
    return DeviceContent(
        device=PLAN,
        type="POINT",
        content=points_content(
            [Point(name=end, group=channel.name, position_mm=turned @ at_mm) for end, at_mm in ends.items()]
        ),
        coordinates=settings.coordinates,
    )


def _unplanned() -> DeviceContent:
    return status_of_device(
        PLAN,
        Status(code=StatusCode.TIME_OUT, name=NO_IMAGE, text=f"{NO_IMAGE}: the plan in use is not known"),
    )


def _transform(device: str, matrix: Array, coordinates: str) -> DeviceContent:
    return DeviceContent(
        device=device,
        type="TRANSFORM",
        content=transform_content(matrix),
        has_figures=True,
        coordinates=coordinates,
    )


def _absent(device: str, absent: Absent) -> DeviceContent:
    reason, state = absent.reason, STATES["en"][absent.reason]
    text = f"{reason.value}: {state.title}, {state.detail}"
    return status_of_device(device, Status(code=CODES[reason], name=reason.value, text=text))


def _turned(settings: OpenIgtLinkConfig) -> Array:
    return LPS_RAS if settings.coordinates == "RAS" else np.eye(4)
