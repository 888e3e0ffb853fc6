"""The plan: the channel that the drill shall follow."""

from tracker.plan.channel import Channel
from tracker.plan.surface import Surface

__all__ = ["Channel", "Surface"]
