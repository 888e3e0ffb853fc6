"""The marker: its model and active edges, its occurrences in an image, and their scores."""

from tracker.marker.active_edges import ActiveEdges
from tracker.marker.explanation import (
    Contradiction,
    Explanation,
    contradiction_of,
    explanation_of,
    is_washed_out,
    pictures_of,
)
from tracker.marker.looks import Templates, templates_of
from tracker.marker.model import MarkerModel, reject_alike
from tracker.marker.score import (
    Agreement,
    ScoreSettings,
    edge_crossings,
    model_agreement,
    reach_px,
    target_coverage_ratio,
)
from tracker.marker.search import Candidate, candidate_rounds, thorough_rounds

__all__ = [
    "ActiveEdges",
    "Agreement",
    "Candidate",
    "Contradiction",
    "Explanation",
    "MarkerModel",
    "ScoreSettings",
    "Templates",
    "candidate_rounds",
    "contradiction_of",
    "edge_crossings",
    "explanation_of",
    "is_washed_out",
    "model_agreement",
    "pictures_of",
    "reach_px",
    "reject_alike",
    "target_coverage_ratio",
    "templates_of",
    "thorough_rounds",
]
