"""The light in which a square may be seen: even, in the shadow of something, or with a highlight."""

from tracker.marker.explanation.light.highlight import highlight_in
from tracker.marker.explanation.light.light import (
    contrasts,
    grid,
    highlights,
    shadow_in,
    smooth_light,
)

__all__ = ["contrasts", "grid", "highlight_in", "highlights", "shadow_in", "smooth_light"]
