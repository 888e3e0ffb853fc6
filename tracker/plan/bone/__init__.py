"""Surface extraction of bone from a CT: threshold, region, marching cubes, smoothing, wall fit, decimation.

`tracker.plan` does not import it, so that the tracking process does not load the CT libraries.
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
