"""Select the tools whose poses are smoothed in an image: those seen, and not near the wall of the channel."""

from collections import defaultdict
from collections.abc import Mapping

from tracker.navigation.deviation import Deviation
from tracker.navigation.snapshot import Setup
from tracker.navigation.snapshot_builder import locate_tool, locate_vertebra, tool_deviation
from tracker.plan import Channel
from tracker.pose import PoseSmoother, Seen, Sighting, SmoothedPose, SmoothingSettings


class ToolSmoothing:
    """Smooth the poses of all tools over time. Mutable: one filter per tool."""

    def __init__(self, settings: SmoothingSettings) -> None:
        self._settings = settings
        self._tools: defaultdict[str, PoseSmoother] = defaultdict(
            lambda: PoseSmoother(lag_ms=settings.lag_ms)
        )

    def steadied(
        self, setup: Setup, sightings: Mapping[str, Sighting], *, captured_at_s: float
    ) -> dict[str, SmoothedPose]:
        """Return the smoothed poses of this image by tool; tools without an entry use the measured pose."""
        if self._settings.lag_ms <= 0.0:
            return {}
        poses: dict[str, SmoothedPose] = {}
        vertebra = locate_vertebra(setup, sightings)
        for name, tool in setup.tools.items():
            sighting = sightings[tool.marker]
            if not isinstance(sighting, Seen):
                self._tools[name].forget()
                continue
            pose = self._tools[name].take(
                sighting.camera_from_marker, sighting.pose_covariance, at_s=captured_at_s
            )
            deviation = tool_deviation(setup, locate_tool(setup, tool, sighting), vertebra)
            near = (
                isinstance(deviation, Deviation)
                and isinstance(setup.channel, Channel)
                and channel_wall_distance_mm(deviation, setup.channel) - tool.radius_mm
                <= self._settings.near_wall_mm
            )
            if pose.images > 1 and (self._settings.near_wall or not near):
                poses[name] = pose
        return poses


def channel_wall_distance_mm(deviation: Deviation, channel: Channel) -> float:
    """Return the unsigned distance of the drill's tip from the surface of the channel, ends included."""
    across = deviation.tip_offset_mm - channel.radius_mm
    along = max(-deviation.depth_mm, -deviation.remaining_mm)
    if across <= 0.0 and along <= 0.0:
        return min(-across, -along)
    return float((max(across, 0.0) ** 2 + max(along, 0.0) ** 2) ** 0.5)
