"""What explains the pixels of a square: the marker in some light, out of focus, or partly covered; or not.

The model is laid over the pixels as it is and where it is first, and asked what is left; then place, blur and
light are fitted, one after another, as long as that may explain what is left.
"""

from tracker.marker.explanation.acceptance import Explanation
from tracker.marker.explanation.contradiction import Contradiction, contradiction_of
from tracker.marker.explanation.explanation import explanation_of
from tracker.marker.explanation.fit import correlation_part_by_part
from tracker.marker.explanation.pictures import Pictures, pictures_of
from tracker.marker.explanation.washed_out import is_washed_out

__all__ = [
    "Contradiction",
    "Explanation",
    "Pictures",
    "contradiction_of",
    "correlation_part_by_part",
    "explanation_of",
    "is_washed_out",
    "pictures_of",
]
