"""The plan: the channel that the drill shall follow, and the bone it goes through."""

from tracker.plan.channel import Channel
from tracker.plan.surface import Surface
from tracker.plan.volume import Volume

__all__ = ["Channel", "Surface", "Volume"]
