"""From poses to what the surgeon needs: deviation from the channel, and the snapshot of one instant."""

from tracker.navigation.along import AlongChannel, seen_along
from tracker.navigation.deviation import Deviation, deviation_from_channel
from tracker.navigation.snapshot import (
    Absent,
    AbsentReason,
    NavigationSnapshot,
    PlacedVertebra,
    Setup,
    ToolInView,
    navigate,
)
from tracker.navigation.steadying import Steadying

__all__ = [
    "Absent",
    "AbsentReason",
    "AlongChannel",
    "Deviation",
    "NavigationSnapshot",
    "PlacedVertebra",
    "Setup",
    "Steadying",
    "ToolInView",
    "deviation_from_channel",
    "navigate",
    "seen_along",
]
