"""What a camera sees of a marker's plane, and the pose that explains every pixel of it.

A picture of the marker at every blur, and a fit of pose, blur, camera response and light to the grey levels.
Nothing here searches: it starts within half a pixel.
"""

from tracker.appearance.inside import MIN_SAY_RATIO
from tracker.appearance.samples import CoveredAt
from tracker.appearance.texture import Textures, textures_of
from tracker.appearance.uneven import KnownLight
from tracker.appearance.whole import WholeFit, whole_fits

__all__ = ["MIN_SAY_RATIO", "CoveredAt", "KnownLight", "Textures", "WholeFit", "textures_of", "whole_fits"]
