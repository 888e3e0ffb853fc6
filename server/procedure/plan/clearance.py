"""Clearance of each planned screw to the wall, by depth."""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

from server.procedure.plan.active_channel import ActiveChannel
from server.procedure.plan.repository import is_same_channel
from tracker.navigation.clearance import WallDistanceField, WallSource, screw_clearance_along
from tracker.plan import PlanDocument, VertebraPlan
from tracker.plan.document import PlannedChannel
from tracker.plan.pedicle import Side
from tracker.plan.screw import ClearanceAlong, clearance_along


class NoClearance(StrEnum):
    """Why the clearance of a channel is unknown."""

    NO_SCREW = "NO_SCREW"  # no screw is chosen
    NOT_MEASURED = "NOT_MEASURED"  # the pedicle is not measured, and no bone surface is its wall
    BESIDE_WALL = "BESIDE_WALL"  # no part of the screw lies where the wall is known


@dataclass(frozen=True, slots=True, kw_only=True)
class ActiveBone:
    """The bone around the active channel."""

    active: ActiveChannel
    wall: WallDistanceField


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedClearance:
    """Clearance of the screw in one channel.

    Attributes:
        vertebra, side: of the channel.
        against: which wall.
        along: by depth, or why it is unknown.
    """

    vertebra: str
    side: Side
    against: WallSource
    along: ClearanceAlong | NoClearance


def planned_clearances(plan: PlanDocument, bone: ActiveBone | None) -> Iterator[PlannedClearance]:
    """Return the clearance in each channel.

    The wall is the bone's surface for the active channel, if the distances to it are known, else the outline
    of the measured pedicle, as for the grade.
    """
    for vertebra in plan.vertebrae:
        for planned in vertebra.channels:
            wall = None if bone is None or not _is_active(bone.active, vertebra, planned) else bone.wall
            yield PlannedClearance(
                vertebra=vertebra.name,
                side=planned.side,
                against=WallSource.PEDICLE if wall is None else wall.against,
                along=_along(vertebra, planned, wall),
            )


def _along(
    vertebra: VertebraPlan, planned: PlannedChannel, wall: WallDistanceField | None
) -> ClearanceAlong | NoClearance:
    if not planned.screws:
        return NoClearance.NO_SCREW
    screw = planned.screws[0]
    if wall is not None:
        along = screw_clearance_along(
            planned.channel, wall, diameter_mm=screw.diameter_mm, length_mm=screw.length_mm
        )
        return along or NoClearance.BESIDE_WALL
    pedicle = vertebra.pedicle(planned.side)
    if pedicle is None:
        return NoClearance.NOT_MEASURED
    along = clearance_along(
        planned.channel, pedicle.used, diameter_mm=screw.diameter_mm, length_mm=screw.length_mm
    )
    return along or NoClearance.BESIDE_WALL


def _is_active(active: ActiveChannel, vertebra: VertebraPlan, planned: PlannedChannel) -> bool:
    return (
        active.vertebra == vertebra.name
        and active.side == planned.side
        and is_same_channel(active.channel, planned.channel)
    )
