"""Reject sweeps that do not determine a registration."""

import numpy as np

from tracker.errors import RegistrationError
from tracker.geometry import Array
from tracker.registration.surface.fit import Sweep, SweepFit
from tracker.registration.surface.observability import MotionMode
from tracker.registration.surface.settings import SurfaceSettings

SWEEP_REMEDY = "Sweep the tip slowly over both laminae, the base of the spinous process and both facets."
MIN_SPREAD_MM = 5.0


def validate_sweep(points_mm: Array) -> Array:
    """Return swept points (n, 3) as an array.

    Raises:
        RegistrationError: SURFACE_SWEEP_INVALID.
    """
    points = np.array(points_mm, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        raise RegistrationError(
            "SURFACE_SWEEP_INVALID",
            f"the swept points have shape {points.shape}, needed (n, 3), or a number is not finite",
            "Give the positions of the tip in mm, in the anchor's frame.",
            {"shape": str(points.shape)},
        )
    return points


def reject_small(points_mm: Array, point_weights: Array, settings: SurfaceSettings) -> None:
    """Raise SURFACE_SWEEP_SMALL for too few different points or too small a spread."""
    places = float(point_weights.sum())
    spread = float(np.sqrt(((points_mm - points_mm.mean(axis=0)) ** 2).sum(axis=1).mean())) if places else 0.0
    if places >= settings.min_points and spread >= MIN_SPREAD_MM:
        return
    raise RegistrationError(
        "SURFACE_SWEEP_SMALL",
        f"the sweep touches about {places:.0f} different places spread over {spread:.1f} mm (RMS), "
        f"needed {settings.min_points} over {MIN_SPREAD_MM:g} mm",
        SWEEP_REMEDY,
        {"places": places, "spread_mm": spread, "needed": settings.min_points, "needed_mm": MIN_SPREAD_MM},
    )


def reject_far(laid: SweepFit, settings: SurfaceSettings) -> None:
    """Raise SURFACE_START_FAR if the start is not near the bone."""
    median = float(np.median(np.abs(laid.off_mm)))
    if median > settings.max_start_off_mm:
        raise RegistrationError(
            "SURFACE_START_FAR",
            f"at the start the sweep lies {median:.1f} mm from the bone (median), "
            f"allowed {settings.max_start_off_mm:g} mm",
            "Register by landmarks first, and check that mesh and sweep are both in mm and of this vertebra.",
            {"median_mm": median, "allowed_mm": settings.max_start_off_mm},
        )


def reject_disagreement(laid: SweepFit, sweep: Sweep, settings: SurfaceSettings) -> None:
    """Raise SURFACE_DISAGREES if the share of inliers is too small."""
    ratio = float(sweep.point_weights[laid.weights > 0.0].sum() / sweep.point_weights.sum())
    if ratio < settings.min_used_ratio:
        raise RegistrationError(
            "SURFACE_DISAGREES",
            f"only {ratio:.0%} of the sweep lies on the bone, needed {settings.min_used_ratio:.0%}",
            "Keep the tip on bare bone while sweeping, and lift it off only when the sweep has ended.",
            {"used_ratio": ratio, "needed_ratio": settings.min_used_ratio},
        )


def reject_sliding(weakest_mode: MotionMode, settings: SurfaceSettings) -> None:
    """Raise SURFACE_SLIDES if a motion mode is unobservable."""
    if weakest_mode.sd_mm <= settings.max_slide_sd_mm:
        return
    known = "not known at all" if weakest_mode.sd_mm > 100.0 else f"known to {weakest_mode.sd_mm:.1f} mm"
    raise RegistrationError(
        "SURFACE_SLIDES",
        f"the sweep slides on the bone {weakest_mode.description}: there it is {known} at the target, "
        f"allowed {settings.max_slide_sd_mm:g} mm",
        "Sweep surfaces with other normals too: the flanks of the spinous process, the rims of the facets, "
        "the transverse processes.",
        {
            "direction": weakest_mode.description,
            "sd_mm": min(weakest_mode.sd_mm, 1000.0),
            "allowed_mm": settings.max_slide_sd_mm,
            "direction_sd": known,
        },
    )


def raise_ambiguous(apart_mm: float, words: str, rms_mm: tuple[float, float]) -> None:
    """Raise SURFACE_AMBIGUOUS: another fit has a similar cost."""
    raise RegistrationError(
        "SURFACE_AMBIGUOUS",
        f"the sweep fits in two places {apart_mm:.1f} mm apart at the target, mostly {words}: "
        f"to {rms_mm[0]:.2f} and to {rms_mm[1]:.2f} mm RMS",
        "Sweep more of the bone: the base of the spinous process, and both facets.",
        {"apart_mm": apart_mm, "direction": words, "rms_mm": list(rms_mm)},
    )
