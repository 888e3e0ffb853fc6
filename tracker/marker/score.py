"""The paper's score and target score of a model in an image (section 2.3)."""

from dataclasses import dataclass

import numpy as np

from tracker.edges import Edgels, Gradient
from tracker.errors import InvalidInput
from tracker.geometry import Array
from tracker.marker.active_edges import ActiveEdges
from tracker.marker.score_kernels import count_matched_edgels, crossings, edge_agreement

# Minimum ratio of an edge's gradient to the value predicted from its strength and the marker's contrast.
MIN_RESPONSE_RATIO = 0.35
# Maximum distance of common edgels from their model edge: in pixels, or this ratio of the marker's side if
# that is larger (bent paper).
REACH_PX, REACH_SIDE_RATIO, MAX_REACH_PX = 2.0, 0.04, 5.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ScoreSettings:
    """Acceptance levels of the scores.

    Attributes:
        accept_score_ratio: minimum score, 0..1.
        accept_target_score_ratio: minimum target score, 0..1.
        accept_inner_coverage_ratio: minimum coverage of the edges inside the square, 0..1: the outline is
            common to all square markers, the inside distinguishes this one.
        verified_threshold_ratio: factor on the minimum score and minimum inner coverage if photometric
            verification succeeds, 0..1; 1 leaves them unchanged.
        fit_error_weight: the paper's fit error weighing factor, here on the normalised fit error, 0..1.
    """

    accept_score_ratio: float = 0.7
    accept_target_score_ratio: float = 0.55
    accept_inner_coverage_ratio: float = 0.6
    verified_threshold_ratio: float = 0.6
    fit_error_weight: float = 0.25

    def __post_init__(self) -> None:
        for name in self.__slots__:
            value = float(getattr(self, name))
            if not 0.0 <= value <= 1.0:
                raise InvalidInput(
                    "SCORE_SETTING_INVALID",
                    f"the tracker's setting {name} is {value:g}, allowed 0 to 1",
                    "Set a ratio between 0 and 1.",
                    {"setting": name, "value": value},
                )


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """Agreement of the model's active edges with an image.

    Attributes:
        model_coverage_ratio: length of active edges found, by their total length, 0..1.
        inner_coverage_ratio: the same for the edges inside the square.
        target_coverage_ratio: edges in the occurrence that belong to the model, by all edges there, 0..1.
        fit_error_px2: mean squared distance of common edgels to their model edges.
        normalised_fit_error: the same by the square of the largest accepted distance, 0..1.
        contrast: gradient of an isolated edge of this occurrence, Sobel's scale.
    """

    model_coverage_ratio: float
    inner_coverage_ratio: float
    target_coverage_ratio: float
    fit_error_px2: float
    normalised_fit_error: float
    contrast: float

    def score_ratio(self, settings: ScoreSettings) -> float:
        """Return model coverage x (1 - weight x normalised fit error)."""
        return self.model_coverage_ratio * (1.0 - settings.fit_error_weight * self.normalised_fit_error)

    def target_score_ratio(self, settings: ScoreSettings) -> float:
        """Return target coverage x (1 - weight x normalised fit error)."""
        return self.target_coverage_ratio * (1.0 - settings.fit_error_weight * self.normalised_fit_error)


def reach_px(side_px: float) -> float:
    """Return the largest distance, in px, at which an edgel still counts as common with its model edge."""
    return min(max(REACH_SIDE_RATIO * side_px, REACH_PX), MAX_REACH_PX)


def model_agreement(
    gradient: Gradient,
    active: ActiveEdges,
    points_px: Array,
    normals_px: Array,
    *,
    side_px: float,
    shift_px: float = 0.0,
) -> Agreement:
    """Compare projected active edges (n, 2) with an image; normals (n, 2) are unit, dark to bright.

    `shift_px` is a shift common to all edges (camera response, ink), which is no fit error. The target
    coverage is set to 1: it requires the edgels, see `with_target_coverage`.
    """
    reach = reach_px(side_px)
    coverage, inner_coverage, fit, contrast = edge_agreement(
        gradient.x,
        gradient.y,
        float(gradient.left_px),
        float(gradient.top_px),
        points_px,
        normals_px,
        active.strength_ratio,
        active.length_mm,
        active.inner,
        reach,
        shift_px,
        0.6 * gradient.threshold,
        MIN_RESPONSE_RATIO,
    )
    return Agreement(
        model_coverage_ratio=coverage,
        inner_coverage_ratio=inner_coverage,
        target_coverage_ratio=1.0,
        fit_error_px2=fit,
        normalised_fit_error=min(fit / reach**2, 1.0),
        contrast=contrast,
    )


def edge_crossings(
    gradient: Gradient, points_px: Array, normals_px: Array, *, reach_px: float
) -> tuple[Array, Array]:
    """Return offsets (n,) in px along the normals to the image's edges, and strengths (n,), 0 for none."""
    corner = np.array([gradient.left_px, gradient.top_px], dtype=np.float64)
    offset, response = crossings(gradient.x, gradient.y, points_px - corner, normals_px, reach_px)
    return np.asarray(offset), np.asarray(response)


def target_coverage_ratio(
    edgels: Edgels,
    gradient: Gradient,
    points_px: Array,
    normals_px: Array,
    *,
    corners_px: Array,
    side_px: float,
    contrast: float,
) -> float:
    """Return the share of edgels in and around the square that are edges of the model, 0..1.

    Edgels under a third of the marker's contrast are texture and do not count.
    """
    shift = np.array([gradient.left_px, gradient.top_px], dtype=np.float64)
    common, present = count_matched_edgels(
        edgels.at,
        edgels.x,
        edgels.y,
        edgels.nx,
        edgels.ny,
        edgels.strength,
        points_px - shift,
        normals_px,
        corners_px - shift,
        # The common edgels lie up to the reach beyond a model edge, whose samples are a pixel or more apart.
        reach_px(side_px) + max(0.5, 0.5 * side_px * 6.0 / max(len(points_px), 1)),
        reach_px(side_px),
        MIN_RESPONSE_RATIO * contrast,
    )
    return float(common / present) if present else 0.0
