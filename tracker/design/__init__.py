"""Design of a marker that is unique against its background, and assessment of any marker."""

from tracker.design.assessment import MarkerAssessment, assess_marker
from tracker.design.background import Advance, Background, CameraOf, Claim, SearchResult
from tracker.design.design import MAX_SEARCHED, Design, best_design
from tracker.design.false_score import Distractor, FalseScore
from tracker.design.places import Places, concatenated, places_in, rectified
from tracker.design.precision import Precision, precision_of
from tracker.design.proposals import proposed_shapes
from tracker.design.rules import satisfies_rules
from tracker.design.shape import Patch, Shape, rendered_face

__all__ = [
    "MAX_SEARCHED",
    "Advance",
    "Background",
    "CameraOf",
    "Claim",
    "Design",
    "Distractor",
    "FalseScore",
    "MarkerAssessment",
    "Patch",
    "Places",
    "Precision",
    "SearchResult",
    "Shape",
    "assess_marker",
    "best_design",
    "concatenated",
    "places_in",
    "precision_of",
    "proposed_shapes",
    "rectified",
    "rendered_face",
    "satisfies_rules",
]
