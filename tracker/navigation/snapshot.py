"""All that is known at the instant of one image.

Overlay, JSON, 3-D scene and recording are made from this one record, so they cannot disagree. What is absent
is a value with its reason, never None, 0 or the last pose.
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
from tracker.navigation.certainty import Judged
from tracker.navigation.deviation import Deviation
from tracker.navigation.figures import DrillLimits
from tracker.navigation.guide import ScrewSize
from tracker.navigation.watch import NeverSeen, SceneState
from tracker.plan import Channel
from tracker.plan.pedicle import Side
from tracker.pose import Sighting, ToolModel
from tracker.registration import Registration


class AbsentReason(StrEnum):
    """Why a pose or a number is not there."""

    MARKER_UNSEEN = "MARKER_UNSEEN"  # the marker is not seen in this image
    CAMERA_NOT_CALIBRATED = "CAMERA_NOT_CALIBRATED"  # found in the picture, but mm are not known
    CAMERA_CHANGED = "CAMERA_CHANGED"  # focus or zoom are not what they were at the calibration
    POSE_UNCERTAIN = "POSE_UNCERTAIN"  # seen, but the tip could be millimetres away from where it seems
    TOOL_NOT_DEFINED = "TOOL_NOT_DEFINED"  # nobody said where the tip is behind this marker
    NOT_REGISTERED = "NOT_REGISTERED"  # plan and patient are not registered
    NO_PLAN = "NO_PLAN"  # there is no channel
    REFERENCE_UNSEEN = "REFERENCE_UNSEEN"  # the marker on the patient is not seen in this image
    CAMERA_MOVED = "CAMERA_MOVED"  # the camera stands elsewhere than when plan and patient were registered
    REFERENCE_MOVED = "REFERENCE_MOVED"  # the marker on the patient moved, or the patient did
    POSE_JUMPED = "POSE_JUMPED"  # seen, but farther away than a hand gets from one image to the next
    NOT_CHECKED = "NOT_CHECKED"  # registered, but not yet held against a landmark
    NOT_CONFIRMED = "NOT_CONFIRMED"  # started again, and nobody has said yet that all stands as it did
    NOT_COSIGNED = "NOT_COSIGNED"  # a second person has not yet signed plan or registration


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
        screw: that is planned in it; None where none is.
        registration: of plan and patient, fixed to the camera or to the patient's reference.
        reference: name of the marker that is fixed to the patient; empty when there is none.
        withheld: why no number is given although all of this is known; None when nothing is in the way.
        max_tip_sd_mm: a tip that is less sure than this (root of the trace of its covariance) is not placed.
        limits: of a drill, beside those of its pedicle.
        side: the plan's side of the patient; None where nobody stated it.
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


@dataclass(frozen=True, slots=True, kw_only=True)
class PlacedVertebra:
    """Where the plan's vertebra is in one image.

    Attributes:
        camera_from_vertebra: through the reference, where the registration is fixed to it.
        covariance: (6, 6) [mm, rad] of it, as of a marker's pose; of the registration, and of the reference
            as it is seen in this image.
        tip_slope: (6, 3), how it follows an error of the tip that it was registered with, as a registration
            has it.
        tool: the tool with that tip; empty for none.
    """

    camera_from_vertebra: Rigid[Camera, Vertebra]
    covariance: Array
    tip_slope: Array = field(default_factory=lambda: np.zeros((6, 3)))
    tool: str = ""

    def tip_slope_for(self, tool: ToolModel) -> Array:
        """The same for the tool that is navigated: of another tool's tip, this one's error knows nothing."""
        return self.tip_slope if tool.name == self.tool else np.zeros((6, 3))


@dataclass(frozen=True, slots=True, kw_only=True)
class Watched:
    """What no image says alone; see `tracker.navigation.watch`.

    Attributes:
        jumped: the markers whose pose is farther from the one before than a hand moves.
        camera_moved: since the registration, and nothing takes it back but another one.
        reference_moved: likewise of the marker on the patient; a check on anatomy takes it back.
        scene: what the still scene says of the camera.
        unseen_s: by marker, how long ago it was seen, 0 for one in this image.
        camera_changes: controls of the camera that are not what they were at the calibration in use, and
            void it; what spoils most comes first.
    """

    jumped: frozenset[str] = frozenset()
    camera_moved: bool = False
    reference_moved: bool = False
    scene: SceneState = SceneState.UNSURE
    unseen_s: Mapping[str, float | NeverSeen] = field(default_factory=dict)
    camera_changes: tuple[ControlChange, ...] = ()


UNWATCHED = Watched()


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
        judgements: by tool name, clearance, uncertainty and chance of a breach; there with the deviation.
        assessments: by tool name, the figures that are shown, with their limits and the verdict; there with
            the deviation. Headline, alarms, overlay, bull's-eye, wire and log read them from here.
        watched: what the images before add to it.
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
    judgements: Mapping[str, Judged | Absent]
    assessments: Mapping[str, Assessment | Absent]
    stage_ms: Mapping[str, float]
    skipped_images: int
    watched: Watched = UNWATCHED

    @property
    def shown_tool(self) -> str:
        """The tool whose figures are shown: of those that have any, the one with the most severe verdict.

        Of equal ones the first in the order of the setup. Empty where no tool has figures.
        """
        ranks = {name: one.rank for name, one in self.assessments.items() if isinstance(one, Assessment)}
        return max(ranks, key=lambda name: ranks[name], default="")

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
