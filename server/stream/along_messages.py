"""The drill as it is seen along the channel, for the bull's-eye that a page draws."""

import numpy as np

from server.overlay import reach_of
from server.stream.message import Message
from tracker.geometry import Array
from tracker.navigation import Absent, Deviation, NavigationSnapshot, seen_along
from tracker.navigation.certainty import Judged
from tracker.navigation.clearance import Nearest


class AlongMessage(Message):
    """The view along the channel, from behind the patient; places are [right, up] in mm from its axis.

    The patient's left is on the left, the head on top.
    """

    tip_mm: list[float]
    at_entry_mm: list[float] | None
    """Where the drill's line crosses the plane of the entry; null when it lies across the channel."""
    at_target_mm: list[float] | None
    """Where it crosses that of the planned end."""
    nearest_mm: list[float] | None
    """The place of the drill that is nearest to a wall; null while it is outside the bone."""
    tip_half_axes_95_mm: list[list[float]] | None
    """2 half axes of the ellipse that holds the tip in 95 %; null where that is not known."""
    medial_is_right: bool
    """Whether the patient's middle is on the right."""
    channel_radius_mm: float
    channel_length_mm: float
    drill_radius_mm: float
    reach_mm: float
    """From the middle of the view to its border, as in the burned-in one."""


def along_message(snapshot: NavigationSnapshot, tool: str) -> AlongMessage | None:
    """The message of a tool in the view along the channel; None where it has no deviation from it."""
    channel, placed = snapshot.setup.channel, snapshot.vertebra_from_tool(tool)
    known = isinstance(snapshot.deviations[tool], Deviation)
    if not known or isinstance(channel, Absent) or isinstance(placed, Absent):
        return None
    seen, judged = seen_along(placed, channel, snapshot.setup.side), snapshot.judgements[tool]
    nearest = judged.clearance.now if isinstance(judged, Judged) else None
    half_axes = seen.half_axes_95_mm(judged.spread.tip_covariance_mm2) if isinstance(judged, Judged) else None
    return AlongMessage(
        tip_mm=seen.tip_mm.tolist(),
        at_entry_mm=_place(seen.at_entry_mm),
        at_target_mm=_place(seen.at_target_mm),
        nearest_mm=seen.place_mm(nearest.point_in_vertebra_mm, channel).tolist()
        if isinstance(nearest, Nearest)
        else None,
        tip_half_axes_95_mm=None if half_axes is None else half_axes.tolist(),
        medial_is_right=seen.medial_is_right,
        channel_radius_mm=channel.radius_mm,
        channel_length_mm=channel.length_mm,
        drill_radius_mm=snapshot.setup.tools[tool].radius_mm,
        reach_mm=reach_of(channel),
    )


def _place(place_mm: Array) -> list[float] | None:
    """JSON knows no number without end."""
    return place_mm.tolist() if np.isfinite(place_mm).all() else None
