"""The plan: the channel that the drill shall follow, and the bone it goes through."""

from tracker.plan.channel import Channel
from tracker.plan.surface import Surface

__all__ = ["Channel", "Surface"]
