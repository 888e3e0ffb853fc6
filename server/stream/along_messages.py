"""View of the drill along the channel, for the page's bull's-eye display."""

import numpy as np

from server.overlay import reach_of
from server.stream.message import Message
from tracker.geometry import Array
from tracker.navigation import Absent, Deviation, NavigationSnapshot, bullseye_view
from tracker.navigation.clearance import NearestWall
from tracker.navigation.uncertainty import DrillAnalysis


class BullseyeMessage(Message):
    """View along the channel, from behind the patient; positions are [right, up] in mm from its axis.

    The patient's left is on the left, the head on top.
    """

    tip_mm: list[float]
    at_entry_mm: list[float] | None
    """Intersection of the drill axis with the entry plane; null when it lies across the channel."""
    at_target_mm: list[float] | None
    """Intersection with the plane of the planned end."""
    nearest_mm: list[float] | None
    """Point of the drill nearest to a wall; null while it is outside the bone."""
    tip_half_axes_95_mm: list[list[float]] | None
    """2 half axes of the 95 % ellipse of the tip; null where unknown."""
    medial_is_right: bool
    """Whether medial is on the right."""
    channel_radius_mm: float
    channel_length_mm: float
    drill_radius_mm: float
    reach_mm: float
    """From the centre of the view to its border, as in the video overlay."""


def bullseye_message(snapshot: NavigationSnapshot, tool: str) -> BullseyeMessage | None:
    """Return the message of a tool; None where its deviation is unknown."""
    channel, placed = snapshot.setup.channel, snapshot.vertebra_from_tool(tool)
    known = isinstance(snapshot.deviations[tool], Deviation)
    if not known or isinstance(channel, Absent) or isinstance(placed, Absent):
        return None
    seen, judged = bullseye_view(placed, channel, snapshot.setup.side), snapshot.analyses[tool]
    nearest = judged.clearance.now if isinstance(judged, DrillAnalysis) else None
    half_axes = (
        seen.half_axes_95_mm(judged.spread.tip_covariance_mm2) if isinstance(judged, DrillAnalysis) else None
    )
    return BullseyeMessage(
        tip_mm=seen.tip_mm.tolist(),
        at_entry_mm=_place(seen.at_entry_mm),
        at_target_mm=_place(seen.at_target_mm),
        nearest_mm=seen.place_mm(nearest.point_in_vertebra_mm, channel).tolist()
        if isinstance(nearest, NearestWall)
        else None,
        tip_half_axes_95_mm=None if half_axes is None else half_axes.tolist(),
        medial_is_right=seen.medial_is_right,
        channel_radius_mm=channel.radius_mm,
        channel_length_mm=channel.length_mm,
        drill_radius_mm=snapshot.setup.tools[tool].radius_mm,
        reach_mm=reach_of(channel),
    )


def _place(place_mm: Array) -> list[float] | None:
    """Return the position; None for infinite values, which JSON lacks."""
    return place_mm.tolist() if np.isfinite(place_mm).all() else None
