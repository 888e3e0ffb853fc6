"""Triangle meshes whatever they come from: how they hang together, smoothing, fewer triangles."""

from tracker.plan.triangles.decimation import decimated
from tracker.plan.triangles.links import Links, largest_part, links_of, referenced
from tracker.plan.triangles.smoothing import smoothed
from tracker.plan.triangles.winding import wound_outwards

__all__ = ["Links", "decimated", "largest_part", "links_of", "referenced", "smoothed", "wound_outwards"]
