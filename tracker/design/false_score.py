"""Score of a marker's edges where the marker is absent: in the background, or over its own rotations."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np

from tracker.design.correlation import QUARTER_TURNS, best_correlated_places, rotated_rows
from tracker.design.places import Places, rectified
from tracker.edges import GreyImage, edgels_of, gradient_of
from tracker.geometry import Array
from tracker.marker import Agreement, MarkerModel, ScoreSettings, model_agreement, target_coverage_ratio

# The size at which rotations are compared: a 25 mm marker at arm's length in an ordinary camera.
SIDE_PX = 27
BLUR_PX = 0.6
# White paper around a square, in sides.
MARGIN_RATIO = 0.25
# Number of background squares that are scored: those with the highest correlation.
MAX_DISTRACTORS = 24


@dataclass(frozen=True, slots=True, kw_only=True)
class FalseScore:
    """The score of a marker model at a place where the marker is absent.

    Attributes:
        score_ratio: model coverage x (1 - weight x normalised fit error), 0..1.
        inner_coverage_ratio: coverage of the edges inside the square only, 0..1.
        target_score_ratio: target coverage x (1 - weight x normalised fit error), 0..1.
        accepted: whether all three reach the acceptance thresholds. The tracker may still reject an inverted
            polarity inside, but then only that test prevents a false detection.
    """

    score_ratio: float
    target_score_ratio: float
    inner_coverage_ratio: float
    accepted: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Distractor:
    """A square of the background and the marker's false score there.

    Attributes:
        image_index: index of its image.
        corners_px: (4, 2), top-left, top-right, bottom-right, bottom-left of the marker laid on it.
        score: its false score.
        correlation: normalised correlation of its inside with the marker, -1..1.
    """

    image_index: int
    corners_px: Array
    score: FalseScore
    correlation: float


def score_at(
    image: GreyImage, corners_px: Array, model: MarkerModel, settings: ScoreSettings, *, threshold: float
) -> FalseScore:
    """Return the score of a model placed on four corners (4, 2) of an image, without a pose fit.

    `threshold` is the gradient noise threshold, as in `tracker.edges.Gradient`.
    """
    x, y = corners_px[:, 0], corners_px[:, 1]
    active = model.level_for(float(np.sqrt(0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1))))))
    level = active.level_px
    margin = int(MARGIN_RATIO * level)
    seen = _rectified_level(image, corners_px, level_px=level, margin_px=margin)
    gradient = replace(gradient_of(seen), threshold=threshold)
    scale = level / model.side_mm
    points = margin + level / 2.0 - 0.5 + active.points_mm * [scale, -scale]
    normals = active.normals * [1.0, -1.0]
    agreement = model_agreement(gradient, active, points, normals, side_px=float(level))
    target = target_coverage_ratio(
        edgels_of(gradient),
        gradient,
        points,
        normals,
        corners_px=_square_px(margin, level),
        side_px=float(level),
        contrast=agreement.contrast,
    )
    return _false_score(replace(agreement, target_coverage_ratio=target), settings)


def _false_score(agreement: Agreement, settings: ScoreSettings) -> FalseScore:
    score, target_score = agreement.score_ratio(settings), agreement.target_score_ratio(settings)
    inner = agreement.inner_coverage_ratio
    return FalseScore(
        score_ratio=score,
        target_score_ratio=target_score,
        inner_coverage_ratio=inner,
        accepted=score >= settings.accept_score_ratio
        and target_score >= settings.accept_target_score_ratio
        and inner >= settings.accept_inner_coverage_ratio,
    )


def _rectified_level(image: GreyImage, corners_px: Array, *, level_px: int, margin_px: int) -> GreyImage:
    """Return the rectified inside of four corners with a margin, area-averaged down to `level_px`."""
    side_px = float(np.linalg.norm(np.roll(corners_px, -1, axis=0) - corners_px, axis=1).max())
    finer = max(1, round(side_px / level_px))
    fine = rectified(image, corners_px, side_px=level_px * finer, margin_px=margin_px * finer)
    whole = level_px + 2 * margin_px
    return np.asarray(cv2.resize(fine, (whole, whole), interpolation=cv2.INTER_AREA), dtype=np.uint8)


def _square_px(margin_px: int, side_px: int) -> Array:
    """Return the corners (4, 2) of a square at this margin from the border of an image."""
    low, high = margin_px - 0.5, margin_px + side_px - 0.5
    return np.array([[low, low], [high, low], [high, high], [low, high]])


def own_false_scores(model: MarkerModel, settings: ScoreSettings) -> tuple[FalseScore, FalseScore]:
    """Return the best scores on the marker's own rotations and on its mirror image."""
    rotated = [_score_over(np.rot90(model.square, turn), model, settings) for turn in range(1, QUARTER_TURNS)]
    mirrored = [
        _score_over(np.rot90(model.square[:, ::-1], turn), model, settings) for turn in range(QUARTER_TURNS)
    ]
    return _best(rotated), _best(mirrored)


def distractors_of(
    images: Sequence[GreyImage], places: Places, model: MarkerModel, settings: ScoreSettings
) -> list[Distractor]:
    """Return the background squares with the highest correlation to the marker, best score first."""
    found = []
    for index, turn, correlation in best_correlated_places(
        rotated_rows(model.square), places, count=MAX_DISTRACTORS
    ):
        image_index = int(places.image_index[index])
        corners = np.roll(places.corners_px[index], turn, axis=0)
        image = images[image_index]
        score = score_at(image, corners, model, settings, threshold=gradient_of(image).threshold)
        found.append(
            Distractor(image_index=image_index, corners_px=corners, score=score, correlation=correlation)
        )
    return sorted(found, key=_rank, reverse=True)


def _rank(place: Distractor) -> tuple[bool, float]:
    return place.score.accepted, place.score.score_ratio


def _score_over(square: GreyImage, model: MarkerModel, settings: ScoreSettings) -> FalseScore:
    """Return the score of a model on a printed square (n, n) that is `SIDE_PX` wide in the image."""
    paper = int(np.percentile(model.square, 98))
    margin = SIDE_PX // 2
    small = cv2.resize(np.ascontiguousarray(square), (SIDE_PX, SIDE_PX), interpolation=cv2.INTER_AREA)
    printed = cv2.copyMakeBorder(small, *(margin,) * 4, cv2.BORDER_CONSTANT, value=(paper,))
    seen = np.asarray(cv2.GaussianBlur(printed, (0, 0), BLUR_PX), dtype=np.uint8)
    corners = _square_px(margin, SIDE_PX)
    return score_at(seen, corners, model, settings, threshold=gradient_of(seen).threshold)


def _best(scores: list[FalseScore]) -> FalseScore:
    return max(scores, key=lambda one: (one.accepted, one.score_ratio))
