"""Whether the uncertainty is small enough for this pedicle."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Tool, Vertebra
from tracker.navigation.certainty.placed import Placed
from tracker.navigation.certainty.spread import crossing_sds_mm, radius_95
from tracker.plan.channel import Channel
from tracker.plan.screw import Tolerance

# Where the isthmus is not known: as deep as it usually lies behind the entry.
USUAL_LEVER_MM = 18.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Room:
    """What a pedicle leaves to navigation.

    Attributes:
        room_mm: from the drill or screw on the planned axis to the nearest wall.
        lever_mm: from the entry to where the pedicle is narrow; an angle uses the room up there.
    """

    room_mm: float
    lever_mm: float

    @property
    def room_deg(self) -> float:
        """The angle that uses the room up where the pedicle is narrow, of a drill that enters on the axis."""
        return float(np.degrees(np.arctan2(self.room_mm, self.lever_mm)))

    @classmethod
    def of_tolerance(cls, tolerance: Tolerance) -> "Room":
        """As the plan's tolerance has it."""
        slope = float(np.tan(np.radians(tolerance.max_angle_deg)))
        lever = tolerance.max_offset_mm / slope if slope > 0.0 else USUAL_LEVER_MM
        return cls(room_mm=tolerance.max_offset_mm, lever_mm=lever)

    @classmethod
    def of_channel(cls, channel: Channel, *, radius_mm: float) -> "Room":
        """Where only the channel is known: from the drill's wall to the channel's."""
        return cls(
            room_mm=max(channel.radius_mm - radius_mm, 0.0), lever_mm=min(channel.length_mm, USUAL_LEVER_MM)
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Certain:
    """Whether what is shown is sure enough for this pedicle, and the numbers that say so.

    Attributes:
        enough: 95 % of the uncertainty fits into the room.
        entry_95_mm: the drill's line is within this of where it is shown, in 95 %, at the entry.
        isthmus_95_mm: likewise where the pedicle is narrow.
        room_mm: what the pedicle leaves to an offset.
        room_deg: what it leaves to an angle.
    """

    enough: bool
    entry_95_mm: float
    isthmus_95_mm: float
    room_mm: float
    room_deg: float


def certain_for(tool: Placed[Vertebra, Tool], channel: Channel, room: Room) -> Certain:
    """Hold the uncertainty of the drill's line against what the pedicle tolerates."""
    entry, isthmus = (
        radius_95(*crossing_sds_mm(tool, channel, depth_mm=depth)) for depth in (0.0, room.lever_mm)
    )
    return Certain(
        enough=max(entry, isthmus) < room.room_mm,
        entry_95_mm=entry,
        isthmus_95_mm=isthmus,
        room_mm=room.room_mm,
        room_deg=room.room_deg,
    )
