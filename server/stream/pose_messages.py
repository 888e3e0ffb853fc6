"""Poses of markers, tools and the vertebra, or the reason why one is unknown."""

import math
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

from server.number_format import finite
from server.stream.message import Message
from tracker.geometry import Rigid
from tracker.navigation import Absent, AbsentReason, ToolPose, VertebraPose
from tracker.pose import FoundBy, Seen, Sighting, UnseenReason


class PoseMessage(Message):
    """A rigid transform: `x_camera = rotation @ x + translation_mm`."""

    rotation: list[list[float]]
    """3 rows of 3."""
    translation_mm: list[float]
    """x, y, z in mm."""


class AbsentMessage(Message):
    """An unknown value, with the reason."""

    kind: Literal["absent"] = "absent"
    reason: AbsentReason


class MarkerSeenMessage(Message):
    """A marker detected in this image."""

    kind: Literal["seen"] = "seen"
    corners_px: list[list[float]]
    """Top-left, top-right, bottom-right, bottom-left of the printed face, (u, v) in px; empty for a body of
    an external tracker."""
    camera_from_marker: PoseMessage | None
    """Pose of the marker; null while the camera is not calibrated."""
    score_ratio: float | None
    """This and the following figures are null for a body of an external tracker."""
    target_score_ratio: float | None
    model_coverage_ratio: float | None
    target_coverage_ratio: float | None
    fit_error_px2: float | None
    found_by: FoundBy


class MarkerUnseenMessage(Message):
    """A marker that is not detected in this image."""

    kind: Literal["unseen"] = "unseen"
    reason: UnseenReason
    best_score_ratio: float | None
    """The best score in this image; null where only a part of it was searched."""


class MarkerMessage(Message):
    """One marker by name."""

    name: str
    unseen_s: float | None
    """Time since it was last seen, 0 in an image that shows it; null if it never was, or is not monitored."""
    sighting: Annotated[MarkerSeenMessage | MarkerUnseenMessage, Field(discriminator="kind")]


class ToolMessage(Message):
    """Pose of a tool, from its marker."""

    kind: Literal["tool"] = "tool"
    camera_from_tool: PoseMessage
    tip_sd_mm: float
    """Standard deviation of the tip: root of the trace of its covariance, from the marker's edges alone."""
    lag_ms: float
    """Lag of a filtered pose behind its image; else 0."""


class VertebraMessage(Message):
    """Pose of the plan's vertebra, from the registration and, if fixed to it, the reference marker."""

    kind: Literal["vertebra"] = "vertebra"
    camera_from_vertebra: PoseMessage
    covariance: list[list[float]]
    """6 rows of 6 [mm, rad]: translation first, then a left rotation vector."""


def marker_message(
    name: str, sighting: Sighting, *, unseen_s: float | None, calibrated: bool
) -> MarkerMessage:
    """Return the message of a marker; its pose only where the camera is calibrated."""
    return MarkerMessage(name=name, unseen_s=unseen_s, sighting=_sighting(sighting, calibrated=calibrated))


def tool_message(tool: ToolPose | Absent) -> ToolMessage | AbsentMessage:
    """Return the message of a tool's pose."""
    if isinstance(tool, Absent):
        return absent_message(tool)
    pose = tool.camera_from_tool
    return ToolMessage(
        camera_from_tool=pose_message(pose),
        tip_sd_mm=math.sqrt(float(np.trace(tool.tip_covariance_mm2))),
        lag_ms=tool.lag_ms,
    )


def vertebra_message(vertebra: VertebraPose | Absent) -> VertebraMessage | AbsentMessage:
    """Return the message of the vertebra's pose."""
    if isinstance(vertebra, Absent):
        return absent_message(vertebra)
    pose = vertebra.camera_from_vertebra
    return VertebraMessage(
        camera_from_vertebra=pose_message(pose),
        covariance=vertebra.covariance.tolist(),
    )


def absent_message(absent: Absent) -> AbsentMessage:
    """Return the message of an unknown value."""
    return AbsentMessage(reason=absent.reason)


def pose_message(pose: Rigid[Any, Any]) -> PoseMessage:
    """Return the message of a rigid transform."""
    return PoseMessage(rotation=pose.rotation.tolist(), translation_mm=pose.translation_mm.tolist())


def _sighting(sighting: Sighting, *, calibrated: bool) -> MarkerSeenMessage | MarkerUnseenMessage:
    if not isinstance(sighting, Seen):
        return MarkerUnseenMessage(reason=sighting.reason, best_score_ratio=sighting.best_score_ratio)
    pose = sighting.camera_from_marker
    return MarkerSeenMessage(
        corners_px=sighting.corners_px.tolist(),
        camera_from_marker=pose_message(pose) if calibrated else None,
        score_ratio=finite(sighting.score_ratio),
        target_score_ratio=finite(sighting.target_score_ratio),
        model_coverage_ratio=finite(sighting.model_coverage_ratio),
        target_coverage_ratio=finite(sighting.target_coverage_ratio),
        fit_error_px2=finite(sighting.fit_error_px2),
        found_by=sighting.found_by,
    )
