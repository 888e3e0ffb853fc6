"""From poses to what the surgeon needs: deviation from the channel, and the snapshot of one instant."""

from tracker.navigation.along import AlongChannel, half_axes_95_mm, seen_along
from tracker.navigation.assessment import Assessment, Correction, Direction, Lag, Verdict, assess
from tracker.navigation.concluding import navigate
from tracker.navigation.deviation import Deviation, deviation_from_channel
from tracker.navigation.figures import DrillLimits, Figure, FigureName, Status
from tracker.navigation.guide import Guide, ScrewSize
from tracker.navigation.lag import Lagging
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
    "Assessment",
    "Correction",
    "Deviation",
    "Direction",
    "DrillLimits",
    "Figure",
    "FigureName",
    "Guide",
    "Lag",
    "Lagging",
    "MovesSeen",
    "NavigationSnapshot",
    "PlacedVertebra",
    "ScrewSize",
    "Setup",
    "Status",
    "Steadying",
    "ToolInView",
    "Verdict",
    "Watched",
    "Watching",
    "assess",
    "deviation_from_channel",
    "half_axes_95_mm",
    "moves_seen_by",
    "navigate",
    "seen_along",
]
