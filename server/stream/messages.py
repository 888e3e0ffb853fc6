"""What goes over the wire, and the one function that makes it from an instant.

These models are the schema: OpenAPI has them through `GET /api/live`, and the page's types are generated
from there, so that a renamed field fails the build. The same message is sent as JSON on `/ws/live`, as the
header of each image on `/ws/view`, and answered by `GET /api/live`.
"""

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from server.live import Instant, ProcessState, ProcessStatus, SourceState, SourceStatus, Trouble
from server.stream.alarm_messages import AlarmsMessage, alarms_message
from server.stream.message import Message as Message  # noqa: PLC0414  the doors take it from here
from tracker.navigation import Absent, AbsentReason, Deviation, NavigationSnapshot, ToolInView
from tracker.pose import FoundBy, Seen, Sighting, UnseenReason


class PoseMessage(Message):
    """A rigid motion: `x_camera = rotation @ x + translation_mm`."""

    rotation: list[list[float]]
    """3 rows of 3."""
    translation_mm: list[float]
    """x, y, z in mm."""


class MarkerSeenMessage(Message):
    """A marker found in this image."""

    kind: Literal["seen"] = "seen"
    corners_px: list[list[float]]
    """Top-left, top-right, bottom-right, bottom-left of the printed face, (u, v) in px."""
    camera_from_marker: PoseMessage | None
    """Where the marker is; null while the camera is not calibrated."""
    score_ratio: float
    target_score_ratio: float
    model_coverage_ratio: float
    target_coverage_ratio: float
    fit_error_px2: float
    found_by: FoundBy


class MarkerUnseenMessage(Message):
    """A marker that is not claimed in this image."""

    kind: Literal["unseen"] = "unseen"
    reason: UnseenReason
    best_score_ratio: float


class AbsentMessage(Message):
    """Something that is not known, with the reason."""

    kind: Literal["absent"] = "absent"
    reason: AbsentReason


class ToolMessage(Message):
    """A tool placed by its marker."""

    kind: Literal["tool"] = "tool"
    camera_from_tool: PoseMessage
    tip_sd_mm: float
    """Standard deviation of the tip: root of the trace of its covariance, from the marker's edges alone."""
    lag_ms: float
    """How far the pose lies behind its image, where it was steadied; else 0."""


class DeviationMessage(Message):
    """The surgeon's numbers; see `tracker.navigation.Deviation`."""

    kind: Literal["deviation"] = "deviation"
    entry_offset_mm: float | None
    """Null when the drill lies across the channel and its line never meets the entry plane."""
    angle_deg: float
    depth_mm: float
    remaining_mm: float
    tip_offset_mm: float


class MarkerMessage(Message):
    """One marker by name."""

    name: str
    sighting: Annotated[MarkerSeenMessage | MarkerUnseenMessage, Field(discriminator="kind")]


class ToolStateMessage(Message):
    """One tool by name: where it is, and how far from the channel."""

    name: str
    marker: str
    pose: Annotated[ToolMessage | AbsentMessage, Field(discriminator="kind")]
    deviation: Annotated[DeviationMessage | AbsentMessage, Field(discriminator="kind")]


class SnapshotMessage(Message):
    """One image and all that was concluded from it."""

    image_number: int
    captured_at_s: float
    """Monotonic clock of the server."""
    age_ms: float
    """From the grab to the moment this message was made."""
    width_px: int
    height_px: int
    camera_calibrated: bool
    registered_by: str | None
    """How plan and patient were registered; null when they are not."""
    channel_name: str | None
    markers: list[MarkerMessage]
    tools: list[ToolStateMessage]
    stage_ms: dict[str, float]
    """Time of each stage, of the tracking process and of the server."""
    skipped_images: int


class TroubleMessage(Message):
    """Errors have this shape everywhere."""

    code: str
    message: str
    remedy: str
    context: dict[str, object]


class SourceMessage(Message):
    """The source of images."""

    name: str
    state: SourceState
    trouble: TroubleMessage | None
    images: int
    skipped_images: int
    rate_hz: float


class ProcessMessage(Message):
    """The process that captures and tracks."""

    state: ProcessState
    restarts: int
    trouble: TroubleMessage | None


class LiveMessage(Message):
    """What is true now."""

    sequence: int
    """Grows by one with each instant; a gap is what this reader skipped."""
    sent_at_s: float
    """Monotonic clock of the server."""
    source: SourceMessage
    process: ProcessMessage
    snapshot: SnapshotMessage | None
    """Null before the first image and while capture or tracking is dead."""
    alarms: AlarmsMessage
    """With this image looked at."""


