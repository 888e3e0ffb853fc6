"""From poses to what the surgeon needs: deviation from the channel, and the snapshot of one instant."""

from tracker.navigation.along import AlongChannel, half_axes_95_mm, seen_along
from tracker.navigation.concluding import navigate
from tracker.navigation.deviation import Deviation, deviation_from_channel
from tracker.navigation.guide import Guide, ScrewSize, Verdict, verdict_of
from tracker.navigation.moves import MovesSeen, moves_seen_by
from tracker.navigation.snapshot import (
    Absent,
    AbsentReason,
    NavigationSnapshot,
    PlacedVertebra,
    Setup,
    ToolInView,
    Watched,
)
from tracker.navigation.steadying import Steadying
from tracker.navigation.watching import Watching

__all__ = [
    "Absent",
    "AbsentReason",
    "AlongChannel",
    "Deviation",
    "Guide",
    "MovesSeen",
    "NavigationSnapshot",
    "PlacedVertebra",
    "ScrewSize",
    "Setup",
    "Steadying",
    "ToolInView",
    "Verdict",
    "Watched",
    "Watching",
    "deviation_from_channel",
    "half_axes_95_mm",
    "moves_seen_by",
    "navigate",
    "seen_along",
    "verdict_of",
]
