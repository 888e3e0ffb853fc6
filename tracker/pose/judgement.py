"""Is what was fitted the marker? By its edges, by its pixels, and by what light and covers explain.

What light and covers explain only nearly is accepted from a search where it is large and nearly uncovered,
otherwise only once it is tracked: the other squares that come through are all small or half covered, while
bent paper, which is what is nearly explained, is mostly large in the image.
"""

from dataclasses import dataclass, replace

import numpy as np

from tracker.appearance import CoveredAt
from tracker.camera import CameraModel
from tracker.edges import Gradient, GreyImage
from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.marker import MarkerModel, ScoreSettings, contradiction_of, explanation_of, is_washed_out
from tracker.pose.occurrence import Occurrence, corners_px_at, side_px_of
from tracker.pose.planar import other_solution, pose_from_corners
from tracker.pose.rivals import doubt_between
from tracker.pose.sighting import FoundBy, Seen, Sighting, Unseen, UnseenReason
from tracker.pose.whole import Pixels, with_whole_shape

# In empty scenes other squares reach 0.86 in plain light, and once in hundreds of images 0.9 to 0.93 where
# they are small or wide. The marker itself has 0.97 there, or it is asked for an explanation.
PLAIN_SIDES_PX, PLAIN_CORRELATION = (20.0, 24.0, 30.0, 40.0), (0.95, 0.92, 0.92, 0.95)
# Where edges are weak, pixels may speak; not where nothing looks like the model before it is fitted.
WORTH_EXPLAINING = 0.45
# Farther than this the pose by edges is not within reach of the fit to all pixels.
EDGES_OFF_PX = 0.6
# On bent paper a part of the shape may be beside where it is expected. What is found anew is believed so far
# only where it is large and nearly whole; what was there before, and is not contradicted, sooner.
WIDE_PX, WHOLE_COVERAGE_RATIO, KNOWN_CORRELATION = 36.0, 0.85, 0.85
NEAR_CORRELATION, NEAR_INNER_CORRELATION = 0.93, 0.9
# Under glare, what has hardly moved and has no edges but the marker's is kept.
KEPT_TARGET_COVERAGE_RATIO, KEPT_OFF_PX, KEPT_OFF_SIDE_RATIO = 0.9, 3.0, 0.1


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """What is looked at, and for what.

    Attributes:
        camera: of the image.
        model: of the marker.
        pixels: the whole image.
        window: the part of it (h, w) that the gradient was taken of.
        gradient: of that part.
        settings: what is accepted.
        expected: the pose that the images before let expect; None in a search.
    """

    camera: CameraModel
    model: MarkerModel
    pixels: Pixels
    window: GreyImage
    gradient: Gradient
    settings: ScoreSettings
    expected: Rigid[Camera, Marker] | None

    @property
    def found_by(self) -> FoundBy:
        """How the marker comes to be looked for here."""
        return "search" if self.expected is None else "track"

    @property
    def corner_px(self) -> Array:
        """The left top pixel (2,) of the window."""
        return np.array([self.gradient.left_px, self.gradient.top_px], dtype=np.float64)


def judged(scene: Scene, found: Occurrence) -> Sighting:
    """Seen, as exactly as the pixels hold it, if this is the marker; else the reason why not.

    Edges are asked first, they cost least; then the inside in plain light; and last, what only blur, shadows,
    highlights and covers can explain.
    """
    settings, agreement = scene.settings, found.agreement
    score, target = agreement.score_ratio(settings), agreement.target_score_ratio(settings)
    least, min_inner = settings.accept_score_ratio, settings.accept_inner_coverage_ratio
    inner = agreement.inner_coverage_ratio
    weak = score < least or inner < min_inner
    reason = UnseenReason.SCORE_TOO_LOW if weak else UnseenReason.SHAPE_DIFFERS
    unseen = Unseen(reason=reason, best_score_ratio=score)
    share = settings.explained_share
    if score < share * least or inner < share * min_inner:
        return unseen
    if target < settings.accept_target_score_ratio:
        return unseen if weak else replace(unseen, reason=UnseenReason.TARGET_SCORE_TOO_LOW)
    plain, most = _plain_correlation(scene, found)
    if weak and most < WORTH_EXPLAINING:
        return unseen
    by_edges = Seen(
        camera_from_marker=found.fit.camera_from_marker,
        pose_covariance=found.fit.covariance,
        corners_px=found.seen_corners_px,
        score_ratio=score,
        target_score_ratio=target,
        model_coverage_ratio=agreement.model_coverage_ratio,
        target_coverage_ratio=agreement.target_coverage_ratio,
        fit_error_px2=agreement.fit_error_px2,
        found_by=scene.found_by,
        lead_sd2=found.fit.lead_sd2,
    )
    covered_at: CoveredAt | None = None
    if weak or plain < _min_plain(found.corners_px):
        explained = _explained(scene, found, by_edges, plain=0.0 if weak else plain)
        if explained is None:
            return unseen
        by_edges, covered_at = explained
    return with_whole_shape(
        scene.camera,
        scene.model,
        scene.pixels,
        by_edges,
        expected=scene.expected,
        covered_at=covered_at,
    )


