"""Where things are, as it goes over the wire: markers, tools, the vertebra; or why that is not known."""

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from server.stream.message import Message
from tracker.geometry import Array
from tracker.navigation import Absent, AbsentReason, PlacedVertebra, ToolInView
from tracker.pose import FoundBy, Seen, Sighting, UnseenReason


class PoseMessage(Message):
    """A rigid motion: `x_camera = rotation @ x + translation_mm`."""

    rotation: list[list[float]]
    """3 rows of 3."""
    translation_mm: list[float]
    """x, y, z in mm."""


class AbsentMessage(Message):
    """Something that is not known, with the reason."""

    kind: Literal["absent"] = "absent"
    reason: AbsentReason


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
    best_score_ratio: float | None
    """The best that anything in this image reached; null where only a part of it was searched."""


class MarkerMessage(Message):
    """One marker by name."""

    name: str
    unseen_s: float | None
    """How long ago it was seen, 0 in an image that shows it; null where it never was, or nobody watches."""
    sighting: Annotated[MarkerSeenMessage | MarkerUnseenMessage, Field(discriminator="kind")]


class ToolMessage(Message):
    """A tool placed by its marker."""

    kind: Literal["tool"] = "tool"
    camera_from_tool: PoseMessage
    tip_sd_mm: float
    """Standard deviation of the tip: root of the trace of its covariance, from the marker's edges alone."""
    lag_ms: float
    """How far the pose lies behind its image, where it was steadied; else 0."""


class VertebraMessage(Message):
    """The plan's vertebra, placed by the registration, and by the reference where it is fixed to that."""

    kind: Literal["vertebra"] = "vertebra"
    camera_from_vertebra: PoseMessage
    covariance: list[list[float]]
    """6 rows of 6 [mm, rad]: translation first, then the rotation as a small vector from the left."""


def marker_message(
    name: str, sighting: Sighting, *, unseen_s: float | None, calibrated: bool
) -> MarkerMessage:
    """The message of a marker; its pose only where the camera is calibrated."""
    return MarkerMessage(name=name, unseen_s=unseen_s, sighting=_sighting(sighting, calibrated=calibrated))


def tool_message(tool: ToolInView | Absent) -> ToolMessage | AbsentMessage:
    """The message of where a tool is."""
    if isinstance(tool, Absent):
        return absent_message(tool)
    pose = tool.camera_from_tool
    return ToolMessage(
        camera_from_tool=_pose(pose.rotation, pose.translation_mm),
        tip_sd_mm=math.sqrt(float(np.trace(tool.tip_covariance_mm2))),
        lag_ms=tool.lag_ms,
    )


def vertebra_message(vertebra: PlacedVertebra | Absent) -> VertebraMessage | AbsentMessage:
    """The message of where the plan is."""
    if isinstance(vertebra, Absent):
        return absent_message(vertebra)
    pose = vertebra.camera_from_vertebra
    return VertebraMessage(
        camera_from_vertebra=_pose(pose.rotation, pose.translation_mm),
        covariance=vertebra.covariance.tolist(),
    )


def absent_message(absent: Absent) -> AbsentMessage:
    """The message of what is not known."""
    return AbsentMessage(reason=absent.reason)


def _pose(rotation: Array, translation_mm: Array) -> PoseMessage:
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