def live_message(instant: Instant, *, now_s: float) -> LiveMessage:
    """The message of an instant, as sent at monotonic time `now_s`."""
    return LiveMessage(
        sequence=instant.sequence,
        sent_at_s=now_s,
        source=source_message(instant.source),
        process=process_message(instant.process),
        snapshot=None
        if instant.snapshot is None
        else _snapshot(instant.snapshot, instant.server_ms, now_s=now_s),
        alarms=alarms_message(instant.alarms, now_s=now_s),
    )


def source_message(source: SourceStatus) -> SourceMessage:
    """The message of the source of images."""
    return SourceMessage(
        name=source.name,
        state=source.state,
        trouble=trouble_message(source.trouble),
        images=source.images,
        skipped_images=source.skipped_images,
        rate_hz=source.rate_hz,
    )


def process_message(process: ProcessStatus) -> ProcessMessage:
    """The message of the tracking process."""
    return ProcessMessage(
        state=process.state, restarts=process.restarts, trouble=trouble_message(process.trouble)
    )


def trouble_message(trouble: Trouble | None) -> TroubleMessage | None:
    """The message of something that is wrong, if anything is."""
    if trouble is None:
        return None
    return TroubleMessage(
        code=trouble.code, message=trouble.message, remedy=trouble.remedy, context=trouble.context
    )


def _snapshot(snapshot: NavigationSnapshot, server_ms: dict[str, float], *, now_s: float) -> SnapshotMessage:
    setup = snapshot.setup
    return SnapshotMessage(
        image_number=snapshot.image_number,
        captured_at_s=snapshot.captured_at_s,
        age_ms=(now_s - snapshot.captured_at_s) * 1000.0,
        width_px=snapshot.size_wh_px[0],
        height_px=snapshot.size_wh_px[1],
        camera_calibrated=setup.camera_calibrated,
        registered_by=None if isinstance(setup.registration, Absent) else str(setup.registration.method),
        channel_name=None if isinstance(setup.channel, Absent) else setup.channel.name,
        markers=[
            MarkerMessage(name=name, sighting=_sighting(sighting, calibrated=setup.camera_calibrated))
            for name, sighting in snapshot.sightings.items()
        ],
        tools=[
            ToolStateMessage(
                name=name,
                marker=setup.tools[name].marker,
                pose=_tool(tool),
                deviation=_deviation(snapshot.deviations[name]),
            )
            for name, tool in snapshot.tools.items()
        ],
        stage_ms={**snapshot.stage_ms, **server_ms},
        skipped_images=snapshot.skipped_images,
    )


def _pose(rotation: np.ndarray, translation_mm: np.ndarray) -> PoseMessage:
    return PoseMessage(rotation=rotation.tolist(), translation_mm=translation_mm.tolist())


def _sighting(sighting: Sighting, *, calibrated: bool) -> MarkerSeenMessage | MarkerUnseenMessage:
    if not isinstance(sighting, Seen):
        return MarkerUnseenMessage(reason=sighting.reason, best_score_ratio=sighting.best_score_ratio)
    pose = sighting.camera_from_marker
    return MarkerSeenMessage(
        corners_px=sighting.corners_px.tolist(),
        camera_from_marker=_pose(pose.rotation, pose.translation_mm) if calibrated else None,
        score_ratio=sighting.score_ratio,
        target_score_ratio=sighting.target_score_ratio,
        model_coverage_ratio=sighting.model_coverage_ratio,
        target_coverage_ratio=sighting.target_coverage_ratio,
        fit_error_px2=sighting.fit_error_px2,
        found_by=sighting.found_by,
    )


def _tool(tool: ToolInView | Absent) -> ToolMessage | AbsentMessage:
    if isinstance(tool, Absent):
        return AbsentMessage(reason=tool.reason)
    pose = tool.camera_from_tool
    return ToolMessage(
        camera_from_tool=_pose(pose.rotation, pose.translation_mm),
        tip_sd_mm=math.sqrt(float(np.trace(tool.tip_covariance_mm2))),
        lag_ms=tool.lag_ms,
    )


def _deviation(deviation: Deviation | Absent) -> DeviationMessage | AbsentMessage:
    if isinstance(deviation, Absent):
        return AbsentMessage(reason=deviation.reason)
    return DeviationMessage(
        entry_offset_mm=deviation.entry_offset_mm if math.isfinite(deviation.entry_offset_mm) else None,
        angle_deg=deviation.angle_deg,
        depth_mm=deviation.depth_mm,
        remaining_mm=deviation.remaining_mm,
        tip_offset_mm=deviation.tip_offset_mm,
    )