def _min_plain(corners_px: Array) -> float:
    """What is enough in plain light, of a square at these corners (4, 2)."""
    return float(np.interp(side_px_of(corners_px), PLAIN_SIDES_PX, PLAIN_CORRELATION))


def _plain_correlation(scene: Scene, found: Occurrence) -> tuple[float, float]:
    """How like the model the inside is in plain light: if nothing contradicts, else -1; and in any case."""
    alike, most = -1.0, -1.0
    # Bent paper lies beside its flat pose. Another shape contradicts wherever its corners are taken to be.
    for corners in (found.corners_px, found.seen_corners_px):
        look = contradiction_of(
            scene.window, scene.model.square, corners - scene.corner_px, side_px=side_px_of(corners)
        )
        most = max(most, look.correlation)
        if not look.is_other_shape:
            alike = max(alike, look.correlation)
        if alike >= _min_plain(corners):
            break
    return alike, most


def _explained(
    scene: Scene, found: Occurrence, seen: Seen, *, plain: float
) -> tuple[Seen, CoveredAt | None] | None:
    """The same where light and covers explain it, or nearly what is like the model in plain light already.

    With it, what of the marker is covered, where that is known.
    """
    explanation = explanation_of(
        scene.window,
        scene.model.square,
        found.corners_px - scene.corner_px,
        side_px=side_px_of(found.corners_px),
    )
    if (explanation is None or not explanation.explains) and _is_kept(scene, found):
        return seen, None
    if explanation is None or explanation.is_turned:
        return None
    if explanation.explains or (explanation.explains_known and _is_where_expected(scene, found)):
        moved = _moved(scene, found, seen, explanation.corners_px + scene.corner_px)
        moved = replace(moved, is_in_noise=explanation.beside_noise is not None)
        return moved, explanation.covers if explanation.is_covered else None
    if plain <= 0.0:
        return None
    alike, inner = explanation.correlation, explanation.inner_correlation
    if scene.expected is not None:
        return (seen, None) if min(alike, inner) >= KNOWN_CORRELATION else None
    wide = side_px_of(seen.corners_px) > WIDE_PX and seen.model_coverage_ratio > WHOLE_COVERAGE_RATIO
    # Bent paper needs no highlights, and they take what is another shape away with them.
    is_bent = wide and not explanation.under_highlights
    return (seen, None) if is_bent and alike >= NEAR_CORRELATION and inner >= NEAR_INNER_CORRELATION else None


def _is_kept(scene: Scene, found: Occurrence) -> bool:
    """Whether this is where the marker was expected, washed out by glare, and nothing of it contradicts."""
    enough = found.agreement.target_coverage_ratio >= KEPT_TARGET_COVERAGE_RATIO
    if not (enough and _is_where_expected(scene, found)):
        return False
    corners = found.corners_px - scene.corner_px
    return is_washed_out(scene.window, scene.model.square, corners, side_px=side_px_of(found.corners_px))


def _is_where_expected(scene: Scene, found: Occurrence) -> bool:
    if scene.expected is None:
        return False
    expected = corners_px_at(scene.camera, scene.model, scene.expected)
    off = float(np.abs(found.corners_px - expected).max())
    return off <= max(KEPT_OFF_PX, KEPT_OFF_SIDE_RATIO * side_px_of(found.corners_px))


def _moved(scene: Scene, found: Occurrence, seen: Seen, corners_px: Array) -> Seen:
    """The same at corners (4, 2) that pixels give; with their pose where edges were off by them."""
    seen = replace(seen, corners_px=corners_px)
    moved = float(np.abs(corners_px - found.corners_px).max())
    if moved <= EDGES_OFF_PX:
        return seen
    pose = pose_from_corners(scene.camera, corners_px, side_mm=scene.model.side_mm)
    if pose is None:
        return seen
    before = found.fit.camera_from_marker.rotation
    both = (pose, other_solution(pose))
    nearer, farther = sorted(both, key=lambda one: -float(np.sum(one.rotation * before)))
    # Edges that were off have not decided between the two solutions.
    spread = doubt_between(nearer, farther, gap=0.0, expected=scene.expected)
    return replace(
        seen,
        camera_from_marker=nearer,
        pose_covariance=found.fit.covariance * (1.0 + (moved / EDGES_OFF_PX) ** 2) + spread,
        lead_sd2=0.0,
    )
