"""Design of a marker that its background cannot imitate, and any marker measured by the same figures."""

from tracker.design.background import Advance, Background, CameraOf, Claim, Searched
from tracker.design.design import SEARCHED, Design, best_design
from tracker.design.false_score import FalseScore, ImitatingPlace
from tracker.design.judgement import Judgement, judgement_of
from tracker.design.places import Places, flattened, joined, places_in
from tracker.design.precision import Precision, precision_of
from tracker.design.proposals import proposed_shapes
from tracker.design.rules import keeps_the_rules
from tracker.design.shape import Patch, Shape, picture_of

__all__ = [
    "SEARCHED",
    "Advance",
    "Background",
    "CameraOf",
    "Claim",
    "Design",
    "FalseScore",
    "ImitatingPlace",
    "Judgement",
    "Patch",
    "Places",
    "Precision",
    "Searched",
    "Shape",
    "best_design",
    "flattened",
    "joined",
    "judgement_of",
    "keeps_the_rules",
    "picture_of",
    "places_in",
    "precision_of",
    "proposed_shapes",
]
