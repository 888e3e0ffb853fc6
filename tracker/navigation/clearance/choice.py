"""Which wall a channel's drill is measured against: the bone, if its surface agrees with the plan."""

from dataclasses import dataclass

from tracker.errors import PlanError
from tracker.geometry import Rigid, Tool, Vertebra, rotation_between
from tracker.navigation.clearance.drill import Nearest, clearance_of_drill, drill_rings
from tracker.navigation.clearance.field import WallField, field_of_bone
from tracker.navigation.clearance.outline import field_of_channel, field_of_outline
from tracker.plan.channel import Channel
from tracker.plan.pedicle import PedicleMeasure
from tracker.plan.remark import Remark
from tracker.plan.surface import Surface


@dataclass(frozen=True, slots=True, kw_only=True)
class ChosenWall:
    """The wall that was chosen, and why not a better one.

    Attributes:
        wall: the distances.
        remarks: what the user should know; empty where the bone itself is the wall.
    """

    wall: WallField
    remarks: tuple[Remark, ...]


def choose_wall(
    channel: Channel, surface: Surface | None, measure: PedicleMeasure | None, *, radius_mm: float
) -> ChosenWall:
    """The bone's surface; where it is unknown or bad, the pedicle's outline; else the channel alone.

    A surface is bad where the drill would be through it on the planned axis itself: in thick slices a
    threshold eats thin walls, and what is alarmed of then is the surface, not the drill.

    Args:
        channel: the plan.
        surface: of the bone, if one was made.
        measure: of the pedicle, if it was measured.
        radius_mm: of the drill.
    """
    remarks: list[Remark] = []
    if surface is not None:
        try:
            wall = field_of_bone(surface, channel)
        except PlanError as error:
            remarks.append(
                Remark(
                    code=error.code, message=error.message, remedy=error.remedy, context=dict(error.context)
                )
            )
        else:
            planned_mm = on_plan_mm(channel, wall, radius_mm=radius_mm)
            if planned_mm >= 0.0:
                return ChosenWall(wall=wall, remarks=())
            remarks.append(_contradicts(planned_mm))
    other = field_of_channel(channel) if measure is None else field_of_outline(measure, channel)
    return ChosenWall(wall=other, remarks=tuple(remarks))


def on_plan_mm(channel: Channel, wall: WallField, *, radius_mm: float) -> float:
    """The clearance that the drill has when it stands on the planned axis, at the planned depth."""
    pose: Rigid[Vertebra, Tool] = Rigid(
        rotation=rotation_between([0.0, 0.0, 1.0], channel.axis_in_vertebra),
        translation_mm=channel.target_in_vertebra_mm,
    )
    rings = drill_rings(pose, channel, wall, radius_mm=radius_mm, length_mm=channel.length_mm)
    now = clearance_of_drill(rings, pose, channel).now
    return now.clearance_mm if isinstance(now, Nearest) else 0.0


def _contradicts(planned_mm: float) -> Remark:
    return Remark(
        code="BONE_CONTRADICTS_PLAN",
        message=f"on the planned axis the drill is {-planned_mm:.1f} mm through the bone's surface",
        remedy="Make the surface again, from finer slices or with another threshold, or move the channel.",
        context={"through_mm": -planned_mm},
    )
