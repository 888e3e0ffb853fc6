"""All that is known at the instant of one image.

Overlay, JSON, 3-D scene and recording are made from this one record, so they cannot disagree. What is absent
is a value with its reason, never None, 0 or the last pose.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from tracker.camera import CameraModel
from tracker.geometry import (
    Anchor,
    Array,
    Camera,
    Marker,
    Rigid,
    Tool,
    Vertebra,
    chained_covariance,
    point_covariance_mm2,
)
from tracker.navigation.deviation import Deviation, deviation_from_channel
from tracker.plan import Channel
from tracker.pose import Seen, Sighting, SteadyPose, ToolModel
from tracker.registration import AnchoredTo, Registration


class AbsentReason(StrEnum):
    """Why a pose or a number is not there."""

    MARKER_UNSEEN = "MARKER_UNSEEN"  # the marker is not seen in this image
    CAMERA_NOT_CALIBRATED = "CAMERA_NOT_CALIBRATED"  # found in the picture, but mm are not known
    POSE_UNCERTAIN = "POSE_UNCERTAIN"  # seen, but the tip could be millimetres away from where it seems
    TOOL_NOT_DEFINED = "TOOL_NOT_DEFINED"  # nobody said where the tip is behind this marker
    NOT_REGISTERED = "NOT_REGISTERED"  # plan and patient are not registered
    NO_PLAN = "NO_PLAN"  # there is no channel
    REFERENCE_UNSEEN = "REFERENCE_UNSEEN"  # the marker on the patient is not seen in this image
    CAMERA_MOVED = "CAMERA_MOVED"  # the camera stands elsewhere than when plan and patient were registered
    REFERENCE_MOVED = "REFERENCE_MOVED"  # the marker on the patient moved, or the patient did
    POSE_JUMPED = "POSE_JUMPED"  # seen, but farther away than a hand gets from one image to the next
    NOT_CHECKED = "NOT_CHECKED"  # registered, but not yet held against a landmark


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
        registration: of plan and patient, fixed to the camera or to the patient's reference.
        reference: name of the marker that is fixed to the patient; empty when there is none.
        withheld: why no number is given although all of this is known; None when nothing is in the way.
        most_tip_sd_mm: a tip that is less sure than this (root of the trace of its covariance) is not placed.
    """

    camera: CameraModel
    camera_calibrated: bool
    tools: Mapping[str, ToolModel]
    channel: Channel | Absent
    registration: Registration | Absent
    reference: str = ""
    withheld: AbsentReason | None = None
    most_tip_sd_mm: float = 3.0


@dataclass(frozen=True, slots=True, kw_only=True)
class PlacedVertebra:
    """Where the plan's vertebra is in one image.

    Attributes:
        camera_from_vertebra: through the reference, where the registration is fixed to it.
        covariance: (6, 6) [mm, rad] of it, as of a marker's pose; of the registration, and of the reference
            as it is seen in this image.
    """

    camera_from_vertebra: Rigid[Camera, Vertebra]
    covariance: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class NavigationSnapshot:
    """One image, and all that was concluded from it.

    Attributes:
        image_number: counts every image that the source gave, skipped ones too; the first is 0.
        captured_at_s: monotonic time at the grab.
        size_wh_px: of the image.
        setup: what stood when it was concluded.
        sightings: by marker name.
        vertebra: where the plan is in this image, or why that is not known.
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
    vertebra: PlacedVertebra | Absent
    tools: Mapping[str, ToolInView | Absent]
    deviations: Mapping[str, Deviation | Absent]
    stage_ms: Mapping[str, float]
    skipped_images: int

    def vertebra_from_tool(self, tool: str) -> Rigid[Vertebra, Tool] | Absent:
        """Where a tool is in the plan; Absent where it has no numbers either, for the same reason."""
        deviation, in_view, vertebra = self.deviations[tool], self.tools[tool], self.vertebra
        if isinstance(deviation, Absent):
            return deviation
        if isinstance(in_view, Absent):
            return in_view
        if isinstance(vertebra, Absent):
            return vertebra
        return vertebra.camera_from_vertebra.inverse @ in_view.camera_from_tool


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


def placed_vertebra(setup: Setup, sightings: Mapping[str, Sighting]) -> PlacedVertebra | Absent:
    """Where the plan's vertebra is in this image, or why that is not known."""
    registration = setup.registration
    if isinstance(registration, Absent):
        return registration
    if registration.anchored_to is AnchoredTo.CAMERA:
        fixed = registration.anchor_from_vertebra
        return PlacedVertebra(
            camera_from_vertebra=Rigid(rotation=fixed.rotation, translation_mm=fixed.translation_mm),
            covariance=registration.covariance,
        )
    seen = sightings.get(setup.reference)
    if not isinstance(seen, Seen):
        return Absent(reason=AbsentReason.REFERENCE_UNSEEN)
    if not setup.camera_calibrated:
        return Absent(reason=AbsentReason.CAMERA_NOT_CALIBRATED)
    marker = seen.camera_from_marker
    camera_from_anchor: Rigid[Camera, Anchor] = Rigid(
        rotation=marker.rotation, translation_mm=marker.translation_mm
    )
    return PlacedVertebra(
        camera_from_vertebra=camera_from_anchor @ registration.anchor_from_vertebra,
        covariance=chained_covariance(
            camera_from_anchor,
            seen.pose_covariance,
            registration.anchor_from_vertebra,
            registration.covariance,
        ),
    )


def tool_deviation(
    setup: Setup, tool: ToolInView | Absent, vertebra: PlacedVertebra | Absent
) -> Deviation | Absent:
    """The tool's deviation from the channel, or why it is not known."""
    if isinstance(tool, Absent):
        return tool
    if isinstance(setup.channel, Absent):
        return setup.channel
    if isinstance(vertebra, Absent):
        return vertebra
    if setup.withheld is not None:
        return Absent(reason=setup.withheld)
    return deviation_from_channel(
        vertebra.camera_from_vertebra.inverse @ tool.camera_from_tool, setup.channel
    )


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
    vertebra = placed_vertebra(setup, sightings)
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
        vertebra=vertebra,
        tools=tools,
        deviations={name: tool_deviation(setup, tool, vertebra) for name, tool in tools.items()},
        stage_ms=stage_ms,
        skipped_images=skipped_images,
    )
