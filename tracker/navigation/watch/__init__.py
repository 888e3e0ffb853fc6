"""What no single image tells: a pose that jumped, a camera or a reference that moved, a marker out of sight.

Each watch is fed with what is seen and when; none reads a clock.
"""

from tracker.navigation.watch.jump import Jump, JumpSettings, JumpWatch, Moved, turned_over
from tracker.navigation.watch.reference import (
    ReferenceCheck,
    ReferenceSettings,
    ReferenceState,
    ReferenceWatch,
)
from tracker.navigation.watch.scene import SceneCheck, SceneSettings, SceneState, SceneWatch
from tracker.navigation.watch.sight import LastSight, NeverSeen

__all__ = [
    "Jump",
    "JumpSettings",
    "JumpWatch",
    "LastSight",
    "Moved",
    "NeverSeen",
    "ReferenceCheck",
    "ReferenceSettings",
    "ReferenceState",
    "ReferenceWatch",
    "SceneCheck",
    "SceneSettings",
    "SceneState",
    "SceneWatch",
    "turned_over",
]
