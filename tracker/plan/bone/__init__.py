"""The bone's surface out of a CT: threshold, region, triangles, smoothing, fewer triangles.

It is not imported by `tracker.plan`, so that what tracks images does not load what cuts CTs.
"""

from tracker.plan.bone.extraction import BoneSettings, BoneSurface, bone_surface
from tracker.plan.bone.region import Region
from tracker.plan.bone.threshold import ThresholdProposal, proposed_threshold

__all__ = [
    "BoneSettings",
    "BoneSurface",
    "Region",
    "ThresholdProposal",
    "bone_surface",
    "proposed_threshold",
]
