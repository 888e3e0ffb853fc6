"""Reject outlier views and points, each with a reason."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.camera.calibration.dot_shift import dot_shifts_px
from tracker.camera.calibration.fit import Fit, fit_camera, projected
from tracker.camera.detection.view import BoardView
from tracker.geometry import Array

# A view is an outlier when its error exceeds the median of all views by this factor; good ones stay below 2.
MAX_VIEW_RATIO = 3.0
# Below this error a view is never an outlier, however small the errors of the others.
GOOD_VIEW_PX = 0.3
# A point is an outlier beyond this number of standard deviations: less than one of 10 000 good points.
MAX_POINT_SDS = 5.5
MAX_POINTS_OUT_RATIO = 0.25
MIN_POINTS, MIN_VIEWS = 6, 2
DOT_ROUNDS = 2
ROUNDS = 8


@dataclass(frozen=True, slots=True, kw_only=True)
class InlierViews:
    """Inlier views and points, and the camera fitted to them.

    Attributes:
        indexes: of the inlier views among the given ones.
        views: these, without outlier points and corrected for the bias of tilted dots.
        points: for each given view (n,), mask of its inlier points.
        out: the reason, by the index of an outlier view.
        fit: camera fitted to all inliers.
    """

    indexes: tuple[int, ...]
    views: tuple[BoardView, ...]
    points: tuple[npt.NDArray[np.bool_], ...]
    out: dict[int, str]
    fit: Fit


def reject_outlier_views(
    views: Sequence[BoardView], size_wh_px: tuple[int, int], coefficients: int
) -> InlierViews:
    """Return the views that fit one camera: reject the worst view and refit, until the rest agree."""
    retained = list(range(len(views)))
    points = tuple(np.ones(view.ids.size, dtype=bool) for view in views)
    out: dict[int, str] = {}
    fit = fit_camera([views[i] for i in retained], size_wh_px, coefficients)
    while len(retained) > MIN_VIEWS:
        # The median, because a few outlier points must not reject a good view.
        typical = np.array([_typical_px(residuals) for residuals in fit.residuals_px])
        usual = float(np.median(typical))
        worst = int(np.argmax(typical))
        limit = max(MAX_VIEW_RATIO * usual, GOOD_VIEW_PX)
        if typical[worst] <= limit:
            break
        out[retained[worst]] = (
            f"its points lie off by {typical[worst]:.2f} px where other views have {usual:.2f} px, "
            f"allowed {limit:.2f} px: their order is wrong, or the board has moved or is bent"
        )
        del retained[worst]
        fit = fit_camera([views[i] for i in retained], size_wh_px, coefficients)
    return InlierViews(
        indexes=tuple(retained), views=tuple(views[i] for i in retained), points=points, out=out, fit=fit
    )


def reject_outlier_points(
    views: Sequence[BoardView], retained: InlierViews, size_wh_px: tuple[int, int], coefficients: int
) -> InlierViews:
    """Return the views without outlier points, and with dots corrected for their projection bias."""
    points, out = list(retained.points), dict(retained.out)
    indexes = list(retained.indexes)
    moved = [views[i] for i in indexes]
    fit = fit_camera(
        [v.part(points[i]) for i, v in zip(indexes, moved, strict=True)], size_wh_px, coefficients
    )
    has_dots = any(view.dot_radii_mm.size for view in moved)
    for turn in range(ROUNDS):
        if has_dots and turn < DOT_ROUNDS:
            moved = [_unshifted(views[i], fit, at) for at, i in enumerate(indexes)]
            # Refit, because the corrected points require a camera fitted to them.
            fit = fit_camera(
                [v.part(points[i]) for i, v in zip(indexes, moved, strict=True)], size_wh_px, coefficients
            )
        changed = has_dots and turn < DOT_ROUNDS
        sigma = _noise_px(fit)
        for at, i in enumerate(indexes):
            now = _sound_points(_all_residuals(fit, at, moved[at]), sigma)
            changed |= bool((now != points[i]).any())
            points[i] = now
        too_few = [
            at
            for at, i in enumerate(indexes)
            if points[i].sum() < max(MIN_POINTS, (1 - MAX_POINTS_OUT_RATIO) * points[i].size)
        ]
        if too_few and len(indexes) - len(too_few) >= MIN_VIEWS:
            for at in reversed(too_few):
                i = indexes[at]
                out[i] = (
                    f"{int((~points[i]).sum())} of its {points[i].size} points lie off by more than "
                    f"{MAX_POINT_SDS * sigma:.2f} px, allowed {100 * MAX_POINTS_OUT_RATIO:.0f} % of them"
                )
                points[i] = np.ones(points[i].size, dtype=bool)
                del indexes[at], moved[at]
        if not changed:
            break
        fit = fit_camera(
            [v.part(points[i]) for i, v in zip(indexes, moved, strict=True)], size_wh_px, coefficients
        )
    return InlierViews(
        indexes=tuple(indexes),
        views=tuple(v.part(points[i]) for i, v in zip(indexes, moved, strict=True)),
        points=tuple(points),
        out=out,
        fit=fit,
    )


def _unshifted(view: BoardView, fit: Fit, at: int) -> BoardView:
    return BoardView(
        ids=view.ids,
        object_points_mm=view.object_points_mm,
        image_points_px=view.image_points_px - dot_shifts_px(fit, at, view),
        dot_radii_mm=view.dot_radii_mm,
        ambiguity=view.ambiguity,
    )


def _sound_points(residuals_px: Array, sigma_px: float) -> npt.NDArray[np.bool_]:
    """Return the inlier mask (n,) of a view; errors below `GOOD_VIEW_PX` never reject a view."""
    off = np.linalg.norm(residuals_px, axis=1)
    near = off <= MAX_POINT_SDS * sigma_px
    if near.mean() < 1 - MAX_POINTS_OUT_RATIO:
        near |= off <= GOOD_VIEW_PX
    return np.asarray(near, dtype=bool)


def _all_residuals(fit: Fit, at: int, view: BoardView) -> Array:
    pose = fit.rotations_rad[at], fit.translations_mm[at]
    return view.image_points_px - projected(view.object_points_mm, *pose, fit.matrix, fit.distortion)


def _typical_px(residuals: Array) -> float:
    """Return the RMS distance estimated from the median."""
    return float(np.median(np.linalg.norm(residuals, axis=1)) * np.sqrt(2.0 / (2.0 * np.log(2.0))))


def _noise_px(fit: Fit) -> float:
    """Return the standard deviation of one coordinate by the median absolute deviation."""
    return float(1.4826 * np.median(np.abs(np.concatenate([r.ravel() for r in fit.residuals_px])))) + 1e-9
