"""Which tools are steadied in an image: those that are seen, and not near the wall of the channel."""

from collections import defaultdict
from collections.abc import Mapping

from tracker.navigation.concluding import placed_vertebra, tool_deviation, tool_in_view
from tracker.navigation.deviation import Deviation
from tracker.navigation.snapshot import Setup
from tracker.plan import Channel
from tracker.pose import Seen, Sighting, Steady, SteadyPose, SteadySettings


class Steadying:
    """Steadies the poses of all tools from image to image. Mutable: one `Steady` for each tool."""

    def __init__(self, settings: SteadySettings) -> None:
        self._settings = settings
        self._tools: defaultdict[str, Steady] = defaultdict(lambda: Steady(lag_ms=settings.lag_ms))

    def steadied(
        self, setup: Setup, sightings: Mapping[str, Sighting], *, captured_at_s: float
    ) -> dict[str, SteadyPose]:
        """The steadied poses of this image by tool; a tool that is not in it is shown as the image has it."""
        if self._settings.lag_ms <= 0.0:
            return {}
        poses: dict[str, SteadyPose] = {}
        vertebra = placed_vertebra(setup, sightings)
        for name, tool in setup.tools.items():
            sighting = sightings[tool.marker]
            if not isinstance(sighting, Seen):
                self._tools[name].forget()
                continue
            pose = self._tools[name].take(
                sighting.camera_from_marker, sighting.pose_covariance, at_s=captured_at_s
            )
            deviation = tool_deviation(setup, tool_in_view(setup, tool, sighting), vertebra)
            near = (
                isinstance(deviation, Deviation)
                and isinstance(setup.channel, Channel)
                and wall_gap_mm(deviation, setup.channel) - tool.radius_mm <= self._settings.near_wall_mm
            )
            if pose.images > 1 and (self._settings.near_wall or not near):
                poses[name] = pose
        return poses


def wall_gap_mm(deviation: Deviation, channel: Channel) -> float:
    """Distance of the drill's tip from the surface of the channel, its two ends included; 0 or more."""
    across = deviation.tip_offset_mm - channel.radius_mm
    along = max(-deviation.depth_mm, -deviation.remaining_mm)
    if across <= 0.0 and along <= 0.0:
        return min(-across, -along)
    return float((max(across, 0.0) ** 2 + max(along, 0.0) ** 2) ** 0.5)
