"""A screw that was placed, in the vertebra frame: drawn where the drill stood when a person confirmed it."""

from dataclasses import dataclass

import numpy as np

from tracker.errors import RegistrationError
from tracker.geometry import Array, Rigid, Tool, Vertebra
from tracker.navigation.drill_reference import ScrewSize
from tracker.plan import Channel

# A drill steeper than this crosses the entry plane too far from where it entered the bone.
MAX_ANGLE_DEG = 45.0
# Entries of left and right channel are about 30 mm apart: farther than this, another channel was drilled.
MAX_ENTRY_OFFSET_MM = 10.0
ELSEWHERE = "Select the channel that was drilled, or place the drill in this one."


@dataclass(frozen=True, slots=True, kw_only=True)
class PlacedScrew:
    """Cylinder of a placed screw.

    Attributes:
        name: name of its channel.
        head_in_vertebra_mm: (3,), where its axis meets the entry plane of the channel.
        tip_in_vertebra_mm: (3,), its other end.
        radius_mm: radius of the screw.
    """

    name: str
    head_in_vertebra_mm: Array
    tip_in_vertebra_mm: Array
    radius_mm: float

    @classmethod
    def on_drill(
        cls, channel: Channel, vertebra_from_tool: Rigid[Vertebra, Tool], screw: ScrewSize
    ) -> "PlacedScrew":
        """Return the screw on the axis of a drill, starting at the entry plane as a planned screw does.

        Raises:
            RegistrationError: DRILL_NOT_IN_BONE, the tip is before the entry plane; DRILL_NOT_IN_CHANNEL, the
                drill lies across the channel or in another one.
        """
        direction = vertebra_from_tool.rotate_directions([0.0, 0.0, 1.0])
        tip = vertebra_from_tool.translation_mm
        cosine = float(direction @ channel.axis_in_vertebra)
        angle_deg = float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
        if angle_deg > MAX_ANGLE_DEG:
            raise RegistrationError(
                "DRILL_NOT_IN_CHANNEL",
                f"the drill is at {angle_deg:.0f} deg to {channel.name}, the limit is {MAX_ANGLE_DEG:g} deg",
                ELSEWHERE,
                {"channel": channel.name, "angle_deg": angle_deg, "max_angle_deg": MAX_ANGLE_DEG},
            )
        before_mm = float((channel.entry_in_vertebra_mm - tip) @ channel.axis_in_vertebra)
        if before_mm >= 0.0:
            raise RegistrationError(
                "DRILL_NOT_IN_BONE",
                f"the tip is {before_mm:.1f} mm before the entry of {channel.name}",
                "Place the drill or screwdriver in the channel, then touch again.",
                {"channel": channel.name, "before_mm": before_mm},
            )
        head = tip + direction * (before_mm / cosine)
        offset_mm = float(np.linalg.norm(head - channel.entry_in_vertebra_mm))
        if offset_mm > MAX_ENTRY_OFFSET_MM:
            raise RegistrationError(
                "DRILL_NOT_IN_CHANNEL",
                f"the axis of the drill is {offset_mm:.1f} mm from the entry of {channel.name}, "
                f"the limit is {MAX_ENTRY_OFFSET_MM:g} mm",
                ELSEWHERE,
                {"channel": channel.name, "offset_mm": offset_mm, "max_offset_mm": MAX_ENTRY_OFFSET_MM},
            )
        return cls(
            name=channel.name,
            head_in_vertebra_mm=head,
            tip_in_vertebra_mm=head + direction * screw.length_mm,
            radius_mm=screw.radius_mm,
        )
