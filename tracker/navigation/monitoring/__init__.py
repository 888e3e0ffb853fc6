"""Detection over time: pose jumps, motion of camera or reference, and time since a marker was seen.

Each detector receives sightings with their times; none reads a clock.
"""

from tracker.navigation.monitoring.last_seen import LastSeen, NeverSeen
from tracker.navigation.monitoring.pose_jump import (
    MotionKind,
    PoseJumpCheck,
    PoseJumpDetector,
    PoseJumpSettings,
    is_flipped,
)
from tracker.navigation.monitoring.reference_monitor import (
    ReferenceCheck,
    ReferenceMonitor,
    ReferenceSettings,
    ReferenceState,
)
from tracker.navigation.monitoring.scene_monitor import SceneCheck, SceneMonitor, SceneSettings, SceneState

__all__ = [
    "LastSeen",
    "MotionKind",
    "NeverSeen",
    "PoseJumpCheck",
    "PoseJumpDetector",
    "PoseJumpSettings",
    "ReferenceCheck",
    "ReferenceMonitor",
    "ReferenceSettings",
    "ReferenceState",
    "SceneCheck",
    "SceneMonitor",
    "SceneSettings",
    "SceneState",
    "is_flipped",
]
