"""The navigation state of one image.

Overlay, JSON, 3-D scene and recording derive from this record, so they cannot disagree. A missing value is an
`Absent` with its reason, never None, 0 or the last pose.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from tracker.camera import CameraModel, ControlChange
from tracker.geometry import (
    Array,
    Camera,
    Rigid,
    Tool,
    Vertebra,
)
from tracker.navigation.assessment import Assessment
from tracker.navigation.deviation import Deviation
from tracker.navigation.drill_reference import ScrewSize
from tracker.navigation.figures import DrillLimits
from tracker.navigation.monitoring import NeverSeen, SceneState
from tracker.navigation.placed_screw import PlacedScrew
from tracker.navigation.uncertainty import DrillAnalysis
from tracker.photometric import FocalLengthError
from tracker.plan import Channel
from tracker.plan.pedicle import Side
from tracker.pose import Sighting, ToolModel
from tracker.registration import Registration


class AbsentReason(StrEnum):
    """Reason why a pose or a number is missing."""

    MARKER_UNSEEN = "MARKER_UNSEEN"  # the marker is not seen in this image
    MARKER_TWICE = "MARKER_TWICE"  # two prints of the tool's or the patient's marker are in view
    CAMERA_NOT_CALIBRATED = "CAMERA_NOT_CALIBRATED"  # detected, but without a metric pose
    CAMERA_CHANGED = "CAMERA_CHANGED"  # focus or zoom are not what they were at the calibration
    POSE_UNCERTAIN = "POSE_UNCERTAIN"  # seen, but the uncertainty of the tip is too large
    TOOL_NOT_DEFINED = "TOOL_NOT_DEFINED"  # the tip of this marker is not calibrated
    NOT_REGISTERED = "NOT_REGISTERED"  # plan and patient are not registered
    NO_PLAN = "NO_PLAN"  # there is no channel
    REFERENCE_UNSEEN = "REFERENCE_UNSEEN"  # the marker on the patient is not seen in this image
    CAMERA_MOVED = "CAMERA_MOVED"  # the camera moved since the registration
    REFERENCE_MOVED = "REFERENCE_MOVED"  # the marker on the patient moved, or the patient did
    POSE_JUMPED = "POSE_JUMPED"  # seen, but it moved faster than a hand can
    NOT_CHECKED = "NOT_CHECKED"  # registered, but not yet checked on a landmark
    NOT_CONFIRMED = "NOT_CONFIRMED"  # restarted; nobody has confirmed yet that nothing moved
    NOT_COSIGNED = "NOT_COSIGNED"  # a second person has not yet signed plan or registration


@dataclass(frozen=True, slots=True, kw_only=True)
class Absent:
    """A missing value, with its reason."""

    reason: AbsentReason


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolPose:
    """Pose of a drill, from its marker.

    Attributes:
        camera_from_tool: tip (origin) and drilling direction (+z) in the camera frame.
        tip_covariance_mm2: (3, 3), of the tip in the camera frame.
        lag_ms: delay of a smoothed pose relative to its image; else 0.
    """

    camera_from_tool: Rigid[Camera, Tool]
    tip_covariance_mm2: Array
    lag_ms: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Setup:
    """Configuration of navigation.

    Attributes:
        camera: the camera model; while `camera_calibrated` is False it only serves to find the marker.
        camera_calibrated: whether poses in mm may be derived from it.
        tools: tool models by name, each with the name of its marker.
        channel: the planned channel.
        registration: of plan and patient, anchored to the camera or to the patient's reference.
        reference: name of the marker fixed to the patient; empty if there is none.
        screw: the planned one; None if there is none.
        withheld: reason why no numbers are displayed although they are known; None if they are displayed.
        max_tip_sd_mm: maximum uncertainty of a tip (root of the trace of its covariance); above it the pose
            is rejected.
        limits: limits of a drill in addition to those of its pedicle.
        side: of the patient, as planned; None if not stated.
        ct_id: of the CT on which the channel was planned; empty if there is none.
        min_errors_95_mm: by tool name, the minimum 95 % error on the channel with this registration, see
            `registration_check.check_setup`. Tools for which it is not known are missing.
        placed_screws: screws already placed in this vertebra.
        has_images: whether poses are measured in images. False with an external tracker: its frame takes the
            place of the camera's, images are blank, and nothing may be projected into them.
    """

    camera: CameraModel
    camera_calibrated: bool
    tools: Mapping[str, ToolModel]
    channel: Channel | Absent
    registration: Registration | Absent
    reference: str = ""
    screw: ScrewSize | None = None
    withheld: AbsentReason | None = None
    max_tip_sd_mm: float = 3.0
    limits: DrillLimits = field(default_factory=DrillLimits)
    side: Side | None = None
    ct_id: str = ""
    min_errors_95_mm: Mapping[str, float] = field(default_factory=dict)
    placed_screws: tuple[PlacedScrew, ...] = ()
    has_images: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class VertebraPose:
    """Pose of the planned vertebra in one image.

    Attributes:
        camera_from_vertebra: through the reference, if the registration is anchored to it.
        covariance: (6, 6) [mm, rad], as of a marker's pose; from the registration and the reference in this
            image.
        tip_jacobian: (6, 3), derivative of the pose with respect to the tip used for registration, see
            `Registration`.
        tool: the tool with that tip; empty if none.
    """

    camera_from_vertebra: Rigid[Camera, Vertebra]
    covariance: Array
    tip_jacobian: Array = field(default_factory=lambda: np.zeros((6, 3)))
    tool: str = ""

    def tip_jacobian_for(self, tool: ToolModel) -> Array:
        """Return the Jacobian for the navigated tool: zero for a tool other than the registering one."""
        return self.tip_jacobian if tool.name == self.tool else np.zeros((6, 3))


@dataclass(frozen=True, slots=True, kw_only=True)
class MotionState:
    """State derived from previous images; see `tracker.navigation.monitoring`.

    Attributes:
        jumped: markers whose pose moved faster than a hand.
        camera_moved: since the registration; only another registration resets it.
        reference_moved: the patient's marker moved since the registration; a check on anatomy resets it.
        scene: state of the static scene.
        unseen_s: by marker, time since it was last seen; 0 if seen in this image.
        camera_changes: camera controls that differ from those at calibration, which invalidates it; the most
            severe first.
        focal_length_error: of the calibrated camera, by the perspective of the markers; None if not known.
    """

    jumped: frozenset[str] = frozenset()
    camera_moved: bool = False
    reference_moved: bool = False
    scene: SceneState = SceneState.UNSURE
    unseen_s: Mapping[str, float | NeverSeen] = field(default_factory=dict)
    camera_changes: tuple[ControlChange, ...] = ()
    focal_length_error: FocalLengthError | None = None


NO_MOTION = MotionState()


@dataclass(frozen=True, slots=True, kw_only=True)
class NavigationSnapshot:
    """One image and all results derived from it.

    Attributes:
        image_number: counts every image of the source, including skipped ones; the first is 0.
        captured_at_s: monotonic time of the capture.
        size_wh_px: of the image.
        setup: the configuration in effect.
        sightings: by marker name.
        vertebra: pose of the planned vertebra in this image, or the reason why it is absent.
        tools: by tool name.
        deviations: by tool name, of the tool from the channel.
        analyses: by tool name, clearance, uncertainty and breach probability; present together with the
            deviation.
        assessments: by tool name, the displayed figures with limits and verdict; present together with the
            deviation. Headline, alarms, overlay, bull's-eye, wire messages and log use them.
        motion: state of the motion monitors.
        stage_ms: time of each stage by its name in the code.
        skipped_images: number of images of the source that were not processed, since the start.
    """

    image_number: int
    captured_at_s: float
    size_wh_px: tuple[int, int]
    setup: Setup
    sightings: Mapping[str, Sighting]
    vertebra: VertebraPose | Absent
    tools: Mapping[str, ToolPose | Absent]
    deviations: Mapping[str, Deviation | Absent]
    analyses: Mapping[str, DrillAnalysis | Absent]
    assessments: Mapping[str, Assessment | Absent]
    stage_ms: Mapping[str, float]
    skipped_images: int
    motion: MotionState = NO_MOTION

    @property
    def displayed_tool(self) -> str:
        """Return the tool whose figures are displayed: the one with the most severe verdict.

        Among equals the first in the order of the setup. Empty if no tool has figures.
        """
        ranks = {name: one.rank for name, one in self.assessments.items() if isinstance(one, Assessment)}
        return max(ranks, key=lambda name: ranks[name], default="")

    def vertebra_from_tool(self, tool: str) -> Rigid[Vertebra, Tool] | Absent:
        """Return the pose of a tool in the vertebra frame; Absent for the same reason as its deviation."""
        deviation, in_view, vertebra = self.deviations[tool], self.tools[tool], self.vertebra
        if isinstance(deviation, Absent):
            return deviation
        if isinstance(in_view, Absent):
            return in_view
        if isinstance(vertebra, Absent):
            return vertebra
        return vertebra.camera_from_vertebra.inverse @ in_view.camera_from_tool
