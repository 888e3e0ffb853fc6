"""What a drill is measured against in one pedicle: wall, room and screw.

It is sent to the tracking process once for each channel and is never part of a snapshot: the distances take
a second or three in a job, and until they are there the pedicle's outline is the wall. A replay therefore
needs the plan and the surface beside the snapshots.
"""

from dataclasses import dataclass

from tracker.geometry import Array, Camera, Marker, Tool, Vertebra, inverse_slopes, slopes_of_product
from tracker.navigation.certainty import Drill, Judged, Placed, Room, judge, marker_from_tool
from tracker.navigation.clearance import WallField
from tracker.navigation.clearance.outline import field_of_channel
from tracker.plan import Channel
from tracker.plan.pedicle import Side
from tracker.pose import ToolModel


@dataclass(frozen=True, slots=True, kw_only=True)
class ScrewSize:
    """A screw that is planned on the channel's axis, from its entry on."""

    radius_mm: float
    length_mm: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Guide:
    """All that is known of the pedicle besides its channel; too large to go with each image.

    Attributes:
        wall: distances to the bone; where it is not known, to the pedicle's outline or to the channel.
        room: what the pedicle leaves to navigation; None takes what the channel leaves to the drill.
        screw: that is planned; None where none is.
        side: the plan's side of the patient; None where nobody said it.
        wall_sd_mm: how far the wall may be from where the CT has it: half a voxel, and the threshold.
    """

    wall: WallField
    room: Room | None = None
    screw: ScrewSize | None = None
    side: Side | None = None
    wall_sd_mm: float = 0.0

    @classmethod
    def of_channel(cls, channel: Channel) -> "Guide":
        """Where nothing but the channel is known."""
        return cls(wall=field_of_channel(channel))

    def judged(self, tool: Placed[Vertebra, Tool], model: ToolModel, channel: Channel) -> Judged:
        """Clearance, uncertainty and chance of a breach of a drill that is placed in the plan."""
        room = self.room or Room.of_channel(channel, radius_mm=model.radius_mm)
        drill = Drill(
            radius_mm=model.radius_mm,
            length_mm=model.length_mm,
            screw_radius_mm=None if self.screw is None else self.screw.radius_mm,
        )
        return judge(tool, channel, self.wall, room, drill, side=self.side, wall_sd_mm=self.wall_sd_mm)


def placed_tool(
    camera_from_vertebra: Placed[Camera, Vertebra],
    camera_from_marker: Placed[Camera, Marker],
    tool: ToolModel,
    *,
    tip_slope: Array | None = None,
) -> Placed[Vertebra, Tool]:
    """A tool in the plan's frame, with all that is unsure on the way: registration, marker, calibration.

    `tip_slope`: (6, 3), how `camera_from_vertebra` follows an error of this tool's tip, where the landmarks
    were touched with it: a tip that is thought too far left puts the bone too far left, too.
    """
    camera_from_tool = camera_from_marker @ marker_from_tool(tool)
    found = camera_from_vertebra.inverse @ camera_from_tool
    if tip_slope is None or not tip_slope.any():
        return found
    of_bone, of_tool = slopes_of_product(camera_from_vertebra.pose.inverse, camera_from_tool.pose)
    through_bone = of_bone @ inverse_slopes(camera_from_vertebra.pose) @ tip_slope
    through_tool = of_tool[:, :3] @ camera_from_marker.pose.rotation
    common = through_bone @ tool.tip_covariance_mm2 @ through_tool.T
    return Placed(pose=found.pose, covariance=found.covariance + common + common.T)
