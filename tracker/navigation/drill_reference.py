"""Reference data of one pedicle for a drill: wall distances, tolerance and screw.

It is sent to the tracking process once per channel and is not part of a snapshot: the distance field takes
one to three seconds in a job, and until it is ready the pedicle's outline is the wall. A replay therefore
needs the plan and the bone surface in addition to the snapshots.
"""

from dataclasses import dataclass, replace

import numpy as np

from tracker.geometry import Array, Camera, Marker, Tool, Vertebra, inverse_jacobian, product_jacobians
from tracker.navigation.clearance import WallDistanceField
from tracker.navigation.clearance.outline_field import channel_distance_field
from tracker.navigation.uncertainty import (
    Drill,
    DrillAnalysis,
    PedicleTolerance,
    UncertainPose,
    analyse_drill,
    marker_from_tool,
)
from tracker.plan import Channel
from tracker.plan.pedicle import Side
from tracker.pose import ToolModel, covariance_at_lever


@dataclass(frozen=True, slots=True, kw_only=True)
class ScrewSize:
    """A screw planned on the axis of the channel, starting at its entry."""

    radius_mm: float
    length_mm: float

    @classmethod
    def of(cls, *, diameter_mm: float, length_mm: float) -> "ScrewSize":
        """Return the size of a screw as catalogues state it."""
        return cls(radius_mm=0.5 * diameter_mm, length_mm=length_mm)


@dataclass(frozen=True, slots=True, kw_only=True)
class DrillReference:
    """Data of the pedicle in addition to its channel; too large to be sent with each image.

    Attributes:
        wall: distance field of the bone; if unknown, of the pedicle's outline or of the channel.
        tolerance: allowed error in this pedicle; None derives it from the radii of channel and drill.
        screw: the planned one; None if there is none.
        side: of the patient, as planned; None if not stated.
        wall_sd_mm: standard deviation of the wall's position, from the extraction of the surface or a
            default.
    """

    wall: WallDistanceField
    tolerance: PedicleTolerance | None = None
    screw: ScrewSize | None = None
    side: Side | None = None
    wall_sd_mm: float = 0.0

    @classmethod
    def of_channel(cls, channel: Channel) -> "DrillReference":
        """Return a reference from the channel only."""
        return cls(wall=channel_distance_field(channel))

    def analyse(
        self, tool: UncertainPose[Vertebra, Tool], model: ToolModel, channel: Channel
    ) -> DrillAnalysis:
        """Compute clearance, uncertainty and breach probability of a drill in the vertebra frame."""
        drill = Drill(
            radius_mm=model.radius_mm,
            length_mm=model.length_mm,
            screw_radius_mm=None if self.screw is None else self.screw.radius_mm,
        )
        return analyse_drill(
            tool,
            channel,
            self.wall,
            self.tolerance_for(model, channel),
            drill,
            side=self.side,
            wall_sd_mm=self.wall_sd_mm,
        )

    def tolerance_for(self, model: ToolModel, channel: Channel) -> PedicleTolerance:
        """Return the allowed error of this drill in the channel."""
        return self.tolerance or PedicleTolerance.of_channel(channel, radius_mm=model.radius_mm)


def tool_in_vertebra(
    camera_from_vertebra: UncertainPose[Camera, Vertebra],
    camera_from_marker: UncertainPose[Camera, Marker],
    tool: ToolModel,
    *,
    tip_jacobian: Array | None = None,
) -> UncertainPose[Vertebra, Tool]:
    """Return the pose of a tool in the vertebra frame, with all uncertainties propagated to its tip.

    `tip_jacobian`: (6, 3), derivative of `camera_from_vertebra` with respect to this tool's tip, if the
    landmarks were captured with it: the tip error then displaces both bone and drill, and partly cancels.
    """
    lever_mm = float(np.linalg.norm(tool.marker_from_tool.translation_mm))
    at_tip = replace(
        camera_from_marker, covariance=covariance_at_lever(camera_from_marker.covariance, lever_mm)
    )
    camera_from_tool = at_tip @ marker_from_tool(tool)
    found = camera_from_vertebra.inverse @ camera_from_tool
    if tip_jacobian is None or not tip_jacobian.any():
        return found
    of_bone, of_tool = product_jacobians(camera_from_vertebra.pose.inverse, camera_from_tool.pose)
    through_bone = of_bone @ inverse_jacobian(camera_from_vertebra.pose) @ tip_jacobian
    through_tool = of_tool[:, :3] @ camera_from_marker.pose.rotation
    common = through_bone @ tool.tip_covariance_mm2 @ through_tool.T
    return UncertainPose(pose=found.pose, covariance=found.covariance + common + common.T)
