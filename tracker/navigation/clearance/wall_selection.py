"""Select the wall for the drill's clearance: the bone, if its surface agrees with the plan."""

from dataclasses import dataclass

from tracker.errors import PlanError, Remark
from tracker.geometry import Rigid, Tool, Vertebra, rotation_between
from tracker.navigation.clearance.distance_field import WallDistanceField, bone_distance_field
from tracker.navigation.clearance.drill import NearestWall, clearance_of_drill, drill_rings
from tracker.navigation.clearance.outline_field import channel_distance_field, outline_distance_field
from tracker.plan.channel import Channel
from tracker.plan.pedicle import PedicleMeasure
from tracker.plan.surface import Surface


@dataclass(frozen=True, slots=True, kw_only=True)
class WallSelection:
    """The selected wall, with remarks on why no better one was used.

    Attributes:
        wall: distance field of the wall.
        remarks: remarks for the user; empty if the bone itself is the wall.
    """

    wall: WallDistanceField
    remarks: tuple[Remark, ...]


def select_wall(
    channel: Channel, surface: Surface | None, measure: PedicleMeasure | None, *, radius_mm: float
) -> WallSelection:
    """Select the bone's surface; if unknown or contradictory the pedicle's outline, else the channel.

    A surface contradicts the plan if a drill on the planned axis would perforate it: in thick slices a
    threshold removes thin walls, and alarms would then be caused by the surface and not by the drill.

    Args:
        channel: the planned channel.
        surface: of the bone, if available.
        measure: of the pedicle, if measured.
        radius_mm: of the drill.
    """
    remarks: list[Remark] = []
    if surface is not None:
        try:
            wall = bone_distance_field(surface, channel)
        except PlanError as error:
            remarks.append(Remark.from_error(error))
        else:
            planned_mm = planned_clearance_mm(channel, wall, radius_mm=radius_mm)
            if planned_mm >= 0.0:
                return WallSelection(wall=wall, remarks=())
            remarks.append(_contradicts(planned_mm))
    other = channel_distance_field(channel) if measure is None else outline_distance_field(measure, channel)
    return WallSelection(wall=other, remarks=tuple(remarks))


def planned_clearance_mm(channel: Channel, wall: WallDistanceField, *, radius_mm: float) -> float:
    """Return the clearance of a drill on the planned axis at the planned depth."""
    pose: Rigid[Vertebra, Tool] = Rigid(
        rotation=rotation_between([0.0, 0.0, 1.0], channel.axis_in_vertebra),
        translation_mm=channel.target_in_vertebra_mm,
    )
    rings = drill_rings(pose, channel, wall, radius_mm=radius_mm, length_mm=channel.length_mm)
    now = clearance_of_drill(rings, pose, channel).now
    return now.clearance_mm if isinstance(now, NearestWall) else 0.0


def _contradicts(planned_mm: float) -> Remark:
    return Remark(
        code="BONE_CONTRADICTS_PLAN",
        message=f"on the planned axis the drill is {-planned_mm:.1f} mm through the bone's surface",
        remedy="Make the surface again, from finer slices or with another threshold, or move the channel.",
        context={"through_mm": -planned_mm},
    )
