"""All that is known at the instant of one image.

Overlay, JSON, 3-D scene and recording are made from this one record, so they cannot disagree. What is absent
is a value with its reason, never None, 0 or the last pose.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from tracker.camera import CameraModel
from tracker.geometry import Array, Camera, Marker, Rigid, Tool, Vertebra, point_covariance_mm2
from tracker.navigation.deviation import Deviation, deviation_from_channel
from tracker.plan import Channel
from tracker.pose import Seen, Sighting, SteadyPose, ToolModel


class AbsentReason(StrEnum):
    """Why a pose or a number is not there."""

    MARKER_UNSEEN = "MARKER_UNSEEN"  # the marker is not seen in this image
    CAMERA_NOT_CALIBRATED = "CAMERA_NOT_CALIBRATED"  # found in the picture, but mm are not known
    POSE_UNCERTAIN = "POSE_UNCERTAIN"  # seen, but the tip could be millimetres away from where it seems
    TOOL_NOT_DEFINED = "TOOL_NOT_DEFINED"  # nobody said where the tip is behind this marker
    NOT_REGISTERED = "NOT_REGISTERED"  # plan and patient are not registered
    NO_PLAN = "NO_PLAN"  # there is no channel
    REFERENCE_UNSEEN = "REFERENCE_UNSEEN"  # the patient's marker is not seen in this image
    CAMERA_MOVED = "CAMERA_MOVED"  # since the registration
    REFERENCE_MOVED = "REFERENCE_MOVED"  # since the registration
    POSE_JUMPED = "POSE_JUMPED"  # farther than a hand moves, or two poses explain the image
    NOT_CHECKED = "NOT_CHECKED"  # nobody has looked


@dataclass(frozen=True, slots=True, kw_only=True)
class Absent:
    """Something that is not known, with the reason."""

    reason: AbsentReason


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolInView:
    """The drill, placed by its marker.

    Attributes:
        camera_from_tool: tip (origin) and drilling direction (+z) in the camera's frame.
        tip_covariance_mm2: (3, 3), of the tip in the camera's frame.
        lag_ms: how far it lies behind its image, where it was steadied; else 0.
    """

    camera_from_tool: Rigid[Camera, Tool]
    tip_covariance_mm2: Array
    lag_ms: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Setup:
    """What stands before the first image: camera, tools, plan, registration.

    Attributes:
        camera: the camera model; where `camera_calibrated` is False it only serves to find the marker.
        camera_calibrated: whether poses in mm may be derived from it.
        tools: by name; each names the marker that it carries.
        channel: the planned channel.
        camera_from_vertebra: the registration, for this camera position.
        most_tip_sd_mm: a tip that is less sure than this (root of the trace of its covariance) is not placed.
        registered_by: in words, how the registration was made ("rehearsal" when known by the theatre).
    """

    camera: CameraModel
    camera_calibrated: bool
    tools: Mapping[str, ToolModel]
    channel: Channel | Absent
    camera_from_vertebra: Rigid[Camera, Vertebra] | Absent
    registered_by: str
    most_tip_sd_mm: float = 3.0


@dataclass(frozen=True, slots=True, kw_only=True)
class NavigationSnapshot:
    """One image, and all that was concluded from it.

    Attributes:
        image_number: counts every image that the source gave, skipped ones too; the first is 0.
        captured_at_s: monotonic time at the grab.
        size_wh_px: of the image.
        setup: what stood when it was concluded.
        sightings: by marker name.
        tools: by tool name.
        deviations: by tool name, of the tool from the channel.
        stage_ms: time of each stage by the name it has in the code.
        skipped_images: how many images the source gave that were never looked at, since the start.
    """

    image_number: int
    captured_at_s: float
    size_wh_px: tuple[int, int]
    setup: Setup
    sightings: Mapping[str, Sighting]
    tools: Mapping[str, ToolInView | Absent]
    deviations: Mapping[str, Deviation | Absent]
    stage_ms: Mapping[str, float]
    skipped_images: int


def tool_in_view(
    setup: Setup, tool: ToolModel, sighting: Sighting, steadied: SteadyPose | None = None
) -> ToolInView | Absent:
    """Where the tool is in the camera's frame, or why that is not known.

    A steadied pose takes the place of the image's own, unless it is too unsure of where the tip is now.
    """
    if not isinstance(sighting, Seen):
        return Absent(reason=AbsentReason.MARKER_UNSEEN)
    if not setup.camera_calibrated:
        return Absent(reason=AbsentReason.CAMERA_NOT_CALIBRATED)
    own = _placed(tool, sighting.camera_from_marker, sighting.pose_covariance)
    # Also where two poses explain the image: the covariance then spans both.
    if _tip_sd_mm(own) > setup.most_tip_sd_mm:
        return Absent(reason=AbsentReason.POSE_UNCERTAIN)
    if steadied is None:
        return own
    steady = _placed(tool, steadied.camera_from_marker, steadied.pose_covariance, lag_ms=steadied.lag_ms)
    return own if _tip_sd_mm(steady) > setup.most_tip_sd_mm else steady


def _placed(
    tool: ToolModel, pose: Rigid[Camera, Marker], covariance: Array, *, lag_ms: float = 0.0
) -> ToolInView:
    tip_in_marker = tool.marker_from_tool.translation_mm
    return ToolInView(
        camera_from_tool=pose @ tool.marker_from_tool,
        tip_covariance_mm2=point_covariance_mm2(pose, covariance, tip_in_marker),
        lag_ms=lag_ms,
    )


def _tip_sd_mm(tool: ToolInView) -> float:
    return float(np.sqrt(np.trace(tool.tip_covariance_mm2)))


def tool_deviation(setup: Setup, tool: ToolInView | Absent) -> Deviation | Absent:
    """The tool's deviation from the channel, or why it is not known."""
    if isinstance(tool, Absent):
        return tool
    if isinstance(setup.channel, Absent):
        return setup.channel
    if isinstance(setup.camera_from_vertebra, Absent):
        return setup.camera_from_vertebra
    return deviation_from_channel(setup.camera_from_vertebra.inverse @ tool.camera_from_tool, setup.channel)


def navigate(
    *,
    setup: Setup,
    sightings: Mapping[str, Sighting],
    image_number: int,
    captured_at_s: float,
    size_wh_px: tuple[int, int],
    stage_ms: Mapping[str, float],
    skipped_images: int,
    steadied: Mapping[str, SteadyPose] | None = None,
) -> NavigationSnapshot:
    """The snapshot of one image from what was seen in it.

    Where a tool's pose was steadied (`Steadying`), everything that is said of the tool comes from that pose.
    """
    steady = steadied or {}
    tools = {
        name: tool_in_view(setup, tool, sightings[tool.marker], steady.get(name))
        for name, tool in setup.tools.items()
    }
    return NavigationSnapshot(
        image_number=image_number,
        captured_at_s=captured_at_s,
        size_wh_px=size_wh_px,
        setup=setup,
        sightings=sightings,
        tools=tools,
        deviations={name: tool_deviation(setup, tool) for name, tool in tools.items()},
        stage_ms=stage_ms,
        skipped_images=skipped_images,
    )
