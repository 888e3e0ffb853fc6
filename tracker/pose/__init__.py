"""From the marker's edges to its pose, and to the tool behind it."""

from tracker.pose.sighting import FoundBy, Seen, Sighting, Unseen, UnseenReason
from tracker.pose.tool import ToolModel

__all__ = ["FoundBy", "Seen", "Sighting", "ToolModel", "Unseen", "UnseenReason"]
