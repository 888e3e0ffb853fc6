"""The plan: the channel that the drill shall follow."""

from tracker.plan.channel import Channel

__all__ = ["Channel"]
