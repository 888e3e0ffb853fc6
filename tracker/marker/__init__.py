"""The marker: model with active edges, candidates in an image, edge scores, photometric verification."""

from tracker.marker.active_edges import ActiveEdges
from tracker.marker.model import MarkerModel, reject_mirror_symmetric, reject_similar
from tracker.marker.photometric_fit import (
    PhotometricFit,
    ShapeMismatch,
    matches_under_saturation,
    photometric_fit_of,
    scale_space_of,
    shape_mismatch_of,
)
from tracker.marker.score import (
    Agreement,
    ScoreSettings,
    edge_crossings,
    model_agreement,
    reach_px,
    target_coverage_ratio,
)
from tracker.marker.search import (
    COSTLY_ROUNDS,
    SAME_OUTLINE_SIDE_RATIO,
    Candidate,
    candidate_rounds,
    costly_candidates,
    four_sided_candidates,
    second_print_candidates,
    thorough_rounds,
)
from tracker.marker.template_matching import Templates, templates_of

__all__ = [
    "COSTLY_ROUNDS",
    "SAME_OUTLINE_SIDE_RATIO",
    "ActiveEdges",
    "Agreement",
    "Candidate",
    "MarkerModel",
    "PhotometricFit",
    "ScoreSettings",
    "ShapeMismatch",
    "Templates",
    "candidate_rounds",
    "costly_candidates",
    "edge_crossings",
    "four_sided_candidates",
    "matches_under_saturation",
    "model_agreement",
    "photometric_fit_of",
    "reach_px",
    "reject_mirror_symmetric",
    "reject_similar",
    "scale_space_of",
    "second_print_candidates",
    "shape_mismatch_of",
    "target_coverage_ratio",
    "templates_of",
    "thorough_rounds",
]
